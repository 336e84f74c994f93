// What the program says to a person.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/message_text.h"

namespace seedframe {

/// Prints to standard output, without what a terminal would obey: names and messages may be a
/// stranger's.
template <class... Arguments>
void say(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  const std::string text = printable(fmt::format(format, std::forward<Arguments>(arguments)...));
  std::fwrite(text.data(), 1, text.size(), stdout);
}

/// The same to standard error.
template <class... Arguments>
void say_aside(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  const std::string text = printable(fmt::format(format, std::forward<Arguments>(arguments)...));
  std::fwrite(text.data(), 1, text.size(), stderr);
}

/// The text with its lines broken between words so that none has more than `columns` characters,
/// but for words that are longer; what was broken goes on two columns further in.
std::string wrapped(const std::string& text, std::size_t columns);

}  // namespace seedframe
