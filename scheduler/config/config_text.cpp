#include "config/config_text.h"

#include <charconv>
#include <cstdlib>

namespace seedframe {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
}

/// Bytes of the character that begins at `i`; 0 if it is not UTF-8 (RFC 3629: shortest form, no
/// surrogates, up to U+10FFFF).
std::size_t character_length(std::string_view text, std::size_t i) {
  const unsigned first = byte_at(text, i);
  if (first < 0x80u) return 1;
  const std::size_t length = first >= 0xF0u ? 4 : (first >= 0xE0u ? 3 : 2);
  if (first < 0xC2u || first > 0xF4u) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte_at(text, i + k) & 0xC0u) != 0x80u) return 0;
  }
  const unsigned second = byte_at(text, i + 1);
  const bool wrong = (first == 0xE0u && second < 0xA0u) || (first == 0xEDu && second > 0x9Fu) ||
                     (first == 0xF0u && second < 0x90u) || (first == 0xF4u && second > 0x8Fu);
  return wrong ? 0 : length;
}

bool is_control(unsigned byte) {
  return (byte < 0x20u && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7Fu;
}

}  // namespace

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_length(text, i);
    if (length == 0) return false;
    i += length;
  }
  return true;
}

Status check_config_text(std::string_view text, const std::string& file) {
  std::size_t line = 1;
  std::size_t column = 1;
  for (std::size_t i = 0; i < text.size();) {
    const unsigned byte = byte_at(text, i);
    const std::size_t length = character_length(text, i);
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
