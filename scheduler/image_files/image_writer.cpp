#include "image_files/image_writer.h"

#include <cassert>

#include "image/png_file.h"
#include "image_files/image_module.h"

namespace seedframe {
namespace {

struct Writer {
  const char* name = nullptr;
  std::string compression;
  int most_px = 0;  ///< of a side
};

Writer writer_of(const ImageEncoding& encoding) {
  const std::string quality = ":" + std::to_string(encoding.quality);
  switch (encoding.format) {
    case ImageFormat::kPng:
      break;
    case ImageFormat::kJpeg:
      return {"jpeg", "jpeg" + quality, 65'500};
    case ImageFormat::kTiff:
      return {"tiff", name_of(encoding.tiff), 1'000'000};
    case ImageFormat::kWebp:
      return {"webp", "webp" + quality, 16'383};
  }
  return {};
}

}  // namespace

Result<std::string> encode_image(const Image<std::uint8_t>& image, const ImageEncoding& encoding) {
  assert(image.channels == 3 && image.width > 0 && image.height > 0);
  assert(encoding.quality >= 1 && encoding.quality <= 100);
  if (encoding.format == ImageFormat::kPng) {
    return encode_png(image, PngContent::kPhoto, encoding.compression);
  }
  const Writer writer = writer_of(encoding);
  if (image.width > writer.most_px || image.height > writer.most_px) {
    return fail(ErrorKind::kInput, "a {} has at most {} pixels a side, not {} × {}",
                name_of(encoding.format), writer.most_px, image.width, image.height);
  }
  const Result<const image_module::Table*> library = image_module_table();
  if (!library) return forward_error(library);
  const image_module::WriteRequest request = {writer.name, image.width, image.height,
                                              image.values.data(), writer.compression.c_str()};
  std::string bytes;
  const image_module::ByteSink sink = {&bytes, [](void* self, const void* more, std::size_t size) {
                                         static_cast<std::string*>(self)->append(
                                             static_cast<const char*>(more), size);
                                       }};
  image_module::Fault fault;
  if (!(*library)->write(&request, &sink, &fault)) {
    return fail(ErrorKind::kEnvironment, "cannot encode an image as {}: {}",
                name_of(encoding.format), fault.text);
  }
  return bytes;
}

Status check_encoding(const ImageEncoding& encoding) {
  if (encoding.format == ImageFormat::kPng) return {};
  const auto library = image_module_table();
  return library ? Status() : forward_error(library);
}

}  // namespace seedframe
