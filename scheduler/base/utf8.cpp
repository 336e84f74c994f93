#include "base/utf8.h"

namespace seedframe {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
}

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t i) {
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

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) return false;
    i += length;
  }
  return true;
}

std::string as_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string converted;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80u) {
      converted += c;
    } else if (byte < 0xA0u) {
      converted += '?';
    } else {
      converted += static_cast<char>(0xC0u | byte >> 6);
      converted += static_cast<char>(0x80u | (byte & 0x3Fu));
    }
  }
  return converted;
}

}  // namespace seedframe
