#include "frames/frame_image.h"

#include "base/files.h"
#include "frames/campaign_files.h"
#include "image/png_file.h"
#include "image_files/image_reader.h"

namespace seedframe {

Result<Image<std::uint8_t>> read_frame_image(const std::filesystem::path& folder,
                                             ImageFormat format) {
  const std::filesystem::path path = folder / frame_files::image(format);
  if (format == ImageFormat::kPng) return read_png8(path);
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return fail(ErrorKind::kCorrupt, "{}", bytes.error().message);
  Result<Image<std::uint8_t>> image = decode_image8(*bytes, *image_kind_of(path), path.string());
  if (image && image->channels == 3) return image;
  if (image) {
    return fail(ErrorKind::kCorrupt, "{}: expected RGB, found {} channels", path.string(),
                image->channels);
  }
  const bool of_the_file = image.error().kind == ErrorKind::kInput;
  return tl::unexpected(
      Error{of_the_file ? ErrorKind::kCorrupt : image.error().kind, image.error().message});
}

}  // namespace seedframe
