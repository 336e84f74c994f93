// Faults that scripts/lint.sh must find, in a header.
#pragma once

#include <string>
#include <utility>

namespace seedframe {

struct Planted {
  int BadMember = 0;  // planted: readability-identifier-naming
};

template <class Text>
std::string twice(Text text) {
  std::string taken = std::move(text);
  return taken + text;  // planted: bugprone-use-after-move
}

}  // namespace seedframe
