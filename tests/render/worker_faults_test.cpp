// Everything a worker can do wrong, and what the pool makes of it.
#include <gmock/gmock.h>

#include "tests/render/pool_fixture.h"

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
  EXPECT_THAT(client->events, Contains("crashed 1.1"));
  EXPECT_THAT(client->events, Contains("rendered 1.2"));
  ASSERT_THAT(client->messages, SizeIs(1));
  EXPECT_THAT(client->last_log, HasSubstr("frame 1 is too much"));
  EXPECT_THAT(client->messages[0], HasSubstr("signal 11 (Segmentation fault)"));
  EXPECT_THAT(client->messages[0], HasSubstr("frame 1 is too much")) << "the log's last words";
}

TEST_F(PoolTest, AFrameThatAlwaysCrashesIsQuarantinedAndItsNeighboursAreNotCharged) {
  options.workers = 2;
  make_pool({{"crash_frames", {2}}, {"crash_attempts", 99}});
  const auto summary = run(6);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 5);
  EXPECT_EQ(summary->failed, 0);
  EXPECT_EQ(summary->quarantined, 1);
  EXPECT_THAT(client->events, Contains("crashed 2.1"));
  EXPECT_THAT(client->events, Contains("crashed 2.2"));
  EXPECT_THAT(client->events, Contains("crashed 2.3 into quarantine"));
  EXPECT_THAT(client->messages, SizeIs(3));
  expect_no_worker_lives();
}

TEST_F(PoolTest, TheLastAttemptOfASuspectIsMadeWhileNobodyElseWorks) {
  options.workers = 3;
  int busy = 0;
  client->on_started = [&](const FrameJob& job) {
    ++busy;
    if (job.frame == 0 && job.attempt == 3) {
      EXPECT_EQ(busy, 1);
      EXPECT_EQ(client->events.size(), 2u + 2u + 2u * 20u + 1u) << "all others are done";
    }
  };
  client->on_rendered = [&](const FrameJob& job) {
    --busy;
    pool->post_verdict(job, client->judge(job));
  };
  client->on_failed = [&] { --busy; };
  make_pool({{"crash_frames", {0}}, {"crash_attempts", 2}});
  const auto summary = run(21);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 21);
  EXPECT_THAT(client->events, Contains("rendered 0.3"));
}

TEST_F(PoolTest, CrashesOfEarlierRunsCount) {
  make_pool({{"crash_frames", "all"}, {"crash_attempts", 99}});
  const auto summary = pool->run({{.frame = 4, .attempts_used = 2, .crashes = 2}});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->quarantined, 1);
  EXPECT_THAT(client->events, testing::ElementsAre("started 4.3", "crashed 4.3 into quarantine"));
}

TEST_F(PoolTest, AFailureOfTheSystemIsNoFramesFault) {
  client->system = fail(ErrorKind::kExhausted, "the disk is full");
  make_pool({{"crash_frames", {0}}, {"fail_frames", {1}}});
  const auto summary = run(4);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kExhausted);
  EXPECT_THAT(client->messages, IsEmpty());
  expect_no_worker_lives();
}

TEST_F(PoolTest, AWorkerThatTheKernelKilledForLackOfMemoryIsNoFramesFault) {
  int asked = 0;
  options.out_of_memory_kills = [&] { return asked++ == 0 ? 5 : 6; };
  make_pool({{"out_of_memory_frames", {1}}});
  const auto summary = run(4);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kExhausted);
  EXPECT_THAT(summary.error().message, HasSubstr("out of memory and killed worker 0, which "
                                                 "rendered frame 1"));
  EXPECT_THAT(client->messages, IsEmpty());
}

TEST_F(PoolTest, AWorkerThatSomebodyElseKilledIsACrash) {
  make_pool({{"out_of_memory_frames", {1}}});
  const auto summary = run(4);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 4);
  EXPECT_THAT(client->events, Contains("crashed 1.1"));
}

TEST_F(PoolTest, AFrozenWorkerGivesNoSignOfLife) {
  options.heartbeat_timeout = std::chrono::seconds(2);
  make_pool({{"freeze_frames", {1}}});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  ASSERT_THAT(client->messages, SizeIs(1));
  EXPECT_THAT(client->messages[0], HasSubstr("no sign of life for 2 s"));
  expect_no_worker_lives();
}

TEST_F(PoolTest, ASlowFrameThatGivesSignsOfLifeIsWaitedFor) {
  options.heartbeat_timeout = std::chrono::milliseconds(1200);
  make_pool({{"delay_s", 2.5}});
  const auto summary = run(1);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 1);
  EXPECT_THAT(client->messages, IsEmpty());
}

TEST_F(PoolTest, AWorkerThatIgnoresSigtermIsKilled) {
  options.frame_timeout = std::chrono::seconds(2);
  make_pool({{"ignore_term_frames", {0}}});
  const auto summary = run(2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  expect_no_worker_lives();
}

TEST_F(PoolTest, AWorkerThatHasGrownTooLargeIsReplacedAfterItsFrame) {
  options.worker_memory_bytes = 40'000'000;  // the fake says 50 MB
  make_pool({{"delay_s", 0.1}});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  EXPECT_EQ(summary->worker_starts, 3);
  EXPECT_THAT(client->messages, IsEmpty()) << "no frame is lost by it";
}

TEST_F(PoolTest, AWorkerGetsNoMoreMemoryThanItsLimit) {
  options.worker.limits.memory_bytes = 1 << 20;
  make_pool();
  const auto summary = run(1);
  ASSERT_FALSE(summary) << "not even Python starts in a megabyte";
  EXPECT_THAT(summary.error().message, HasSubstr("did not get ready"));
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
  EXPECT_THAT(summary.error().message, HasSubstr("not ready within 0.3 s"));
  expect_no_worker_lives();
}

TEST_F(PoolTest, AProgramThatCannotBeStartedIsNamed) {
  options.worker.blender = folder / "no-blender";
  make_pool();
  const auto summary = run(1);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("cannot start"));
  EXPECT_THAT(summary.error().message, HasSubstr("No such file"));
}

TEST_F(PoolTest, AnotherProtocolIsRefusedAtOnce) {
  make_pool({{"protocol", 99}});
  const auto summary = run(1);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("protocol 99"));
  EXPECT_EQ(workers_started().size(), 1u);
}

TEST_F(PoolTest, AChattyWorkerDoesNotFillTheDisk) {
  make_pool({{"chatty_log_bytes", 3'000'000}});
  const auto summary = run(6);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 6);
  EXPECT_LE(std::filesystem::file_size(folder / "worker-0.log"), 4u << 20);
  EXPECT_LE(std::filesystem::file_size(folder / "worker-0.log.1"), 4u << 20);
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
