// Bisection over conditions, against every set of culprits of up to three.

#include "audit/culprit.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

Conditions all_conditions() { return *parse_conditions("all"); }

/// What find_culprits finds when just varying all of `culprits` together flips the outcome.
Conditions found(const Conditions& culprits, int& questions) {
  questions = 0;
  const auto flips = [&](const Conditions& varied) -> Result<bool> {
    ++questions;
    return std::includes(varied.begin(), varied.end(), culprits.begin(), culprits.end());
  };
  return *find_culprits(all_conditions(), flips);
}

TEST(Culprit, OneIsFoundInFewQuestions) {
  for (const Condition culprit : all_conditions()) {
    int questions = 0;
    EXPECT_EQ(found({culprit}, questions), Conditions{culprit});
    EXPECT_LE(questions, 8) << "twice the logarithm of nine, rounded up";
  }
}

TEST(Culprit, ThoseThatActOnlyTogetherAreAllFound) {
  int questions = 0;
  for (const Condition a : all_conditions()) {
    for (const Condition b : all_conditions()) {
      EXPECT_EQ(found({a, b}, questions), (Conditions{a, b}));
      for (const Condition c : all_conditions()) {
        EXPECT_EQ(found({a, b, c}, questions), (Conditions{a, b, c}));
      }
    }
  }
}

TEST(Culprit, AnErrorEndsTheSearch) {
  const auto broken = [](const Conditions&) -> Result<bool> {
    return fail(ErrorKind::kEnvironment, "no Blender");
  };
  EXPECT_FALSE(find_culprits(all_conditions(), broken));
}

TEST(Condition, ListsAreRead) {
  EXPECT_EQ(parse_conditions("threads,order"),
            (Conditions{Condition::kThreads, Condition::kOrder}));
  EXPECT_EQ(parse_conditions("none"), Conditions{});
  EXPECT_EQ(describe(*parse_conditions("order,threads")), "threads, order");
  const auto unknown = parse_conditions("threads,ordre");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("did you mean 'order'"), std::string::npos);
}

}  // namespace
}  // namespace seedframe
