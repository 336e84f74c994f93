// Faults that scripts/lint.sh must find. What the libraries' headers have, it need not look at.
#include "planted.h"

#include <algorithm>
#include <map>
#include <vector>

namespace seedframe {

std::string used(std::string text) {  // planted: performance-unnecessary-value-param
  return twice(std::string(text)) + text;
}

int BadName(int a) {  // planted: readability-identifier-naming
  return a - a;       // planted: misc-redundant-expression
}

bool is_kept(std::vector<int> values) {
  std::remove(values.begin(), values.end(), 3);      // planted: bugprone-unused-return-value
  const auto size = [](std::map<int, int> counts) {  // planted: performance-unnecessary-value-param
    return counts.size();
  };
  return size({}) == 0;
}

}  // namespace seedframe
