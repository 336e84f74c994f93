#include "audit/condition.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(Conditions, AModeIsAuditedForWhatItPromises) {
  EXPECT_EQ(promised_conditions(Determinism::Mode::kMachine), usual_conditions());
  EXPECT_FALSE(promised_conditions(Determinism::Mode::kMachine).contains(Condition::kIsa));
  EXPECT_TRUE(promised_conditions(Determinism::Mode::kPortable).contains(Condition::kIsa));
}

TEST(Conditions, AreReadFromAListAndToldAsOne) {
  EXPECT_EQ(*parse_conditions("threads,order"),
            (Conditions{Condition::kThreads, Condition::kOrder}));
  EXPECT_TRUE(parse_conditions("none")->empty());
  EXPECT_TRUE(parse_conditions("all")->contains(Condition::kIsa));
  EXPECT_EQ(describe({Condition::kThreads, Condition::kOrder}), "threads, order");
  EXPECT_FALSE(parse_conditions("thread"));
  EXPECT_FALSE(parse_conditions(""));
}

}  // namespace
}  // namespace seedframe
