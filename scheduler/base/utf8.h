// Texts whose bytes may be no UTF-8, as those in files from anywhere.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace seedframe {

/// Bytes of the character that begins at text[i]; 0 if it is not UTF-8 (RFC 3629: shortest form, no
/// surrogates, up to U+10FFFF).
std::size_t utf8_length(std::string_view text, std::size_t i);

bool is_utf8(std::string_view text);

/// The text if it is UTF-8, so that JSON can hold it; otherwise what its bytes are in Latin-1, with
/// '?' for control characters of that.
std::string as_utf8(std::string_view text);

}  // namespace seedframe
