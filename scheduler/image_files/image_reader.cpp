#include "image_files/image_reader.h"

#include <algorithm>
#include <cstring>

#include "image_files/image_module.h"
#include "image_files/radiance_header.h"

namespace seedframe {
namespace {

namespace module = image_module;

/// The library's name for its reader of a kind.
const char* reader_of(ImageKind kind) {
  switch (kind) {
    case ImageKind::kPng:
      return "png";
    case ImageKind::kJpeg:
      return "jpeg";
    case ImageKind::kTiff:
      return "tiff";
    case ImageKind::kExr:
      return "openexr";
    case ImageKind::kHdr:
      return "hdr";
    case ImageKind::kWebp:
      return "webp";
    case ImageKind::kTga:
      return "targa";
    case ImageKind::kBmp:
      return "bmp";
  }
  return "";
}

/// Whether the chunks of a PNG, from its signature on, lead to the one that ends it.
bool has_all_chunks(std::string_view png) {
  std::size_t at = 8;
  while (png.size() >= at + 12) {
    std::size_t length = 0;
    for (int i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(png[at + i]);
    if (length > png.size() - at - 12) return false;
    if (png.substr(at + 4, 4) == "IEND") return true;
    at += length + 12;
  }
  return false;
}

/// What its reader would take for an image, and is none.
Status check_front(std::string_view bytes, ImageKind kind, const std::string& what) {
  const std::string looks = what_bytes_look_like(bytes);
  // A TGA begins with nothing of its own, so whatever is recognised is none.
  if (!begins_like(bytes, kind) || (kind == ImageKind::kTga && !looks.empty())) {
    return fail(ErrorKind::kInput, "{} is no {}: it {}{}", what, name_of(kind),
                looks.empty() ? "begins like none" : "is ", looks);
  }
  if (kind == ImageKind::kHdr) return check_radiance_header(bytes, what);
  if (kind == ImageKind::kPng && !has_all_chunks(bytes)) {
    return fail(ErrorKind::kInput, "{} is cut: a PNG ends with an end chunk", what);
  }
  // libjpeg paints what is missing grey, and calls that a warning. After the marker there may be
  // what cameras and downloads append.
  if (kind == ImageKind::kJpeg && bytes.rfind("\xff\xd9") == std::string_view::npos) {
    return fail(ErrorKind::kInput, "{} is cut: a JPEG ends with an end marker", what);
  }
  return {};
}

/// Stands between the module's calls and the visitor.
class Reading {
 public:
  Reading(const std::string& what, const ImageVisit& visit, const ImageLimits& limits)
      : what_(what), visit_(visit), limits_(limits) {}

  module::ReadCalls calls() { return {this, &Reading::on_header, &Reading::on_rows}; }
  const Status& status() const { return status_; }
  const ImageHeader& header() const { return header_; }
  bool is_whole() const { return rows_ == header_.height && rows_ > 0; }

 private:
  static bool on_header(void* self, const module::Header* header) {
    auto& reading = *static_cast<Reading*>(self);
    reading.status_ = reading.take(*header);
    if (reading.status_ && reading.visit_.header) {
      reading.status_ = reading.visit_.header(reading.header_);
    }
    return reading.status_.has_value();
  }

  static bool on_rows(void* self, std::int32_t first, std::int32_t count, const void* values) {
    auto& reading = *static_cast<Reading*>(self);
    reading.rows_ += count;
    reading.status_ = reading.header_.stored == StoredValue::kUint8
                          ? reading.hand_on(first, count, static_cast<const std::uint8_t*>(values),
                                            reading.visit_.rows8)
                          : reading.hand_on(first, count, static_cast<const float*>(values),
                                            reading.visit_.rows_float);
    return reading.status_.has_value();
  }

  Status take(const module::Header& header);

  template <class T>
  Status hand_on(int first, int count, const T* values,
                 const std::function<Status(int, const Image<T>&)>& visitor) const {
    if (!visitor) return {};
    Image<T> rows(header_.width, count, static_cast<int>(header_.channels.size()));
    std::copy(values, values + rows.values.size(), rows.values.begin());
    return visitor(first, rows);
  }

  const std::string& what_;
  const ImageVisit& visit_;
  const ImageLimits& limits_;
  ImageHeader header_;
  int rows_ = 0;
  Status status_;
};

Status Reading::take(const module::Header& header) {
  if (header.width <= 0 || header.height <= 0 || header.channels <= 0) {
    return fail(ErrorKind::kInput, "{} has no pixels: its header says {} × {}, {} channels", what_,
                header.width, header.height, header.channels);
  }
  const std::int64_t pixels = std::int64_t{header.width} * header.height;
  if (header.width > limits_.side_px || header.height > limits_.side_px ||
      pixels > limits_.pixels || pixels * header.channels > limits_.values) {
    return fail(ErrorKind::kInput,
                "{} is too large: {} × {} pixels of {} channels; {} pixels a side, {} together and "
                "{} values are the most",
                what_, header.width, header.height, header.channels, limits_.side_px,
                limits_.pixels, limits_.values);
  }
  if (header.is_deep) {
    return fail(ErrorKind::kInput, "{} is a deep image: save it as a flat one", what_);
  }
  if (header.is_cropped) {
    return fail(ErrorKind::kInput,
                "{} has pixels for another window than it shows: save the whole image", what_);
  }
  switch (header.stored) {
    case module::Values::kUint8:
      header_.stored = StoredValue::kUint8;
      break;
    case module::Values::kUint16:
      header_.stored = StoredValue::kUint16;
      break;
    case module::Values::kHalf:
      header_.stored = StoredValue::kHalf;
      break;
    case module::Values::kFloat:
      header_.stored = StoredValue::kFloat;
      break;
    case module::Values::kOther:
      return fail(ErrorKind::kInput,
                  "{} holds values that are neither integers of 8 or 16 bits nor floats", what_);
  }
  header_.width = header.width;
  header_.height = header.height;
  header_.channels.assign(header.channel_names, header.channel_names + header.channels);
  header_.has_more_images = header.has_more_images;
  return {};
}

/// Puts rows where they belong in the whole image.
template <class T, class Convert>
auto rows_into(Image<T>& whole, Convert convert) {
  return [&whole, convert](int first, const auto& rows) -> Status {
    std::transform(rows.values.begin(), rows.values.end(), &whole.at(first, 0), convert);
    return {};
  };
}

}  // namespace

Result<ImageHeader> visit_image(std::string_view bytes, ImageKind kind, const std::string& what,
                                const ImageVisit& visit, const ImageLimits& limits) {
  if (Status right = check_front(bytes, kind, what); !right) return forward_error(right);
  const Result<const module::Table*> library = image_module_table();
  if (!library) return forward_error(library);
  Reading reading(what, visit, limits);
  const module::ReadCalls calls = reading.calls();
  module::Fault fault;
  const bool done = (*library)->read(reader_of(kind), bytes.data(), bytes.size(), &calls, &fault);
  if (!reading.status()) return forward_error(reading.status());
  if (!done || !reading.is_whole()) {
    return fail(ErrorKind::kInput, "{} is a damaged or cut {}: {}", what, name_of(kind),
                fault.text[0] != '\0' ? fault.text : "pixels are missing");
  }
  return reading.header();
}

Result<Image<float>> decode_image(std::string_view bytes, ImageKind kind, const std::string& what,
                                  const ImageLimits& limits) {
  Image<float> image;
  ImageVisit visit;
  visit.header = [&](const ImageHeader& header) -> Status {
    image = Image<float>(header.width, header.height, static_cast<int>(header.channels.size()));
    return {};
  };
  visit.rows8 =
      rows_into(image, [](std::uint8_t value) { return static_cast<float>(value) / 255.0F; });
  visit.rows_float = rows_into(image, [](float value) { return value; });
  const Result<ImageHeader> header = visit_image(bytes, kind, what, visit, limits);
  if (!header) return forward_error(header);
  return image;
}

Result<Image<std::uint8_t>> decode_image8(std::string_view bytes, ImageKind kind,
                                          const std::string& what, const ImageLimits& limits) {
  Image<std::uint8_t> image;
  ImageVisit visit;
  visit.header = [&](const ImageHeader& header) -> Status {
    if (header.stored != StoredValue::kUint8) {
      return fail(ErrorKind::kInput, "{} holds values of more than the 8 bits expected", what);
    }
    image =
        Image<std::uint8_t>(header.width, header.height, static_cast<int>(header.channels.size()));
    return {};
  };
  visit.rows8 = rows_into(image, [](std::uint8_t value) { return value; });
  const Result<ImageHeader> header = visit_image(bytes, kind, what, visit, limits);
  if (!header) return forward_error(header);
  return image;
}

}  // namespace seedframe
