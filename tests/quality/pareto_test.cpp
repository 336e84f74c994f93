#include "quality/pareto.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ParetoFront, IsEmptyOfNothing) { EXPECT_THAT(pareto_front({}), IsEmpty()); }

TEST(ParetoFront, LeavesOutWhatIsDearerAndNotBetter) {
  EXPECT_THAT(pareto_front({{4, 1}, {1, 8}, {2, 9}, {3, 2}, {5, 1}}), ElementsAre(1, 3, 0));
}

TEST(ParetoFront, OfEquallyCheapOnesTakesTheBetter) {
  EXPECT_THAT(pareto_front({{1, 3}, {1, 2}, {2, 2}}), ElementsAre(1));
}

TEST(ParetoFront, OfEqualOnesTakesTheFirst) {
  EXPECT_THAT(pareto_front({{1, 2}, {1, 2}}), ElementsAre(0));
}

TEST(ParetoFront, HasNoNan) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(pareto_front({{nan, 0}, {0, nan}, {1, 1}}), ElementsAre(2));
}

TEST(ParetoFront, MayBeginWithSomethingInfinitelyWrong) {
  EXPECT_THAT(pareto_front({{1, INFINITY}, {2, 1}}), ElementsAre(0, 1));
}

TEST(CheapestWithin, TakesTheCheapestThatIsGoodEnough) {
  const std::vector<CostAndError> choices = {{4, 1}, {1, 8}, {3, 2}, {3, 1.5}};
  EXPECT_EQ(cheapest_within(choices, 2.0), 3u);
  EXPECT_EQ(cheapest_within(choices, 100.0), 1u);
  EXPECT_EQ(cheapest_within(choices, 1.0), 0u);
  EXPECT_EQ(cheapest_within(choices, 0.5), std::nullopt);
}

}  // namespace
}  // namespace seedframe
