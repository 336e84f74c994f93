#include "base/message_text.h"

#include <algorithm>

#include "base/utf8.h"

namespace seedframe {
namespace {

/// Whether a terminal does something else with a character than to show it: control characters, and
/// those that turn or break what is written around them (UAX #9, bidirectional text; U+2028 and
/// U+2029).
bool is_obeyed(std::string_view character) {
  const auto byte = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return (byte < 0x20u && byte != '\n') || byte == 0x7Fu;
  const auto second = static_cast<unsigned char>(character[1]);
  if (character.size() == 2) {
    return (byte == 0xC2u && second <= 0x9Fu) || character == "\u061c";
  }
  if (character.size() != 3 || byte != 0xE2u) return false;
  const auto third = static_cast<unsigned char>(character[2]);
  const bool marks = second == 0x80u && (third == 0x8Eu || third == 0x8Fu);
  const bool breaks_and_turns = second == 0x80u && third >= 0xA8u && third <= 0xAEu;
  const bool isolates = second == 0x81u && third >= 0xA6u && third <= 0xA9u;
  return marks || breaks_and_turns || isolates;
}

}  // namespace

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;
  return std::string(text.substr(0, end)) + "…";
}

std::string printable(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const std::string_view character = text.substr(i, std::max<std::size_t>(length, 1));
    if (length == 0 || is_obeyed(character)) {
      safe += '?';
    } else {
      safe += character;
    }
    i += character.size();
  }
  return safe;
}

bool is_one_line_name(std::string_view name) {
  constexpr std::size_t kLongest = 200;
  return !name.empty() && name.size() <= kLongest && printable(name) == name &&
         name.find('\n') == std::string_view::npos;
}

}  // namespace seedframe
