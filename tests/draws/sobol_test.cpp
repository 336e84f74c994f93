#include "draws/sobol.h"

#include <bit>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/scene/statistics.h"

namespace seedframe {
namespace {

constexpr std::array<std::uint32_t, 4> kScrambles = {0, 1, 0x9e3779b9u, 0xffffffffu};

/// Whether each of the `cells` equal parts of (0, 1) holds one of as many points from `first` on.
bool one_in_each(const SobolDimension& sobol, std::uint32_t first, std::uint32_t cells,
                 std::uint32_t scramble) {
  std::set<int> seen;
  for (std::uint32_t i = 0; i < cells; ++i) {
    seen.insert(static_cast<int>(sobol.point(first + i, scramble) * cells));
  }
  return seen.size() == cells && *seen.begin() == 0 &&
         *seen.rbegin() == static_cast<int>(cells) - 1;
}

TEST(Sobol, PointsAreInsideTheUnitInterval) {
  for (const int dimension : {0, 1, 2, 7, 100, 999}) {
    const SobolDimension sobol(dimension);
    for (const std::uint32_t scramble : kScrambles) {
      for (const std::uint32_t index : {0u, 1u, 2u, 1000u, 0x7fffffffu, 0xfffffffeu, 0xffffffffu}) {
        const double point = sobol.point(index, scramble);
        EXPECT_GT(point, 0.0);
        EXPECT_LT(point, 1.0);
      }
    }
  }
}

TEST(Sobol, APointDependsOnItsIndexAndScrambleOnly) {
  const SobolDimension one(3);
  const SobolDimension other(3);
  EXPECT_EQ(one.point(77, 5), other.point(77, 5));
  EXPECT_EQ(one.point(77, 5), one.point(77, 5));
  EXPECT_NE(one.point(77, 5), one.point(78, 5));
  EXPECT_NE(one.point(77, 5), one.point(77, 6));
}

TEST(Sobol, EveryAlignedBlockPutsOnePointIntoEachInterval) {
  for (const int dimension : {0, 1, 2, 3, 4, 17, 50, 512, 999}) {
    const SobolDimension sobol(dimension);
    for (const std::uint32_t scramble : kScrambles) {
      for (const std::uint32_t size : {1u, 2u, 16u, 256u, 4096u}) {
        for (const std::uint32_t block : {0u, 1u, 5u, 1000u}) {
          EXPECT_TRUE(one_in_each(sobol, block * size, size, scramble))
              << "dimension " << dimension << ", scramble " << scramble << ", block " << block
              << " of " << size;
        }
      }
    }
  }
}

/// How many leading binary digits two numbers of (0, 1) share, of 32.
int common_digits(double a, double b) {
  const auto x = static_cast<std::uint32_t>(std::ldexp(a, 32));
  const auto y = static_cast<std::uint32_t>(std::ldexp(b, 32));
  return std::countl_zero(x ^ y);
}

// A nested scramble keeps how many leading digits two points share, and nothing else: so that is
// what can be compared with the sequence as it is published.
TEST(Sobol, DimensionZeroIsVanDerCorputs) {
  const SobolDimension sobol(0);
  for (const std::uint32_t scramble : kScrambles) {
    for (std::uint32_t i = 0; i < 200; ++i) {
      for (std::uint32_t j = 0; j < i; ++j) {
        ASSERT_EQ(common_digits(sobol.point(i, scramble), sobol.point(j, scramble)),
                  std::countr_zero(i ^ j));
      }
    }
  }
}

TEST(Sobol, TheFirstPointsAreThosePublished) {
  // The first ten of Joe and Kuo's example in three dimensions, which is in the order of Gray's
  // code.
  const std::vector<std::array<double, 3>> published = {{0, 0, 0},
                                                        {0.5, 0.5, 0.5},
                                                        {0.75, 0.25, 0.25},
                                                        {0.25, 0.75, 0.75},
                                                        {0.375, 0.375, 0.625},
                                                        {0.875, 0.875, 0.125},
                                                        {0.625, 0.125, 0.875},
                                                        {0.125, 0.625, 0.375},
                                                        {0.1875, 0.3125, 0.9375},
                                                        {0.6875, 0.8125, 0.4375}};
  for (std::size_t dimension = 0; dimension < 3; ++dimension) {
    const SobolDimension sobol(static_cast<int>(dimension));
    for (std::uint32_t i = 0; i < published.size(); ++i) {
      for (std::uint32_t j = 0; j < i; ++j) {
        EXPECT_EQ(common_digits(sobol.point(i ^ (i >> 1), 77), sobol.point(j ^ (j >> 1), 77)),
                  common_digits(published[i][dimension], published[j][dimension]))
            << "dimension " << dimension << ", points " << i << " and " << j;
      }
    }
  }
}

TEST(Sobol, ABlockThatIsNotAlignedNeedNotBeEven) {
  // Else the tests above would hold of anything.
  bool uneven = false;
  const SobolDimension sobol(1);
  for (std::uint32_t first = 1; first < 16; ++first) {
    uneven = uneven || !one_in_each(sobol, first, 16, 9);
  }
  EXPECT_TRUE(uneven);
}

/// Whether 2^m points fall one into each of the boxes of 2^-a by 2^-(m-a), for every a.
bool is_net(const SobolDimension& x, const SobolDimension& y, std::uint32_t first, int m,
            std::uint32_t scramble_x, std::uint32_t scramble_y) {
  const std::uint32_t count = 1u << m;
  for (int a = 0; a <= m; ++a) {
    std::set<std::pair<int, int>> boxes;
    for (std::uint32_t i = first; i < first + count; ++i) {
      boxes.emplace(static_cast<int>(std::ldexp(x.point(i, scramble_x), a)),
                    static_cast<int>(std::ldexp(y.point(i, scramble_y), m - a)));
    }
    if (boxes.size() != count) return false;
  }
  return true;
}

TEST(Sobol, TheFirstTwoDimensionsAreANet) {
  const SobolDimension x(0);
  const SobolDimension y(1);
  for (const int m : {1, 4, 7, 10}) {
    for (const std::uint32_t block : {0u, 3u}) {
      EXPECT_TRUE(is_net(x, y, block << m, m, 0, 0)) << m;
      EXPECT_TRUE(is_net(x, y, block << m, m, 123, 0xdeadbeefu)) << m;
    }
  }
}

TEST(Sobol, ADimensionAndItselfAreNoNet) {
  const SobolDimension x(0);
  EXPECT_FALSE(is_net(x, x, 0, 7, 1, 2));
}

TEST(Sobol, DimensionsHaveTheirOwnOrder) {
  // Unscrambled they would be other permutations of the same points; so they are scrambled alike.
  std::set<std::vector<int>> orders;
  for (int dimension = 0; dimension < 40; ++dimension) {
    const SobolDimension sobol(dimension);
    std::vector<int> order;
    for (std::uint32_t i = 0; i < 256; ++i) {
      order.push_back(static_cast<int>(sobol.point(i, 3) * 256));
    }
    orders.insert(order);
  }
  EXPECT_EQ(orders.size(), 40u);
}

TEST(Sobol, ScramblesAreUniformAndUnlikeEachOther) {
  const SobolDimension sobol(2);
  std::vector<double> first;
  std::vector<double> second;
  for (std::uint32_t scramble = 0; scramble < 20'000; ++scramble) {
    first.push_back(sobol.point(5, scramble * 2654435761u));
    second.push_back(sobol.point(6, scramble * 2654435761u));
  }
  const auto cdf = [](double x) { return x; };
  EXPECT_GT(kolmogorov_p(first, cdf), kLeastP);
  EXPECT_GT(kolmogorov_p(second, cdf), kLeastP);
}

TEST(Sobol, ItsMeanIsFarNearerThanThatOfRandomNumbers) {
  // The integral of x·y over the unit square is 1/4; 4096 random points are off by about 0.003.
  const SobolDimension x(0);
  const SobolDimension y(1);
  double sum = 0.0;
  for (std::uint32_t i = 0; i < 4096; ++i) sum += x.point(i, 11) * y.point(i, 12);
  EXPECT_NEAR(sum / 4096.0, 0.25, 1e-4);
}

}  // namespace
}  // namespace seedframe
