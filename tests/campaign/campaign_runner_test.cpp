#include "campaign/campaign_runner.h"

#include <csignal>

#include <gmock/gmock.h>

#include "campaign/drain_signals.h"
#include "tests/campaign/campaign_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

class CampaignRunnerTest : public CampaignFixture {
 protected:
  CampaignRunnerTest() {
    setup_.options.pool.workers = 2;
    setup_.options.worker.threads = 1;
  }

  UsedFiles used_;
  RunSetup setup_;
};

TEST_F(CampaignRunnerTest, RunsEveryFrameAndTellsOfEach) {
  CampaignRunner all(campaign(), *prepared_, used_, setup_, observer_);
  const Result<RunSummary> summary = all.run_to_end(all_frames());
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, kFrames);
  EXPECT_EQ(summary->left, 0);
  EXPECT_EQ(observer_.done.size(), static_cast<std::size_t>(kFrames));
  EXPECT_THAT(observer_.failed, IsEmpty());
  EXPECT_THAT(observer_.pauses, IsEmpty());
  EXPECT_EQ(counts().done, kFrames);
  EXPECT_FALSE(std::filesystem::exists(campaign().files.work())) << "nothing is left behind";
  EXPECT_TRUE(std::filesystem::exists(campaign().files.provenance()));
}

TEST_F(CampaignRunnerTest, RunsOnlyTheFramesThatItIsGiven) {
  CampaignRunner some(campaign(), *prepared_, used_, setup_, observer_);
  ASSERT_TRUE(some.run_to_end({{3}, {7}}));
  EXPECT_THAT(observer_.done, UnorderedElementsAre(3, 7));
  EXPECT_EQ(counts().done, 2);
}

TEST_F(CampaignRunnerTest, ADrainBeforeTheRunLeavesEverything) {
  CampaignRunner drained(campaign(), *prepared_, used_, setup_, observer_);
  drained.drain();
  const Result<RunSummary> summary = drained.run_to_end(all_frames());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->left, kFrames);
  EXPECT_TRUE(drained.is_drained());
  EXPECT_EQ(counts().done, 0);
}

TEST_F(CampaignRunnerTest, SignalsDrainWhileSomebodyListens) {
  CampaignRunner interrupted(campaign(), *prepared_, used_, setup_, observer_);
  {
    const DrainOnSignals drain(interrupted);
    std::raise(SIGTERM);
  }
  EXPECT_TRUE(interrupted.is_drained());
  struct sigaction now = {};
  sigaction(SIGTERM, nullptr, &now);
  EXPECT_EQ(now.sa_handler, SIG_DFL) << "as it was before";
}

TEST_F(CampaignRunnerTest, AFileInTheWayOfTheFramesEndsTheRun) {
  std::filesystem::remove_all(campaign().files.frames());
  ASSERT_TRUE(write_file(campaign().files.frames(), "not a folder"));
  CampaignRunner hindered(campaign(), *prepared_, used_, setup_, observer_);
  EXPECT_FALSE(hindered.run_to_end(all_frames()));
  EXPECT_THAT(observer_.done, IsEmpty());
}

TEST_F(CampaignRunnerTest, RoomIsForecastFromTheConfigAndThenFromTheFrames) {
  const auto before = forecast_room(campaign(), prepared_->settings, kFrames, setup_);
  ASSERT_TRUE(before);
  EXPECT_EQ(before->needed, setup_.frame_bytes * kFrames);
  EXPECT_GT(before->free, 0u);
  CampaignRunner one(campaign(), *prepared_, used_, setup_, observer_);
  ASSERT_TRUE(one.run_to_end({{0}}));
  const std::uint64_t typical = setup_.frame_bytes;
  ASSERT_TRUE(forecast_room(campaign(), prepared_->settings, kFrames, setup_));
  EXPECT_NE(setup_.frame_bytes, typical);
}

TEST_F(CampaignRunnerTest, FramesThatDoNotFitAreRefusedUnlessItDoesNotMatter) {
  const RoomForecast tight{1000, 999};
  const Status refused = check_room(campaign().files, tight, kFrames, setup_.options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(refused.error().message,
              HasSubstr("12 frames take about 1.0 kB, and 999 B are free"));
  EXPECT_TRUE(check_room(campaign().files, {1000, 1000}, kFrames, setup_.options));
  setup_.options.no_space_check = true;
  EXPECT_TRUE(check_room(campaign().files, tight, kFrames, setup_.options));
}

}  // namespace
}  // namespace seedframe
