// Even coverage: a dimension of the Sobol' sequence, scrambled, any point of it by its index.
#pragma once

#include <array>
#include <cstdint>

namespace seedframe {

/// Direction numbers of Joe and Kuo ("Constructing Sobol sequences with better two-dimensional
/// projections", SIAM J. Sci. Comput. 30, 2008; Boost's table) and a nested uniform ("Owen")
/// scramble by hashing (B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020): every
/// aligned block of 2^k indices puts one point into each of the 2^k equal parts of (0, 1).
class SobolDimension {
 public:
  /// dimension < 3667.
  explicit SobolDimension(int dimension);

  /// In (0, 1), with 32 bits. Another scramble gives another sequence with the same evenness.
  double point(std::uint32_t index, std::uint32_t scramble) const;

 private:
  std::array<std::uint32_t, 32> directions_{};
};

}  // namespace seedframe
