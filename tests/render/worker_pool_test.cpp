// The pool at work: order of calls, verdicts, draining, and what it leaves behind.
#include "render/worker_pool.h"

#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "render/sandbox.h"
#include "tests/render/pool_fixture.h"

namespace seedframe {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST_F(PoolTest, RendersEveryFrameWithOneStartPerWorker) {
  options.workers = 2;
  make_pool();
  const auto summary = run(20);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, 20);
  EXPECT_EQ(summary->failed, 0);
  EXPECT_EQ(summary->left, 0);
  EXPECT_LE(summary->worker_starts, 2);
  // The second may have been sent home before it came to life.
  EXPECT_GE(workers_started().size(), 1U);
  EXPECT_LE(workers_started().size(), static_cast<std::size_t>(summary->worker_starts));
  for (int frame = 0; frame < 20; ++frame) EXPECT_TRUE(client->judge({frame, 1}));
  expect_no_worker_lives();
}

TEST_F(PoolTest, TellsOneJobsStoryInOrder) {
  make_pool();
  ASSERT_TRUE(run(1));
  EXPECT_THAT(client->events, ElementsAre("started 0.1", "rendered 0.1"));
  EXPECT_EQ(client->workers_ready, 1);
}

TEST_F(PoolTest, StartsNoMoreWorkersThanFrames) {
  options.workers = 8;
  make_pool();
  ASSERT_TRUE(run(2));
  EXPECT_LE(workers_started().size(), 2u);
}

TEST_F(PoolTest, NothingToDoStartsNothing) {
  make_pool();
  const auto summary = run(0);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->worker_starts, 0);
}

TEST_F(PoolTest, AttemptNumbersGoOnFromEarlierRuns) {
  make_pool();
  const auto summary =
      pool->run({{.frame = 5, .attempts_used = 2}, {.frame = 6, .attempts_used = 3}});
  ASSERT_TRUE(summary);
  EXPECT_THAT(client->events,
              ElementsAre("started 5.3", "rendered 5.3", "started 6.4", "rendered 6.4"));
  EXPECT_EQ(summary->failed, 0);
}

TEST_F(PoolTest, VerdictsMayComeLateAndFromOtherThreads) {
  std::vector<std::thread> finishers;
  client->on_rendered = [&](const FrameJob& job) {
    finishers.emplace_back([this, job] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      pool->post_verdict(job, client->judge(job));
    });
  };
  make_pool();
  const auto summary = run(5);
  for (std::thread& finisher : finishers) finisher.join();
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 5);
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
  client->on_rendered = [&](const FrameJob& job) {
    unjudged.push_back(job);
    EXPECT_LE(unjudged.size(), 4u) << "2, the one under way and the one asked for ahead";
    if (unjudged.size() < 2) return;
    for (const FrameJob& each : unjudged) pool->post_verdict(each, {});
    unjudged.clear();
  };
  make_pool();
  const auto summary = run(8);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 8);
}

TEST_F(PoolTest, AWorkerThatWroteABadFileIsReplaced) {
  make_pool({{"no_file_frames", {0}}, {"half_exr_frames", {1}}});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  EXPECT_THAT(client->events, Contains("failed 0.1"));
  EXPECT_THAT(client->events, Contains("failed 1.1"));
  EXPECT_THAT(client->events, Contains("rendered 0.2"));
  EXPECT_THAT(client->messages, Contains("no file"));
  EXPECT_THAT(client->messages, Contains("half a file"));
  EXPECT_GE(summary->worker_starts, 3) << "the one that lied has been replaced, twice";
}

TEST_F(PoolTest, AFullDiskEndsTheRunAndCostsNoAttempt) {
  client->on_rendered = [&](const FrameJob& job) {
    pool->post_verdict(job, fail(ErrorKind::kEnvironment, "no space left on the disk"));
  };
  make_pool();
  const auto summary = run(5);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(summary.error().message, HasSubstr("no space left"));
  EXPECT_THAT(client->messages, testing::IsEmpty());
  expect_no_worker_lives();
}

TEST_F(PoolTest, AFrameThatCannotBeAskedForFailsAlone) {
  client->on_request = [](const FrameJob& job) -> Status {
    if (job.frame == 1) return fail(ErrorKind::kInput, "frame 1 cannot be expanded");
    return {};
  };
  make_pool();
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->failed, 1);
  EXPECT_THAT(client->events, Contains("failed 1.1 for good"));
  EXPECT_THAT(client->messages, ElementsAre("frame 1 cannot be expanded"));
}

TEST_F(PoolTest, AnEnvironmentErrorOfTheClientEndsTheRun) {
  client->on_request = [](const FrameJob&) -> Status {
    return fail(ErrorKind::kEnvironment, "the store is gone");
  };
  make_pool();
  const auto summary = run(3);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("the store is gone"));
}

TEST_F(PoolTest, DrainingFinishesWhatIsUnderWay) {
  client->on_started = [&](const FrameJob& job) {
    if (job.frame == 1) pool->drain();
  };
  make_pool({{"delay_s", 0.1}});
  const auto summary = run(50);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->left, 48);
  EXPECT_THAT(client->events, Contains("rendered 1.1"));
  expect_no_worker_lives();
}

TEST_F(PoolTest, DrainingBeforeTheStartDoesNothing) {
  make_pool();
  pool->drain();
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->left, 3);
  EXPECT_EQ(summary->worker_starts, 0);
}

TEST_F(PoolTest, TheSecondDrainKills) {
  client->on_started = [&](const FrameJob&) {
    pool->drain();
    pool->drain();
  };
  make_pool({{"hang_frames", "all"}});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 0);
  EXPECT_EQ(summary->left, 3);
  EXPECT_THAT(client->messages, testing::IsEmpty()) << "nobody's fault, no attempt lost";
  expect_no_worker_lives();
}

TEST_F(PoolTest, AWornWorkerIsReplaced) {
  options.frames_per_worker = 2;
  make_pool();
  const auto summary = run(5);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->worker_starts, 3);
}

TEST_F(PoolTest, TheWorkersEnvironmentIsSanitised) {
  setenv("PYTHONPATH", "/somewhere/else", 1);
  setenv("OCIO", "/somewhere/config.ocio", 1);
  setenv("SEEDFRAME_OTHER", "kept", 1);
  const auto script = folder / "env_blender";
  std::ofstream(script) << "#!/bin/sh\nenv\nexit 1\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  options.worker.blender = script;
  options.worker.environment["CYCLES_CPU_NO_AVX2"] = "1";
  make_pool();
  const auto summary = run(1);
  unsetenv("PYTHONPATH");
  unsetenv("OCIO");
  ASSERT_FALSE(summary);
  std::ifstream log(folder / "worker-0.log");
  const std::string text(std::istreambuf_iterator<char>(log), {});
  EXPECT_THAT(text, HasSubstr("CYCLES_CPU_NO_AVX2=1"));
  EXPECT_THAT(text, HasSubstr("SEEDFRAME_OTHER=kept"));
  EXPECT_THAT(text, HasSubstr("PATH=/usr/bin:/bin\n"))
      << "a virtual environment would mislead Blender";
  EXPECT_THAT(text, Not(HasSubstr("PYTHONPATH")));
  EXPECT_THAT(text, Not(HasSubstr("OCIO=")));
}

TEST_F(PoolTest, WorkersInheritNoOtherFile) {
  const int secret = dup2(open("/dev/null", 0), 77);
  ASSERT_EQ(secret, 77);
  const auto script = folder / "ls_blender";
  std::ofstream(script) << "#!/bin/sh\nls -l /proc/$$/fd\nexit 1\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  options.worker.blender = script;
  make_pool();
  EXPECT_FALSE(run(1));
  close(secret);
  std::ifstream log(folder / "worker-0.log");
  const std::string text(std::istreambuf_iterator<char>(log), {});
  EXPECT_THAT(text, HasSubstr(" 3 -> socket"));
  EXPECT_THAT(text, Not(HasSubstr(" 77 -> ")));
}

TEST_F(PoolTest, ASandboxedWorkerWritesOnlyWhereItMayAndHasNoNetwork) {
  if (const Status works = check_sandbox(); !works) GTEST_SKIP() << works.error().message;
  const auto script = folder / "curious_blender";
  std::filesystem::create_directories(folder / "work");
  std::ofstream(script) << "#!/bin/sh\n"
                        << "touch " << (folder / "work/inside").string()
                        << " && echo wrote inside\n"
                        << "touch " << (folder / "outside").string() << " || echo not outside\n"
                        << "cat /proc/net/dev | grep -c : \n"
                        << "echo process $$\nexit 1\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  options.worker.blender = script;
  options.worker.wrapper = sandbox_arguments(folder / "work");
  make_pool();
  EXPECT_FALSE(run(1));
  std::ifstream log(folder / "worker-0.log");
  const std::string text(std::istreambuf_iterator<char>(log), {});
  EXPECT_THAT(text, HasSubstr("wrote inside"));
  EXPECT_THAT(text, HasSubstr("not outside"));
  EXPECT_THAT(text, HasSubstr("\n1\n")) << "the loopback device only";
  EXPECT_THAT(text, testing::ContainsRegex("process [0-9]\n")) << "processes of its own";
  EXPECT_TRUE(std::filesystem::exists(folder / "work/inside"));
  EXPECT_FALSE(std::filesystem::exists(folder / "outside"));
}

TEST_F(PoolTest, ASandboxedWorkerRendersAndDiesWithTheOthers) {
  if (const Status works = check_sandbox(); !works) GTEST_SKIP() << works.error().message;
  options.worker.wrapper = sandbox_arguments(folder);
  options.heartbeat_timeout = std::chrono::seconds(2);
  make_pool({{"crash_frames", {1}}, {"freeze_frames", {2}}});
  const auto summary = run(4);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, 4);
}

TEST_F(PoolTest, WorkersDieWithASchedulerThatIsKilled) {
  options.workers = 2;
  make_pool({{"hang_frames", "all"}});
  const pid_t scheduler = fork();
  if (scheduler == 0) {
    (void)run(4);
    _exit(0);
  }
  for (int i = 0; i < 600 && workers_started().size() < 2; ++i) usleep(10'000);
  ASSERT_EQ(workers_started().size(), 2u);
  kill(scheduler, SIGKILL);
  waitpid(scheduler, nullptr, 0);
  for (const pid_t pid : workers_started()) {
    for (int i = 0; i < 200 && is_alive(pid); ++i) usleep(10'000);
    EXPECT_FALSE(is_alive(pid));
  }
}

}  // namespace
}  // namespace seedframe
