#include "config/config_text.h"

#include <charconv>
#include <cstdlib>

#include "base/utf8.h"

namespace seedframe {
namespace {

bool is_control(unsigned byte) {
  return (byte < 0x20u && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7Fu;
}

}  // namespace

Status check_config_text(std::string_view text, const std::string& file) {
  std::size_t line = 1;
  std::size_t column = 1;
  for (std::size_t i = 0; i < text.size();) {
    const unsigned byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = utf8_length(text, i);
    if (length == 0 || is_control(byte)) {
      return fail(ErrorKind::kInput, "{}:{}:{}: {} (byte {}): a config is a text in UTF-8", file,
                  line, column, length == 0 ? "this is not UTF-8" : "a control character", byte);
    }
    i += length;
    ++column;
    if (byte == '\n') {
      ++line;
      column = 1;
    }
    if (column > kLongestLine) {
      return fail(ErrorKind::kInput, "{}:{}: the line has more than {} characters", file, line,
                  kLongestLine);
    }
  }
  return {};
}

std::optional<double> parse_double(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (stop != text.data() + text.size() || text.empty()) return std::nullopt;
  // Too large is infinite, too small is 0: strtod tells them apart.
  if (error == std::errc::result_out_of_range) {
    return std::strtod(std::string(text).c_str(), nullptr);
  }
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

}  // namespace seedframe
