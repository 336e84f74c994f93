// How large a YAML document may be; looked at before it becomes a tree.
#pragma once

#include <cstddef>
#include <string>

#include "base/error.h"

namespace seedframe {

/// Values and keys of a document, those of aliases counted each time they are used.
inline constexpr int kMostYamlNodes = 250'000;
/// Mappings and lists in each other.
inline constexpr int kDeepestYaml = 64;
/// Of all texts and of the paths to them, those of aliases counted each time they are used.
inline constexpr std::size_t kMostYamlBytes = 64u << 20;

/// Goes through the text without keeping anything: a node of a tree takes hundreds of bytes, where
/// two are enough to write it. Errors (kInput, with line and column): not YAML, more values or
/// levels than above, a text that is not UTF-8 once its escapes are read. Aliases count once here:
/// only the tree knows what they stand for.
Status check_yaml_size(const std::string& text, const std::string& file);

}  // namespace seedframe
