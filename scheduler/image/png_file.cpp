#include "image/png_file.h"

#include <bit>
#include <cassert>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little, "16-bit samples are swapped for PNG");

// ---- Writing. Nothing can fail but memory, so an error of libpng is a programmer's mistake.

[[noreturn]] void abort_on_error(png_structp, png_const_charp message) {
  std::fprintf(stderr, "encode_png: %s\n", message);
  std::abort();
}

void ignore_warning(png_structp, png_const_charp) {}

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) noexcept {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), count);
}

// Between noisy pixels there are no long matches to find, so runs and a Huffman code are as small
// as zlib's usual search, in half the time (docs/formats/images.md has the measurement).
constexpr int kZlibStrategy = Z_RLE;
constexpr int kZlibLevel = 1;
constexpr int kColorFilter = PNG_FILTER_AVG;  // noise: the mean of two neighbours predicts best
constexpr int kLabelFilter = PNG_FILTER_UP;   // flat regions: rows repeat

template <class T>
std::string encode(const Image<T>& image, PngContent content, std::optional<int> level = {},
                   const Palette* palette = nullptr) {
  constexpr int kBitDepth = 8 * sizeof(T);
  const bool photo = image.channels == 3 && content == PngContent::kPhoto;
  const int color = palette != nullptr    ? PNG_COLOR_TYPE_PALETTE
                    : image.channels == 3 ? PNG_COLOR_TYPE_RGB
                                          : PNG_COLOR_TYPE_GRAY;
  std::string bytes;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, abort_on_error, ignore_warning);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, append_bytes, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), kBitDepth, color, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (palette != nullptr) {
    std::vector<png_color> colors;
    for (const auto& [red, green, blue] : *palette) colors.push_back({red, green, blue});
    png_set_PLTE(png, info, colors.data(), static_cast<int>(colors.size()));
  }
  if (photo) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_strategy(png, level ? Z_DEFAULT_STRATEGY : kZlibStrategy);
  png_set_compression_level(png, level.value_or(kZlibLevel));
  png_set_filter(png, PNG_FILTER_TYPE_BASE, photo ? kColorFilter : kLabelFilter);
  png_write_info(png, info);
  if (kBitDepth == 16) png_set_swap(png);
  const std::size_t row_values =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  for (int y = 0; y < image.height; ++y) {
    const T* row = image.values.data() + static_cast<std::size_t>(y) * row_values;
    png_write_row(png, reinterpret_cast<png_const_bytep>(row));
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

// ---- Reading. libpng leaves a function by longjmp on an error, so the functions between setjmp
// and libpng hold nothing that has a destructor.

struct PngInput {
  const char* bytes = nullptr;
  std::size_t size = 0;
  std::size_t position = 0;
  char message[128] = "";
};

[[noreturn]] void leave_on_error(png_structp png, png_const_charp message) {
  auto* input = static_cast<PngInput*>(png_get_error_ptr(png));
  std::snprintf(input->message, sizeof input->message, "%s", message);
  png_longjmp(png, 1);
}

void take_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto* input = static_cast<PngInput*>(png_get_io_ptr(png));
  if (count > input->size - input->position) png_error(png, "the file ends too early");
  std::memcpy(bytes, input->bytes + input->position, count);
  input->position += count;
}

bool read_header(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_info(png, info);
  return true;
}

bool read_pixels(png_structp png, png_infop info, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  if (png_get_bit_depth(png, info) == 16) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

class PngReader {
 public:
  explicit PngReader(PngInput& input)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, leave_on_error, ignore_warning)),
        info_(png_create_info_struct(png_)) {
    png_set_read_fn(png_, &input, take_bytes);
    // Damage anywhere is damage: the defaults forgive it outside the pixels.
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_benign_errors(png_, 0);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool header() { return read_header(png_, info_); }
  bool pixels(png_bytepp rows) { return read_pixels(png_, info_, rows); }

  int width() const { return static_cast<int>(png_get_image_width(png_, info_)); }
  int height() const { return static_cast<int>(png_get_image_height(png_, info_)); }
  int bit_depth() const { return png_get_bit_depth(png_, info_); }
  bool has_palette() const { return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE; }
  Palette palette() const {
    png_colorp colors = nullptr;
    int count = 0;
    png_get_PLTE(png_, info_, &colors, &count);
    Palette palette(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < palette.size(); ++i) {
      palette[i] = {colors[i].red, colors[i].green, colors[i].blue};
    }
    return palette;
  }
  /// 0: neither grey nor RGB.
  int channels() const {
    switch (png_get_color_type(png_, info_)) {
      case PNG_COLOR_TYPE_GRAY:
        return 1;
      case PNG_COLOR_TYPE_RGB:
        return 3;
      default:
        return 0;
    }
  }

 private:
  png_structp png_;
  png_infop info_;
};

// Deflate makes at most 1032 bytes of one (zlib's technical notes), so a small file with a large
// picture is a lie, told before its pixels are given memory.
bool can_hold(std::size_t file_bytes, std::size_t pixel_bytes) {
  constexpr std::size_t kMostExpansion = 1032;
  return pixel_bytes / kMostExpansion <= file_bytes;
}

tl::unexpected<Error> damaged(const std::string& what, const char* reason) {
  return fail(ErrorKind::kCorrupt,
              "{} is not the whole PNG file that was written: {}; render the frame again", what,
              reason);
}

template <class T>
Result<Image<T>> decode(std::string_view bytes, const std::string& what, bool color_allowed,
                        Palette* palette = nullptr) {
  constexpr int kBitDepth = 8 * sizeof(T);
  PngInput input{bytes.data(), bytes.size()};
  PngReader reader(input);
  if (!reader.header()) return damaged(what, input.message);
  const bool with_palette = palette != nullptr && reader.has_palette();
  if (palette != nullptr && !with_palette) {
    return fail(ErrorKind::kCorrupt, "{}: expected a palette", what);
  }
  if (with_palette) *palette = reader.palette();
  const int channels = with_palette ? 1 : reader.channels();
  if (reader.bit_depth() != kBitDepth || channels == 0 || (channels == 3 && !color_allowed)) {
    return fail(ErrorKind::kCorrupt, "{}: expected {} with {} bits a channel, found {} with {}",
                what, color_allowed ? "grey or RGB" : "grey", kBitDepth,
                channels == 1   ? "grey"
                : channels == 3 ? "RGB"
                                : "a palette or alpha",
                reader.bit_depth());
  }
  const std::size_t row_values =
      static_cast<std::size_t>(reader.width()) * static_cast<std::size_t>(channels);
  const auto height = static_cast<std::size_t>(reader.height());
  if (!can_hold(bytes.size(), row_values * sizeof(T) * height)) {
    return damaged(what, "it is too short for the size that it states");
  }

  Image<T> image(reader.width(), reader.height(), channels);
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) {
    rows[y] = reinterpret_cast<png_bytep>(image.values.data() + y * row_values);
  }
  if (!reader.pixels(rows.data())) return damaged(what, input.message);
  if (input.position != input.size) return damaged(what, "bytes follow its end");
  return image;
}

}  // namespace

std::string encode_png(const Image<std::uint8_t>& image, PngContent content,
                       std::optional<int> level) {
  assert(image.channels == 1 || image.channels == 3);
  return encode(image, content, level);
}

std::string encode_palette_png(const Image<std::uint8_t>& image, const Palette& palette) {
  assert(image.channels == 1 && !palette.empty() && palette.size() <= 256);
  return encode(image, PngContent::kLabels, std::nullopt, &palette);
}

std::string encode_png(const Image<std::uint16_t>& image) {
  assert(image.channels == 1);
  return encode(image, PngContent::kLabels);
}

Result<Image<std::uint8_t>> decode_png8(std::string_view bytes, const std::string& what) {
  return decode<std::uint8_t>(bytes, what, true);
}

Result<Image<std::uint16_t>> decode_png16(std::string_view bytes, const std::string& what) {
  return decode<std::uint16_t>(bytes, what, false);
}

Result<Image<std::uint8_t>> decode_palette_png(std::string_view bytes, const std::string& what,
                                               Palette& palette) {
  return decode<std::uint8_t>(bytes, what, false, &palette);
}

Result<Image<std::uint8_t>> read_png8(const fs::path& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return fail(ErrorKind::kCorrupt, "{}", bytes.error().message);
  return decode_png8(*bytes, path.string());
}

Result<Image<std::uint16_t>> read_png16(const fs::path& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return fail(ErrorKind::kCorrupt, "{}", bytes.error().message);
  return decode_png16(*bytes, path.string());
}

}  // namespace seedframe
