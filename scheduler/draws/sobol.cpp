#include "draws/sobol.h"

#include <bit>

#include <boost/random/sobol.hpp>

namespace seedframe {
namespace {

using Table = boost::random::default_sobol_table;
constexpr std::size_t kBits = 32;

std::uint32_t reversed(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

/// Each bit is flipped depending on the bits below it only (Laine and Karras, "Stratified sampling
/// for stochastic transparency", EGSR 2011, with Burley's use of it).
std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

}  // namespace

SobolDimension::SobolDimension(int dimension) {
  if (dimension == 0) {  // van der Corput
    for (std::size_t i = 0; i < kBits; ++i) directions_[i] = 1u << (kBits - 1 - i);
    return;
  }
  // Recurrence (2) of Bratley and Fox, "Algorithm 659", TOMS 14 (1988): with the polynomial's
  // coefficients a_k, m_i = m_{i-d} xor 2^d m_{i-d} xor the terms 2^k a_k m_{i-k}.
  const auto row = static_cast<std::size_t>(dimension - 1);
  const std::uint32_t polynomial = Table::polynomial(row);
  const auto degree = static_cast<std::size_t>(std::bit_width(polynomial)) - 1;
  std::array<std::uint32_t, kBits> m{};
  for (std::size_t i = 0; i < kBits; ++i) {
    if (i < degree) {
      m[i] = Table::minit(row, i);
      continue;
    }
    m[i] = m[i - degree];
    for (std::size_t k = 1; k <= degree; ++k) {
      const std::uint32_t coefficient = (polynomial >> (degree - k)) & 1u;
      m[i] ^= coefficient * (m[i - k] << k);
    }
  }
  for (std::size_t i = 0; i < kBits; ++i) directions_[i] = m[i] << (kBits - 1 - i);
}

double SobolDimension::point(std::uint32_t index, std::uint32_t scramble) const {
  std::uint32_t x = 0;
  for (std::size_t i = 0; index != 0; ++i, index >>= 1) {
    if ((index & 1u) != 0) x ^= directions_[i];
  }
  x = reversed(laine_karras(reversed(x), scramble));
  return (static_cast<double>(x) + 0.5) / 4294967296.0;
}

}  // namespace seedframe
