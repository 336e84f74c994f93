// Workers that are real processes: what only the system can show.
#include "render/local_executor.h"

#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "render/sandbox.h"
#include "tests/render/local_pool_fixture.h"

namespace seedframe {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

TEST_F(LocalPoolTest, RendersEveryFrameWithOneStartPerWorker) {
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

TEST_F(LocalPoolTest, VerdictsMayComeLateAndFromOtherThreads) {
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

TEST_F(LocalPoolTest, TheSecondDrainKills) {
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

TEST_F(LocalPoolTest, TheWorkersEnvironmentIsSanitised) {
  setenv("PYTHONPATH", "/somewhere/else", 1);
  setenv("OCIO", "/somewhere/config.ocio", 1);
  setenv("SEEDFRAME_OTHER", "kept", 1);
  const auto script = folder / "env_blender";
  std::ofstream(script) << "#!/bin/sh\nenv\nexit 1\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  worker.blender.path = script;
  worker.environment["CYCLES_CPU_NO_AVX2"] = "1";
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

TEST_F(LocalPoolTest, WorkersInheritNoOtherFile) {
  const int secret = dup2(open("/dev/null", 0), 77);
  ASSERT_EQ(secret, 77);
  const auto script = folder / "ls_blender";
  std::ofstream(script) << "#!/bin/sh\nls -l /proc/$$/fd\nexit 1\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  worker.blender.path = script;
  make_pool();
  EXPECT_FALSE(run(1));
  close(secret);
  std::ifstream log(folder / "worker-0.log");
  const std::string text(std::istreambuf_iterator<char>(log), {});
  EXPECT_THAT(text, HasSubstr(" 3 -> socket"));
  EXPECT_THAT(text, Not(HasSubstr(" 77 -> ")));
}

TEST_F(LocalPoolTest, ASandboxedWorkerWritesOnlyWhereItMayAndHasNoNetwork) {
  if (const Status works = check_sandbox(); !works) GTEST_SKIP() << works.error().message;
  const auto script = folder / "curious_blender";
  std::filesystem::create_directories(folder / "work");
  std::ofstream(script) << "#!/bin/sh\n"
                        << "touch " << (folder / "work/inside").string()
                        << " && echo wrote inside\n"
                        << "touch " << SEEDFRAME_HOME << "/outside || echo not outside\n"
                        << "cat /proc/net/dev | grep -c : \n"
                        << "find /run /var/tmp -mindepth 1 | grep -c . || echo empty\n"
                        << "grep CapEff /proc/self/status\n"
                        << "cat " << (folder / "secret").string() << " || echo no secret\n"
                        << "echo process $$\nexit 1\n";
  std::ofstream(folder / "secret") << "it is known\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  worker.blender.path = script;
  worker.wrapper = sandbox_arguments(folder / "work", {script, SEEDFRAME_HOME});
  make_pool();
  EXPECT_FALSE(run(1));
  std::ifstream log(folder / "worker-0.log");
  const std::string text(std::istreambuf_iterator<char>(log), {});
  EXPECT_THAT(text, HasSubstr("wrote inside"));
  EXPECT_THAT(text, HasSubstr("not outside"));
  EXPECT_THAT(text, HasSubstr("\n1\n")) << "the loopback device only";
  EXPECT_THAT(text, HasSubstr("empty\n")) << "no sockets of other programs";
  EXPECT_THAT(text, HasSubstr("CapEff:\t0000000000000000")) << "not even root's";
  EXPECT_THAT(text, HasSubstr("no secret")) << "beside it in /tmp";
  EXPECT_THAT(text, testing::ContainsRegex("process [0-9]\n")) << "processes of its own";
  EXPECT_TRUE(std::filesystem::exists(folder / "work/inside"));
  EXPECT_FALSE(std::filesystem::exists(SEEDFRAME_HOME "/outside"));
}

TEST_F(LocalPoolTest, WhatAWorkerStartedEndsWithIt) {
  const auto script = folder / "parent_blender";
  std::ofstream(script) << "#!/bin/sh\nsetsid sleep 1000 &\necho $! > "
                        << (folder / "child").string() << "\nsleep 0.2\nexit 1\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  worker.blender.path = script;
  make_pool();
  EXPECT_FALSE(run(1));
  int child = 0;
  std::ifstream(folder / "child") >> child;
  ASSERT_GT(child, 0);
  EXPECT_EQ(kill(child, 0), -1) << "it has left its worker's group, and lives";
}

TEST_F(LocalPoolTest, ASandboxedWorkerRendersAndDiesWithTheOthers) {
  if (const Status works = check_sandbox(); !works) GTEST_SKIP() << works.error().message;
  worker.wrapper = sandbox_arguments(folder, {SEEDFRAME_HOME});
  options.heartbeat_timeout = std::chrono::seconds(2);
  make_pool({{"crash_frames", {1}}, {"freeze_frames", {2}}});
  const auto summary = run(4);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, 4);
}

TEST_F(LocalPoolTest, WorkersDieWithASchedulerThatIsKilled) {
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

TEST_F(LocalPoolTest, ACrashCostsOneAttemptAndIsExplained) {
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

TEST_F(LocalPoolTest, AWorkerThatTheKernelKilledForLackOfMemoryIsNoFramesFault) {
  int asked = 0;
  worker.out_of_memory_kills = [&] { return asked++ == 0 ? 5 : 6; };
  make_pool({{"out_of_memory_frames", {1}}});
  const auto summary = run(4);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().kind, ErrorKind::kExhausted);
  EXPECT_THAT(summary.error().message, HasSubstr("out of memory and killed worker 0, which "
                                                 "rendered frame 1"));
  EXPECT_THAT(client->messages, IsEmpty());
}

TEST_F(LocalPoolTest, AWorkerThatSomebodyElseKilledIsACrash) {
  make_pool({{"out_of_memory_frames", {1}}});
  const auto summary = run(4);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 4);
  EXPECT_THAT(client->events, Contains("crashed 1.1"));
}

TEST_F(LocalPoolTest, AFrozenWorkerGivesNoSignOfLife) {
  options.heartbeat_timeout = std::chrono::seconds(2);
  make_pool({{"freeze_frames", {1}}});
  const auto summary = run(3);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 3);
  ASSERT_THAT(client->messages, SizeIs(1));
  EXPECT_THAT(client->messages[0], HasSubstr("no sign of life for 2 s"));
  expect_no_worker_lives();
}

TEST_F(LocalPoolTest, AWorkerThatIgnoresSigtermIsKilled) {
  options.frame_timeout = std::chrono::seconds(2);
  make_pool({{"ignore_term_frames", {0}}});
  const auto summary = run(2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  expect_no_worker_lives();
}

TEST_F(LocalPoolTest, AWorkerGetsNoMoreMemoryThanItsLimit) {
  worker.limits.memory_bytes = 1 << 20;
  make_pool();
  const auto summary = run(1);
  ASSERT_FALSE(summary) << "not even Python starts in a megabyte";
  EXPECT_THAT(summary.error().message, HasSubstr("did not get ready"));
}

TEST_F(LocalPoolTest, AWorkerThatLeavesWithoutAnAnswerCostsOneAttempt) {
  make_pool({{"exit_frames", {0}}});
  const auto summary = run(2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 2);
  ASSERT_THAT(client->messages, SizeIs(1));
  EXPECT_THAT(client->messages[0], HasSubstr("exited with status 0"));
}

TEST_F(LocalPoolTest, AHangingStartCountsAsAFailedOne) {
  options.start_timeout = std::chrono::milliseconds(300);
  make_pool({{"hang_before_ready", true}});
  const auto summary = run(1);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("not ready within 0.3 s"));
  expect_no_worker_lives();
}

TEST_F(LocalPoolTest, AProgramThatCannotBeStartedIsNamed) {
  worker.blender.path = folder / "no-blender";
  make_pool();
  const auto summary = run(1);
  ASSERT_FALSE(summary);
  EXPECT_THAT(summary.error().message, HasSubstr("cannot start"));
  EXPECT_THAT(summary.error().message, HasSubstr("No such file"));
}

TEST_F(LocalPoolTest, AChattyWorkerDoesNotFillTheDisk) {
  make_pool({{"chatty_log_bytes", 3'000'000}});
  const auto summary = run(6);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 6);
  EXPECT_LE(std::filesystem::file_size(folder / "worker-0.log"), 4u << 20);
  EXPECT_LE(std::filesystem::file_size(folder / "worker-0.log.1"), 4u << 20);
}

TEST_F(LocalPoolTest, ManyFaultsAtOnce) {
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
