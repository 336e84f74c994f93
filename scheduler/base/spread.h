// A few of many, spread over all of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace seedframe {

/// From the middle of each of `wanted` equal parts of 0 … count - 1, rising; all where there are
/// not more.
inline std::vector<std::int64_t> spread_over(std::int64_t count, std::int64_t wanted) {
  wanted = std::min(count, wanted);
  std::vector<std::int64_t> chosen;
  for (std::int64_t i = 0; i < wanted; ++i) chosen.push_back((2 * i + 1) * count / (2 * wanted));
  return chosen;
}

}  // namespace seedframe
