#include "image_files/image_writer.h"

#include <cassert>

#include "image_files/image_module.h"

namespace seedframe {
namespace {

struct Writer {
  const char* name = nullptr;
  std::string compression;
  int most_px = 0;  ///< of a side
};

std::string compression_of(TiffCompression compression) {
  switch (compression) {
    case TiffCompression::kNone:
      return "none";
    case TiffCompression::kLzw:
      return "lzw";
    case TiffCompression::kZip:
      return "zip";
  }
  return "";
}

Writer writer_of(const ImageEncoding& encoding) {
  const std::string quality = ":" + std::to_string(encoding.quality);
  switch (encoding.kind) {
    case ImageKind::kPng:
      return {"png", "", 1'000'000};
    case ImageKind::kJpeg:
      return {"jpeg", "jpeg" + quality, 65'500};
    case ImageKind::kTiff:
      return {"tiff", compression_of(encoding.tiff), 1'000'000};
    case ImageKind::kWebp:
      return {"webp", "webp" + quality, 16'383};
    default:
      return {};
  }
}

}  // namespace

Result<std::string> encode_image(const Image<std::uint8_t>& image, const ImageEncoding& encoding) {
  assert(image.channels == 3 && image.width > 0 && image.height > 0);
  assert(encoding.quality >= 1 && encoding.quality <= 100);
  const Writer writer = writer_of(encoding);
  if (writer.name == nullptr) {
    return fail(ErrorKind::kInput, "pictures are written as PNG, JPEG, WebP or TIFF, not as {}",
                name_of(encoding.kind));
  }
  if (image.width > writer.most_px || image.height > writer.most_px) {
    return fail(ErrorKind::kInput, "a {} has at most {} pixels a side, not {} × {}",
                name_of(encoding.kind), writer.most_px, image.width, image.height);
  }
  const Result<const image_module::Table*> library = image_module_table();
  if (!library) return forward_error(library);
  const image_module::WriteRequest request = {
      writer.name,       image.width, image.height, image.values.data(), writer.compression.c_str(),
      encoding.png_level};
  std::string bytes;
  const image_module::ByteSink sink = {&bytes, [](void* self, const void* more, std::size_t size) {
                                         static_cast<std::string*>(self)->append(
                                             static_cast<const char*>(more), size);
                                       }};
  image_module::Fault fault;
  if (!(*library)->write(&request, &sink, &fault)) {
    return fail(ErrorKind::kEnvironment, "cannot encode an image as {}: {}", name_of(encoding.kind),
                fault.text);
  }
  return bytes;
}

}  // namespace seedframe
