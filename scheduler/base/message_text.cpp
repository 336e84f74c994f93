#include "base/message_text.h"

#include <algorithm>

namespace seedframe {

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;
  return std::string(text.substr(0, end)) + "…";
}

std::string printable(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    // U+0080 to U+009F, in UTF-8 two bytes, are control characters too.
    const bool wide = byte == 0xC2u && i + 1 < text.size() &&
                      static_cast<unsigned char>(text[i + 1]) >= 0x80u &&
                      static_cast<unsigned char>(text[i + 1]) <= 0x9Fu;
    const bool control = (byte < 0x20u && byte != '\n') || byte == 0x7Fu || wide;
    safe += control ? '?' : text[i];
    if (wide) ++i;
  }
  return safe;
}

bool is_one_line_name(std::string_view name) {
  constexpr std::size_t kLongest = 200;
  constexpr std::string_view kLineSeparator = "\u2028";
  constexpr std::string_view kParagraphSeparator = "\u2029";
  return !name.empty() && name.size() <= kLongest && printable(name) == name &&
         name.find('\n') == std::string_view::npos &&
         name.find(kLineSeparator) == std::string_view::npos &&
         name.find(kParagraphSeparator) == std::string_view::npos;
}

}  // namespace seedframe
