#include "console/say.h"

#include <algorithm>

#include "base/utf8.h"

namespace seedframe {
namespace {

std::size_t character_count(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++count) {
    i += std::max<std::size_t>(1, utf8_length(text, i));
  }
  return count;
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t columns) {
  std::string out;
  std::size_t column = 0, begin = 0;
  while (begin < text.size()) {
    // A word with the spaces before it.
    const std::size_t word = text.find_first_not_of(' ', begin);
    if (word == std::string::npos) break;
    const std::size_t end = std::min({text.find(' ', word), text.find('\n', word), text.size()});
    const std::size_t length = character_count(std::string_view(text).substr(begin, end - begin));
    const bool breaks = column > 0 && column + length > columns;
    const std::size_t from = breaks ? word : begin;
    out += breaks ? "\n  " : "";
    out += text.substr(from, end - from);
    column = breaks ? 2 + length - (word - begin) : column + length;
    begin = end;
    if (begin < text.size() && text[begin] == '\n') {
      out += '\n';
      column = 0;
      ++begin;
    }
  }
  return out;
}

}  // namespace seedframe
