#include "base/philox.h"

#include <set>

#include <gtest/gtest.h>

#include "base/canonical_json.h"

namespace seedframe {
namespace {

// Pinned: a change here changes every campaign that anyone has ever rendered.
TEST(PhiloxStream, FirstDrawsAreWhatTheyHaveAlwaysBeen) {
  const PhiloxStream stream(1, "variables.scene.x");
  EXPECT_EQ(stream.bits({}), 6255407832052008774u);
  EXPECT_EQ(stream.bits({.scene = 0}), 8921575278259915434u);
  EXPECT_EQ(stream.bits({.scene = 0, .frame = 0, .copy = 0, .attempt = 1}), 10311625025592761270u);
  EXPECT_EQ(canonical_json(stream.uniform({.scene = 3, .frame = 2})), "0.8171076993170222");
}

TEST(PhiloxStream, ASeedOfCyclesIsTheFirst31Bits) {
  const PhiloxStream stream(1, "variables.scene.x");
  EXPECT_EQ(stream.cycles_seed({}), 6255407832052008774u >> 33);
}

TEST(PhiloxStream, SeedZeroIsASeedLikeAnyOther) {
  EXPECT_NE(PhiloxStream(0, "x").bits({}), PhiloxStream(1, "x").bits({}));
}

TEST(PhiloxStream, EveryPartOfTheKeyMatters) {
  const PhiloxStream stream(7, "x");
  const std::set<std::uint64_t> draws = {
      stream.bits({}),
      stream.bits({.scene = 1}),
      stream.bits({.frame = 1}),
      stream.bits({.copy = 1}),
      stream.bits({.attempt = 1}),
      PhiloxStream(8, "x").bits({}),
      PhiloxStream(7, "y").bits({}),
  };
  EXPECT_EQ(draws.size(), 7u);
}

TEST(PhiloxStream, NamesAndSeedsDoNotRunTogether) {
  EXPECT_NE(PhiloxStream(1, "2x").bits({}), PhiloxStream(12, "x").bits({}));
}

TEST(PhiloxStream, UniformStaysInsideTheOpenIntervalAndIsEven) {
  const PhiloxStream stream(42, "even");
  constexpr int kDraws = 20000;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const double u = stream.uniform({.scene = i});
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.01);  // 4.9 standard errors
}

}  // namespace
}  // namespace seedframe
