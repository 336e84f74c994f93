// Everything a worker can do wrong, and what the pool makes of it.
#include <gmock/gmock.h>

#include "tests/render/pool_fixture.h"

namespace seedframe {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using namespace std::chrono_literals;

TEST_F(PoolTest, ACrashCostsOneAttemptAndIsExplained) {
  executor.act(Act::kCrash, {1});
  const auto summary = run(4);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 4);
  EXPECT_EQ(summary->worker_starts, 2);
  EXPECT_THAT(client.events, Contains("crashed 1.1"));
  EXPECT_THAT(client.events, Contains("rendered 1.2"));
  ASSERT_THAT(client.messages, SizeIs(1));
  EXPECT_THAT(client.last_log, HasSubstr("frame 1 is too much"));
  EXPECT_THAT(client.messages[0], HasSubstr("worker 0: it was killed by signal 11"));
  EXPECT_THAT(client.messages[0], HasSubstr("frame 1 is too much")) << "the log's last words";
}

TEST_F(PoolTest, AFrameThatAlwaysCrashesIsQuarantinedAndItsNeighboursAreNotCharged) {
  options.workers = 2;
  executor.act(Act::kCrash, {2}, kAlways);
  const auto summary = run(6);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 5);
  EXPECT_EQ(summary->failed, 0);
  EXPECT_EQ(summary->quarantined, 1);
  EXPECT_THAT(client.events, Contains("crashed 2.1"));
  EXPECT_THAT(client.events, Contains("crashed 2.2"));
  EXPECT_THAT(client.events, Contains("crashed 2.3 into quarantine"));
  EXPECT_THAT(client.messages, SizeIs(3));
  EXPECT_EQ(executor.living(), 0u);
}

TEST_F(PoolTest, ASuspectIsTriedAgainByAFreshWorker) {
  executor.act(Act::kCrash, {1});
  int frames_since_ready = 0;
  int ready = 0;
  client.on_started = [&](const FrameJob& job) {
    if (client.workers_ready != std::exchange(ready, client.workers_ready)) frames_since_ready = 0;
    if (job == FrameJob{1, 2}) {
      EXPECT_EQ(frames_since_ready, 0);
    }
    ++frames_since_ready;
  };
  const auto summary = run(6);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 6);
}

TEST_F(PoolTest, TheLastAttemptOfASuspectIsMadeWhileNobodyElseWorks) {
  options.workers = 3;
  int busy = 0;
  client.on_started = [&](const FrameJob& job) {
    ++busy;
    if (job.frame == 0 && job.attempt == 3) {
      EXPECT_EQ(busy, 1);
      EXPECT_EQ(client.events.size(), 2u + 2u + 2u * 20u + 1u) << "all others are done";
    }
  };
  client.on_rendered = [&](const FrameJob& job) {
    --busy;
    pool->post_verdict(job, {});
  };
  client.on_failed = [&] { --busy; };
  executor.act(Act::kCrash, {0}, 2);
  const auto summary = run(21);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 21);
  EXPECT_THAT(client.events, Contains("rendered 0.3"));
}

TEST_F(PoolTest, CrashesOfEarlierRunsCount) {
  executor.act(Act::kCrash, {4}, kAlways);
  const auto summary = run({{.frame = 4, .attempts_used = 2, .crashes = 2}});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->quarantined, 1);
  EXPECT_THAT(client.events, ElementsAre("started 4.3", "crashed 4.3 into quarantine"));
}

TEST_F(PoolTest, AFailureOfTheSystemIsNoFramesFault) {
  client.system = fail(ErrorKind::kExhausted, "the disk is full");
  executor.act(Act::kCrash, {0});
  executor.act(Act::kFail, {1});
  const auto summary = run(4);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kExhausted);
  EXPECT_THAT(client.messages, IsEmpty());
  EXPECT_EQ(executor.living(), 0u);
}

TEST_F(PoolTest, AWorkerThatWasKilledForLackOfMemoryIsNoFramesFault) {
  executor.act(Act::kOutOfMemory, {1});
  const auto summary = run(4);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kExhausted);
  EXPECT_THAT(summary.error().message, HasSubstr("out of memory and killed worker 0, which "
                                                 "rendered frame 1"));
  EXPECT_THAT(client.messages, IsEmpty());
}

TEST_F(PoolTest, AWorkerThatSomebodyElseKilledIsACrash) {
  executor.act(Act::kKilledByOthers, {1});
  const auto summary = run(4);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 4);
  EXPECT_THAT(client.events, Contains("crashed 1.1"));
}

TEST_F(PoolTest, AFrozenWorkerGivesNoSignOfLife) {
  options.heartbeat_timeout = 2s;
  executor.act(Act::kFreeze, {1});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  ASSERT_THAT(client.messages, SizeIs(1));
  EXPECT_THAT(client.messages[0], HasSubstr("no sign of life for 2 s"));
  EXPECT_LT(executor.elapsed(), 4s);
}

TEST_F(PoolTest, ASlowFrameThatGivesSignsOfLifeIsWaitedFor) {
  options.heartbeat_timeout = 1s;
  executor.render_time = 9min;
  const auto summary = run(1);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 1);
  EXPECT_THAT(client.messages, IsEmpty());
}

TEST_F(PoolTest, AWorkerThatIgnoresItsEndHoldsUpNobody) {
  options.workers = 2;
  options.frame_timeout = 2s;
  executor.act(Act::kIgnoreTerm, {0});
  const auto summary = run(2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  EXPECT_THAT(client.events, ElementsAre("started 0.1", "started 1.1", "rendered 1.1",
                                         "crashed 0.1", "started 0.2", "rendered 0.2"));
}

TEST_F(PoolTest, AWorkerThatLeavesWithoutAnAnswerCostsOneAttempt) {
  executor.act(Act::kExit, {0});
  const auto summary = run(2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  ASSERT_THAT(client.messages, SizeIs(1));
  EXPECT_THAT(client.messages[0], HasSubstr("exited with status 0"));
}

TEST_F(PoolTest, AHangingWorkerIsEndedInTime) {
  options.frame_timeout = 10min;
  executor.act(Act::kHang, {1});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  ASSERT_THAT(client.messages, SizeIs(1));
  EXPECT_THAT(client.messages[0], HasSubstr("no answer within 600 s"));
  EXPECT_GE(executor.elapsed(), 10min);
  EXPECT_LT(executor.elapsed(), 11min);
}

TEST_F(PoolTest, HowLongAFrameMayTakeIsLearntFromTheOthers) {
  executor.render_time = 5s;
  executor.act(Act::kHang, {9});
  const auto summary = run(10);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 10);
  ASSERT_THAT(client.messages, SizeIs(1));
  EXPECT_THAT(client.messages[0], HasSubstr("no answer within 50 s")) << "ten times as long";
}

TEST_F(PoolTest, NonsenseInTheChannelIsTheEndOfTheWorker) {
  executor.act(Act::kGarbage, {0});
  const auto summary = run(2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->worker_starts, 2);
  ASSERT_THAT(client.messages, SizeIs(1));
  EXPECT_THAT(client.messages[0], HasSubstr("Fra:1 Mem"));
}

TEST_F(PoolTest, AWorkerThatIsReadyTwiceIsNotBelieved) {
  executor.act(Act::kReadyAgain, {0});
  const auto summary = run(2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  ASSERT_THAT(client.messages, SizeIs(1));
  EXPECT_THAT(client.messages[0], HasSubstr("\"ready\" twice"));
}

TEST_F(PoolTest, AnAnswerAboutAnotherFrameOrAttemptIsNotBelieved) {
  executor.act(Act::kWrongFrame, {0});
  executor.act(Act::kWrongAttempt, {1});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  EXPECT_THAT(client.messages, SizeIs(2));
  EXPECT_THAT(client.messages, Each(HasSubstr("not what it was asked for")));
}

TEST_F(PoolTest, AnOrderlyFailureKeepsTheWorker) {
  executor.act(Act::kFail, {1}, kAlways);
  const auto summary = run(4);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  EXPECT_EQ(summary->failed, 1);
  EXPECT_EQ(summary->worker_starts, 1);
  EXPECT_THAT(client.messages, Each(std::string("fake: will not render")));
}

TEST_F(PoolTest, WorkersThatNeverGetReadyEndTheRun) {
  executor.failing_starts = kAlways;
  const auto summary = run(10);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(summary.error().message, HasSubstr("3 workers in a row"));
  EXPECT_THAT(summary.error().message, HasSubstr("cannot open the display"));
  EXPECT_THAT(client.events, IsEmpty()) << "no frame is blamed";
  EXPECT_EQ(executor.starts(), 3);
}

TEST_F(PoolTest, SomeFailedStartsAreSurvived) {
  executor.failing_starts = 2;
  const auto summary = run(2);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->worker_starts, 3);
}

TEST_F(PoolTest, AHangingStartCountsAsAFailedOne) {
  executor.hangs_at_start = true;
  const auto summary = run(1);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("not ready within 120 s"));
  EXPECT_GE(executor.elapsed(), 3 * 120s);
  EXPECT_EQ(executor.living(), 0u);
}

TEST_F(PoolTest, AnotherProtocolIsRefusedAtOnce) {
  executor.protocol = 99;
  const auto summary = run(1);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("protocol 99"));
  EXPECT_EQ(executor.starts(), 1);
}

TEST_F(PoolTest, ManyFaultsAtOnce) {
  options.workers = 3;
  executor.act(Act::kCrash, {0, 7});
  executor.act(Act::kHang, {3});
  executor.act(Act::kGarbage, {4, 11});
  executor.act(Act::kBadFile, {5, 9});
  executor.act(Act::kFail, {10});
  executor.act(Act::kWrongFrame, {12});
  const auto summary = run(20);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, 20);
  EXPECT_THAT(client.messages, SizeIs(9));
  EXPECT_EQ(executor.living(), 0u);
}

}  // namespace
}  // namespace seedframe
