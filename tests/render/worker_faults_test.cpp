// Everything a worker can do wrong, and what the pool makes of it.
#include <gmock/gmock.h>

#include "pool_fixture.h"

namespace seedframe {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST_F(PoolTest, ACrashCostsOneAttemptAndIsExplained) {
  make_pool({{"crash_frames", {1}}});
  const auto summary = run(4);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 4);
  EXPECT_EQ(summary->worker_starts, 2);
  EXPECT_THAT(client->events, Contains("failed 1.1"));
  EXPECT_THAT(client->events, Contains("rendered 1.2"));
  ASSERT_THAT(client->messages, SizeIs(1));
  EXPECT_THAT(client->messages[0], HasSubstr("signal 11 (Segmentation fault)"));
  EXPECT_THAT(client->messages[0], HasSubstr("frame 1 is too much")) << "the log's last words";
}

TEST_F(PoolTest, AFrameThatAlwaysCrashesFailsForGoodAndAlone) {
  options.workers = 2;
  make_pool({{"crash_frames", {2}}, {"crash_attempts", 99}});
  const auto summary = run(6);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 5);
  EXPECT_EQ(summary->failed, 1);
  EXPECT_THAT(client->events, Contains("failed 2.1"));
  EXPECT_THAT(client->events, Contains("failed 2.2"));
  EXPECT_THAT(client->events, Contains("failed 2.3 for good"));
  expect_no_worker_lives();
}

TEST_F(PoolTest, AWorkerThatLeavesWithoutAnAnswerCostsOneAttempt) {
  make_pool({{"exit_frames", {0}}});
  const auto summary = run(2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  ASSERT_THAT(client->messages, SizeIs(1));
  EXPECT_THAT(client->messages[0], HasSubstr("exited with status 0"));
}

TEST_F(PoolTest, AHangingWorkerIsKilledInTime) {
  options.frame_timeout = std::chrono::seconds(2);
  make_pool({{"hang_frames", {1}}});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  ASSERT_THAT(client->messages, SizeIs(1));
  EXPECT_THAT(client->messages[0], HasSubstr("no answer within 2 s"));
  expect_no_worker_lives();
}

TEST_F(PoolTest, NonsenseInTheChannelIsTheEndOfTheWorker) {
  make_pool({{"garbage_frames", {0}}});
  const auto summary = run(2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->worker_starts, 2);
  ASSERT_THAT(client->messages, SizeIs(1));
  EXPECT_THAT(client->messages[0], HasSubstr("Fra:1 Mem"));
}

TEST_F(PoolTest, AnAnswerAboutAnotherFrameOrAttemptIsNotBelieved) {
  make_pool({{"wrong_frame_frames", {0}}, {"wrong_attempt_frames", {1}}});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  EXPECT_THAT(client->messages, SizeIs(2));
  EXPECT_THAT(client->messages, Each(HasSubstr("not what it was asked for")));
}

TEST_F(PoolTest, AnOrderlyFailureKeepsTheWorker) {
  make_pool({{"fail_frames", {1}}, {"fail_attempts", 99}});
  const auto summary = run(4);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  EXPECT_EQ(summary->failed, 1);
  EXPECT_EQ(summary->worker_starts, 1);
  EXPECT_THAT(client->messages, Each(std::string("fake: will not render")));
}

TEST_F(PoolTest, WorkersThatNeverGetReadyEndTheRun) {
  make_pool({{"die_before_ready", true}});
  const auto summary = run(10);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(summary.error().message, HasSubstr("3 workers in a row"));
  EXPECT_THAT(summary.error().message, HasSubstr("cannot open the display"));
  EXPECT_THAT(client->events, IsEmpty()) << "no frame is blamed";
  EXPECT_EQ(workers_started().size(), 3u);
}

TEST_F(PoolTest, SomeFailedStartsAreSurvived) {
  make_pool({{"die_before_ready", 2}});
  const auto summary = run(2);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->worker_starts, 3);
}

TEST_F(PoolTest, AHangingStartCountsAsAFailedOne) {
  options.start_timeout = std::chrono::milliseconds(300);
  make_pool({{"hang_before_ready", true}});
  const auto summary = run(1);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("no answer within 0.3 s"));
  expect_no_worker_lives();
}

TEST_F(PoolTest, AProgramThatCannotBeStartedIsNamed) {
  options.blender = folder / "no-blender";
  make_pool();
  const auto summary = run(1);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("cannot start"));
  EXPECT_THAT(summary.error().message, HasSubstr("No such file"));
}

TEST_F(PoolTest, AnotherProtocolIsRefusedAtOnce) {
  make_pool({{"protocol", 2}});
  const auto summary = run(1);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("protocol 2"));
  EXPECT_EQ(workers_started().size(), 1u);
}

TEST_F(PoolTest, AChattyWorkerDoesNotFillTheDisk) {
  make_pool({{"chatty_log_bytes", 3'000'000}});
  const auto summary = run(6);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 6);
  EXPECT_LT(std::filesystem::file_size(folder / "worker-0.log"), 9'000'000u);
}

TEST_F(PoolTest, ManyFaultsAtOnce) {
  options.workers = 3;
  options.frame_timeout = std::chrono::seconds(3);
  make_pool({{"crash_frames", {0, 7}},
             {"hang_frames", {3}},
             {"garbage_frames", {4, 11}},
             {"no_file_frames", {5}},
             {"half_exr_frames", {9}},
             {"fail_frames", {10}},
             {"wrong_frame_frames", {12}}});
  const auto summary = run(20);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, 20);
  EXPECT_THAT(client->messages, SizeIs(9));
  expect_no_worker_lives();
}

}  // namespace
}  // namespace seedframe
