// A pool of real processes: fake Blenders, whose files are looked at.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "render/local_executor.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/render/recording_client.h"

namespace seedframe {

class LocalPoolTest : public testing::Test {
 protected:
  LocalPoolTest() {
    client = std::make_unique<RecordingClient>(folder);
    worker.blender.path = SEEDFRAME_HOME "/tests/fake_blender/fake_blender.py";
    worker.scripts = SEEDFRAME_HOME "/blender_scripts";
    worker.log_path = [this](int number) { return folder / fmt::format("worker-{}.log", number); };
    // Long enough for a busy machine: only a test that wants a timeout sets a short one.
    options.frame_timeout = std::chrono::seconds(60);
  }

  /// `wishes` is SEEDFRAME_FAKE without the log of starts.
  void make_pool(Json wishes = Json::object()) {
    wishes["starts_log"] = starts_log().string();
    worker.environment["SEEDFRAME_FAKE"] = wishes.dump();
    executor = std::make_unique<LocalExecutor>(worker);
    pool = std::make_unique<WorkerPool>(options, *executor, *client);
    if (!client->on_rendered) {
      client->on_rendered = [this](const FrameJob& job) {
        pool->post_verdict(job, client->judge(job));
      };
    }
  }
  Result<RunSummary> run(int frames) {
    std::vector<PendingFrame> pending;
    for (int frame = 0; frame < frames; ++frame) pending.push_back({frame});
    return pool->run(pending);
  }

  std::filesystem::path starts_log() const { return folder / "starts"; }
  std::vector<pid_t> workers_started() const {
    std::ifstream log(starts_log());
    std::vector<pid_t> pids;
    for (pid_t pid = 0; log >> pid;) pids.push_back(pid);
    return pids;
  }
  static bool is_alive(pid_t pid) {
    std::ifstream stat(fmt::format("/proc/{}/stat", pid));
    std::string number, name, state;
    return stat >> number >> name >> state && state != "Z" && state != "X";
  }
  void expect_no_worker_lives() const {
    for (const pid_t pid : workers_started()) EXPECT_FALSE(is_alive(pid)) << pid;
  }

  ScratchFolder folder;
  PoolOptions options;
  WorkerOptions worker;
  std::unique_ptr<RecordingClient> client;
  std::unique_ptr<LocalExecutor> executor;
  std::unique_ptr<WorkerPool> pool;
};

}  // namespace seedframe
