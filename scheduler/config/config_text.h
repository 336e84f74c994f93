// Checks of a config's text before it is parsed, and its numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"

namespace seedframe {

/// In bytes.
inline constexpr std::uintmax_t kLargestConfig = 16u << 20;

/// Characters: yaml-cpp keeps each bracket of a line until it knows whether it begins a key.
inline constexpr std::size_t kLongestLine = 1u << 20;

/// Errors (kInput, with line and column): bytes that are not UTF-8, which no JSON could hold later,
/// and control characters other than tabs and ends of lines: to yaml-cpp some of them are the end;
/// and lines longer than kLongestLine.
Status check_config_text(std::string_view text, const std::string& file);

/// A decimal number such as "3", "-0.5", "+2", "1e-3", or none. One that is too large is infinite,
/// one that is too small is 0; "nan" and "inf" are numbers here.
std::optional<double> parse_double(std::string_view text);

}  // namespace seedframe
