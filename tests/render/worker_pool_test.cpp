// The pool at work: order of calls, verdicts, draining, and what it leaves behind.
#include "render/worker_pool.h"

#include <set>
#include <vector>

#include <gmock/gmock.h>

#include "tests/render/pool_fixture.h"

namespace seedframe {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using namespace std::chrono_literals;

TEST_F(PoolTest, RendersEveryFrameWithOneStartPerWorker) {
  options.workers = 2;
  const auto summary = run(20);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, 20);
  EXPECT_EQ(summary->failed, 0);
  EXPECT_EQ(summary->left, 0);
  EXPECT_EQ(summary->worker_starts, 2);
  EXPECT_EQ(executor.living(), 0u);
}

TEST_F(PoolTest, WorkersRenderSideBySide) {
  options.workers = 4;
  executor.render_time = 1000ms;
  ASSERT_TRUE(run(8));
  EXPECT_GE(executor.elapsed(), 2s);
  EXPECT_LE(executor.elapsed(), 3s);
}

TEST_F(PoolTest, TheNextFrameIsAskedForWhileAWorkerIsBusy) {
  std::vector<std::int64_t> asked;
  client.on_request = [&](const FrameJob& job) -> Status {
    asked.push_back(job.frame);
    return {};
  };
  client.on_started = [&](const FrameJob& job) {
    if (job.frame == 1) {
      EXPECT_THAT(asked, ElementsAre(0, 1));
    }
  };
  ASSERT_TRUE(run(2));
  EXPECT_EQ(asked.size(), 2u) << "and none twice";
}

TEST_F(PoolTest, TellsOneJobsStoryInOrder) {
  ASSERT_TRUE(run(1));
  EXPECT_THAT(client.events, ElementsAre("started 0.1", "rendered 0.1"));
  EXPECT_EQ(client.workers_ready, 1);
}

TEST_F(PoolTest, StartsNoMoreWorkersThanFrames) {
  options.workers = 8;
  ASSERT_TRUE(run(2));
  EXPECT_EQ(executor.starts(), 2);
}

TEST_F(PoolTest, FramesAreHandedOutAsSoonAsAnyWorkerIsReady) {
  options.workers = 3;
  executor.start_time_more = 10s;
  std::set<int> workers;
  client.on_started = [&](const FrameJob&) { workers.insert(client.last_worker); };
  ASSERT_TRUE(run(4));
  EXPECT_THAT(workers, ElementsAre(0));
}

TEST_F(PoolTest, WorkersThatBeginTogetherGetOneOfTheFirstFramesEach) {
  options.workers = 3;
  options.begin_together = true;
  executor.start_time_more = 10s;
  executor.failing_starts = 1;
  std::vector<int> workers;
  client.on_started = [&](const FrameJob&) { workers.push_back(client.last_worker); };
  ASSERT_TRUE(run(4));
  ASSERT_EQ(workers.size(), 4u);
  workers.pop_back();
  EXPECT_THAT(workers, ElementsAre(0, 1, 2));
}

TEST_F(PoolTest, OnceBegunNobodyWaitsForAWorkerThatIsReplaced) {
  options.workers = 2;
  options.begin_together = true;
  executor.start_time = 10s;
  executor.act(Act::kCrash, {0});
  FakeExecutor::Milliseconds last_started{0};
  client.on_started = [&](const FrameJob& job) {
    if (job.frame == 39) last_started = executor.elapsed();
  };
  ASSERT_TRUE(run(40));
  EXPECT_GT(last_started, 10s);
  EXPECT_LT(last_started, 20s) << "the other one is ready again after 20 s";
}

TEST_F(PoolTest, WorkersThatWouldBeginTogetherCanBeDrainedBefore) {
  options.workers = 2;
  options.begin_together = true;
  executor.start_time_more = 10s;
  executor.after(1s, [this] { pool->drain(); });
  const auto summary = run(4);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->left, 4);
}

TEST_F(PoolTest, NothingToDoStartsNothing) {
  const auto summary = run(0);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->worker_starts, 0);
}

TEST_F(PoolTest, AttemptNumbersGoOnFromEarlierRuns) {
  const auto summary = run({{.frame = 5, .attempts_used = 2}, {.frame = 6, .attempts_used = 3}});
  ASSERT_TRUE(summary);
  EXPECT_THAT(client.events,
              ElementsAre("started 5.3", "rendered 5.3", "started 6.4", "rendered 6.4"));
  EXPECT_EQ(summary->failed, 0);
}

TEST_F(PoolTest, LateVerdictsAreWaitedForAndHoldNobodyUp) {
  client.on_rendered = [&](const FrameJob& job) {
    executor.after(10s, [this, job] { pool->post_verdict(job, {}); });
  };
  const auto summary = run(5);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 5);
  EXPECT_LE(executor.elapsed(), 11s);
}

TEST_F(PoolTest, VerdictsAboutUnknownJobsAreIgnored) {
  make_pool();
  pool->post_verdict({77, 1}, {});
  pool->post_verdict({0, 1}, fail(ErrorKind::kRender, "not even started"));
  const auto summary = run(1);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 1);
}

TEST_F(PoolTest, WaitsWhenTooManyFramesAreUnjudged) {
  options.max_unjudged = 2;
  std::vector<FrameJob> unjudged;
  client.on_rendered = [&](const FrameJob& job) {
    unjudged.push_back(job);
    EXPECT_LE(unjudged.size(), 4u) << "2, the one under way and the one asked for ahead";
    if (unjudged.size() < 2) return;
    for (const FrameJob& each : unjudged) pool->post_verdict(each, {});
    unjudged.clear();
  };
  const auto summary = run(8);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 8);
}

TEST_F(PoolTest, AWorkerThatWroteABadFileIsReplaced) {
  executor.act(Act::kBadFile, {0, 1});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  EXPECT_THAT(client.events, Contains("failed 0.1"));
  EXPECT_THAT(client.events, Contains("failed 1.1"));
  EXPECT_THAT(client.events, Contains("rendered 0.2"));
  EXPECT_THAT(client.messages, ElementsAre("half a file", "half a file"));
  EXPECT_GE(summary->worker_starts, 2) << "the one that lied has been replaced";
}

TEST_F(PoolTest, AFrameThatAlwaysComesOutBadFails) {
  executor.act(Act::kBadFile, {1}, kAlways);
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->failed, 1);
  EXPECT_THAT(client.events, Contains("failed 1.3 for good"));
}

TEST_F(PoolTest, AFullDiskEndsTheRunAndCostsNoAttempt) {
  client.on_rendered = [&](const FrameJob& job) {
    pool->post_verdict(job, fail(ErrorKind::kEnvironment, "no space left on the disk"));
  };
  const auto summary = run(5);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(summary.error().message, HasSubstr("no space left"));
  EXPECT_THAT(client.messages, IsEmpty());
  EXPECT_EQ(executor.living(), 0u);
}

TEST_F(PoolTest, AFrameThatCannotBeAskedForFailsAlone) {
  client.on_request = [](const FrameJob& job) -> Status {
    if (job.frame == 1) return fail(ErrorKind::kInput, "frame 1 cannot be expanded");
    return {};
  };
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->failed, 1);
  EXPECT_THAT(client.events, Contains("failed 1.1 for good"));
  EXPECT_THAT(client.messages, ElementsAre("frame 1 cannot be expanded"));
}

TEST_F(PoolTest, AnEnvironmentErrorOfTheClientEndsTheRun) {
  client.on_request = [](const FrameJob&) -> Status {
    return fail(ErrorKind::kEnvironment, "the store is gone");
  };
  const auto summary = run(3);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("the store is gone"));
}

TEST_F(PoolTest, AnExecutorThatCannotStartEndsTheRun) {
  executor.no_start = Error{ErrorKind::kExhausted, "no process is left"};
  const auto summary = run(3);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kExhausted);
  EXPECT_THAT(client.events, IsEmpty());
}

TEST_F(PoolTest, AWorkerThatIsNotAsItWasToBeEndsTheRun) {
  executor.check_status = fail(ErrorKind::kEnvironment, "another kernel");
  const auto summary = run(3);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().message, "another kernel");
  EXPECT_EQ(client.workers_ready, 0);
  EXPECT_EQ(executor.starts(), 1);
  EXPECT_EQ(executor.living(), 0u);
}

TEST_F(PoolTest, DrainingFinishesWhatIsUnderWay) {
  client.on_started = [&](const FrameJob& job) {
    if (job.frame == 1) pool->drain();
  };
  const auto summary = run(50);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->left, 48);
  EXPECT_THAT(client.events, Contains("rendered 1.1"));
  EXPECT_EQ(executor.living(), 0u);
}

TEST_F(PoolTest, DrainingWaitsForVerdicts) {
  client.on_rendered = [&](const FrameJob& job) {
    pool->drain();
    executor.after(1min, [this, job] { pool->post_verdict(job, {}); });
  };
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 1);
  EXPECT_EQ(summary->left, 2);
}

TEST_F(PoolTest, DrainingBeforeTheStartDoesNothing) {
  make_pool().drain();
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->left, 3);
  EXPECT_EQ(summary->worker_starts, 0);
}

TEST_F(PoolTest, DrainingDoesNotWaitForWorkersThatAreNotReady) {
  options.workers = 2;
  executor.hangs_at_start = true;
  executor.after(1s, [this] { pool->drain(); });
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->left, 3);
  EXPECT_LT(executor.elapsed(), 2s);
}

TEST_F(PoolTest, TheSecondDrainKills) {
  client.on_started = [&](const FrameJob&) {
    pool->drain();
    pool->drain();
  };
  executor.act(Act::kHang, {0, 1, 2}, kAlways);
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 0);
  EXPECT_EQ(summary->left, 3);
  EXPECT_THAT(client.messages, IsEmpty()) << "nobody's fault, no attempt lost";
  EXPECT_EQ(executor.living(), 0u);
}

TEST_F(PoolTest, AWornWorkerIsReplaced) {
  options.frames_per_worker = 2;
  const auto summary = run(5);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->worker_starts, 3);
}

TEST_F(PoolTest, AWorkerThatHasGrownTooLargeIsReplacedAfterItsFrame) {
  options.worker_memory_bytes = executor.memory_bytes - 1;
  executor.render_time = 600ms;  // it says how large it is every half second
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  EXPECT_EQ(summary->worker_starts, 3);
  EXPECT_THAT(client.messages, IsEmpty()) << "no frame is lost by it";
}

}  // namespace
}  // namespace seedframe
