// Text from outside, made fit for messages and lists.
#pragma once

#include <string>
#include <string_view>

namespace seedframe {

/// The first `most` bytes, without half a UTF-8 character, and "…"; or all of it.
std::string shortened(std::string_view text, std::size_t most);

/// With '?' for every control character but the end of a line: a terminal would obey them.
std::string printable(std::string_view text);

/// Not empty, at most 200 bytes, without control characters and ends of lines of any kind: it can
/// stand in a list with a name on each line, and in XML.
bool is_one_line_name(std::string_view name);

}  // namespace seedframe
