// Randomness as a pure function: no generator is ever advanced, a draw is asked for by its key.
#pragma once

#include <cstdint>
#include <string_view>

namespace seedframe {

/// Stands in for an index that a draw does not depend on (a campaign-level draw has no scene).
inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

/// A named stream of draws: Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as
/// 1, 2, 3", SC 2011; the Random123 library) with the first 64 bits of
/// SHA-256("seedframe-stream-1" 0 seed 0 name) as its key. Streams of other names or seeds are
/// independent, so adding a variable changes no other variable's draws.
class PhiloxStream {
 public:
  PhiloxStream(std::uint64_t seed, std::string_view name);

  /// Where in the campaign a draw stands; it is the Philox counter.
  struct Position {
    std::uint32_t scene = kNoIndex;
    std::uint32_t frame = kNoIndex;
    std::uint32_t copy = kNoIndex;
    std::uint32_t attempt = 0;
  };

  /// A uniform double in the open interval (0, 1): (k + 1/2) / 2^52 with k of 52 random bits.
  double uniform(const Position& position) const;
  /// 64 random bits.
  std::uint64_t bits(const Position& position) const;
  /// 31 random bits: a seed of Cycles, which is a signed 32-bit integer.
  std::uint32_t cycles_seed(const Position& position) const;

 private:
  std::uint64_t key_;
};

}  // namespace seedframe
