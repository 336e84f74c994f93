#include "base/philox.h"

#include <string>

#include <Random123/philox.h>

#include "base/sha256.h"

namespace seedframe {

PhiloxStream::PhiloxStream(std::uint64_t seed, std::string_view name) {
  std::string text = "seedframe-stream-1";
  text += '\0';
  text += std::to_string(seed);
  text += '\0';
  text += name;
  key_ = std::stoull(sha256_hex(text).substr(0, 16), nullptr, 16);
}

std::uint64_t PhiloxStream::bits(const Position& position) const {
  const r123::Philox4x32::ctr_type counter = {
      {position.scene, position.frame, position.copy, position.attempt}};
  const r123::Philox4x32::key_type key = {
      {static_cast<std::uint32_t>(key_ >> 32), static_cast<std::uint32_t>(key_)}};
  const auto words = r123::Philox4x32()(counter, key);
  return (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
}

std::uint32_t PhiloxStream::cycles_seed(const Position& position) const {
  return static_cast<std::uint32_t>(bits(position) >> 33);
}

double PhiloxStream::uniform(const Position& position) const {
  constexpr double kTwoToMinus52 = 1.0 / 4503599627370496.0;
  return (static_cast<double>(bits(position) >> 12) + 0.5) * kTwoToMinus52;
}

}  // namespace seedframe
