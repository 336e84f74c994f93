#include "image_files/radiance_header.h"

#include <algorithm>
#include <cctype>

namespace seedframe {
namespace {

constexpr std::size_t kLongestHeader = 65'536;
constexpr std::string_view kFormat = "FORMAT=";

/// The next line without its LF; false at the end, or where the header has no end.
bool take_line(std::string_view& text, std::string_view& line) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return false;
  line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return true;
}

/// "-Y 512 +X 1024"
bool is_usual_order(std::string_view line) {
  const auto take = [&line](std::string_view expected) {
    if (!line.starts_with(expected)) return false;
    line.remove_prefix(expected.size());
    const auto digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    const auto end = std::find_if_not(line.begin(), line.end(), digit);
    const auto digits = static_cast<std::size_t>(end - line.begin());
    line.remove_prefix(digits);
    return digits > 0;
  };
  return take("-Y ") && take(" +X ") && line.empty();
}

}  // namespace

Status check_radiance_header(std::string_view bytes, const std::string& what) {
  std::string_view text = bytes.substr(0, kLongestHeader);
  std::string_view line;
  std::string_view format;
  while (take_line(text, line) && !line.empty()) {
    if (line.ends_with('\r')) {
      return fail(ErrorKind::kInput,
                  "{} has lines that end with CR LF, as after a transfer in text mode, which also "
                  "damages pixels: get the file again, as binary",
                  what);
    }
    if (line.starts_with(kFormat)) format = line.substr(kFormat.size());
  }
  if (format == "32-bit_rle_xyze") {
    return fail(ErrorKind::kInput, "{} holds XYZE, which Blender does not read: save it as RGBE",
                what);
  }
  if (format != "32-bit_rle_rgbe") {
    return fail(ErrorKind::kInput,
                "{} is no Radiance file: its header has no line FORMAT=32-bit_rle_rgbe that ends "
                "with LF",
                what);
  }
  if (!take_line(text, line)) {
    return fail(ErrorKind::kInput, "{} is cut: its header ends before its size", what);
  }
  if (!is_usual_order(line)) {
    return fail(
        ErrorKind::kInput,
        "{} has the size or the order of its pixels as '{}', where '-Y <height> +X <width>' "
        "is expected: save it anew, from top to bottom and left to right",
        what, std::string(line.substr(0, 60)));
  }
  return {};
}

}  // namespace seedframe
