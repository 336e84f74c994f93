#include "slurm/frame_ledger.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

using Frames = std::vector<std::int64_t>;

class FrameLedgerTest : public ::testing::Test {
 protected:
  FrameLedgerTest() {
    for (std::int64_t frame = 0; frame < 4; ++frame) {
      ledger_.add({frame, static_cast<int>(frame), 0}, "id" + std::to_string(frame));
    }
  }

  FrameLedger ledger_{{.errors = 2, .crashes = 2}};
};

TEST_F(FrameLedgerTest, AFrameIsTakenOnce) {
  ledger_.give_out(2, {1, 0});
  EXPECT_EQ(ledger_.out(), 1);
  const auto taken = ledger_.take(2, 3);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->frame_id, "id2");
  EXPECT_EQ(taken->first_attempt, 3) << "after the two that there were";
  EXPECT_FALSE(ledger_.take(2, 1)) << "settling";
  EXPECT_TRUE(ledger_.any_settling());
  ledger_.settle_done(2);
  EXPECT_FALSE(ledger_.take(2, 1)) << "over";
  EXPECT_FALSE(ledger_.take(99, 1)) << "not wanted";
  EXPECT_EQ(ledger_.summary().committed, 1);
  EXPECT_EQ(ledger_.summary().left, 3);
}

TEST_F(FrameLedgerTest, WhatNobodyGaveOutIsTakenToo) {
  EXPECT_TRUE(ledger_.take(1, 1)) << "an earlier head's task has made it";
}

TEST_F(FrameLedgerTest, LostFramesAreGivenOutByHowOftenTheyWere) {
  for (const std::int64_t frame : {0, 1}) ledger_.give_out(frame, {1, 0});
  EXPECT_EQ(ledger_.out_with({1, 0}, {0, 1, 2, 3}), (Frames{0, 1}));
  EXPECT_EQ(ledger_.lose(0, false).consequence, Consequence::kRetry);
  ledger_.give_back(1);
  const auto free = ledger_.free_frames();
  EXPECT_EQ(free.at(0), (Frames{1, 2, 3}));
  EXPECT_EQ(free.at(1), (Frames{0}));
}

TEST_F(FrameLedgerTest, OnlyAFrameThatIsAloneIsToBlame) {
  for (int i = 0; i < 5; ++i) {
    ledger_.give_out(0, {i, 0});
    EXPECT_EQ(ledger_.lose(0, false).consequence, Consequence::kRetry);
  }
  ledger_.give_out(0, {6, 0});
  EXPECT_EQ(ledger_.lose(0, true).consequence, Consequence::kRetry);
  ledger_.give_out(0, {7, 0});
  const FrameLedger::Lost lost = ledger_.lose(0, true);
  EXPECT_EQ(lost.consequence, Consequence::kQuarantined);
  EXPECT_EQ(lost.attempt, 1);
  ledger_.settle_failed(0, lost.consequence);
  EXPECT_EQ(ledger_.summary().quarantined, 1);
}

TEST_F(FrameLedgerTest, RefusedResultsAreTriedAgain) {
  ASSERT_TRUE(ledger_.take(3, 1));
  EXPECT_EQ(ledger_.refuse(3), Consequence::kRetry);
  ledger_.settle_failed(3, Consequence::kRetry);
  EXPECT_EQ(ledger_.free_frames().at(0), (Frames{0, 1, 2, 3}));
  const auto again = ledger_.take(3, 1);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->first_attempt, 5);
  EXPECT_EQ(ledger_.refuse(3), Consequence::kFailed);
  ledger_.settle_failed(3, Consequence::kFailed);
  EXPECT_EQ(ledger_.summary().failed, 1);
}

TEST_F(FrameLedgerTest, IsOverWhenAllAre) {
  for (std::int64_t frame = 0; frame < 4; ++frame) {
    EXPECT_FALSE(ledger_.all_over());
    ASSERT_TRUE(ledger_.take(frame, 1));
    ledger_.settle_done(frame);
  }
  EXPECT_TRUE(ledger_.all_over());
}

}  // namespace
}  // namespace seedframe
