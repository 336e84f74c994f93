#include <algorithm>
#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "image_files/plugin/calls.h"

namespace seedframe::image_module {
namespace {

constexpr int kRowsAtOnce = 64;

Values values_of(const OIIO::TypeDesc& type) {
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
      return Values::kUint8;
    case OIIO::TypeDesc::UINT16:
      return Values::kUint16;
    case OIIO::TypeDesc::HALF:
      return Values::kHalf;
    case OIIO::TypeDesc::FLOAT:
      return Values::kFloat;
    default:
      return Values::kOther;
  }
}

Values values_of(const OIIO::ImageSpec& spec) {
  const auto other = [&](const OIIO::TypeDesc& type) { return values_of(type) == Values::kOther; };
  if (std::any_of(spec.channelformats.begin(), spec.channelformats.end(), other)) {
    return Values::kOther;
  }
  return values_of(spec.format);  // the widest, where channels differ
}

bool is_cropped(const OIIO::ImageSpec& spec) {
  return spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
         spec.height != spec.full_height;
}

/// Rows [first, last), counted from the first; a tiled image is read by rows of tiles.
bool read_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int first, int last,
               const OIIO::TypeDesc& type, void* values) {
  const int y = spec.y + first;
  const int end = spec.y + last;
  if (spec.tile_width > 0) {
    return input.read_tiles(0, 0, spec.x, spec.x + spec.width, y, end, 0, 1, 0, spec.nchannels,
                            type, values);
  }
  return input.read_scanlines(0, 0, y, end, 0, 0, spec.nchannels, type, values);
}

bool read_pixels(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const ReadCalls& calls,
                 Fault* fault) {
  const bool is_small = values_of(spec) == Values::kUint8;
  const OIIO::TypeDesc type = is_small ? OIIO::TypeUInt8 : OIIO::TypeFloat;
  const int at_once = spec.tile_height > 0 ? spec.tile_height : kRowsAtOnce;
  const std::size_t row_bytes =
      static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels) * type.size();
  std::vector<unsigned char> values(row_bytes *
                                    static_cast<std::size_t>(std::min(at_once, spec.height)));
  for (int row = 0; row < spec.height; row += at_once) {
    const int end = std::min(row + at_once, spec.height);
    const bool done = read_rows(input, spec, row, end, type, values.data());
    // Some readers go on with what they can when a part of the file is damaged.
    if (!done || input.has_error()) {
      const std::string reason = input.geterror();
      return refuse(fault, reason.empty() ? "its pixels cannot be decoded" : reason);
    }
    if (!calls.rows(calls.self, row, end - row, values.data())) return false;
  }
  return true;
}

/// An input and the bytes it reads. The name is for messages only.
struct OpenImage {
  OpenImage(const char* reader, const void* bytes, std::size_t size)
      : input(OIIO::ImageInput::create(reader)),
        memory(const_cast<void*>(bytes), size),
        name(std::string("image.") + reader) {
    if (input == nullptr) return;
    input->threads(1);
    input->set_ioproxy(&memory);
  }

  bool open() {
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored
    wishes.attribute("oiio:RawColor", 1);
    return input->open(name, spec, wishes);
  }

  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::Filesystem::IOMemReader memory;
  std::string name;
  OIIO::ImageSpec spec;
};

/// Asked of an input of its own: not every reader finds back to the first image.
bool has_second_image(const char* reader, const void* bytes, std::size_t size) {
  OpenImage image(reader, bytes, size);
  const bool found = image.open() && image.input->seek_subimage(1, 0);
  (void)image.input->geterror();
  return found;
}

bool hand_on_header(const OIIO::ImageSpec& spec, bool has_more_images, const ReadCalls& calls) {
  std::vector<const char*> names;
  names.reserve(spec.channelnames.size());
  for (const std::string& name : spec.channelnames) names.push_back(name.c_str());
  names.resize(static_cast<std::size_t>(std::max(spec.nchannels, 0)), "");
  Header header;
  header.width = spec.width;
  header.height = spec.height;
  header.channels = spec.nchannels;
  header.stored = values_of(spec);
  header.channel_names = names.data();
  header.is_deep = spec.deep;
  header.is_cropped = is_cropped(spec) || spec.depth > 1;
  header.has_more_images = has_more_images;
  return calls.header(calls.self, &header);
}

}  // namespace

bool read_image(const char* reader, const void* bytes, std::size_t size, const ReadCalls* calls,
                Fault* fault) {
  return guarded(fault, [&] {
    OpenImage image(reader, bytes, size);
    if (image.input == nullptr) {
      (void)OIIO::geterror();
      return refuse(fault, std::string("this OpenImageIO has no reader for ") + reader);
    }
    if (!image.open()) {
      const std::string reason = image.input->geterror();
      return refuse(fault, reason.empty() ? "its header cannot be read" : reason);
    }
    const bool has_more = has_second_image(reader, bytes, size);
    const bool done = hand_on_header(image.spec, has_more, *calls) &&
                      read_pixels(*image.input, image.spec, *calls, fault);
    image.input->close();
    (void)image.input->geterror();
    return done;
  });
}

}  // namespace seedframe::image_module
