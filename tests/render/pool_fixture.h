// A pool of fake Blenders, and a client that writes down what it is told.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/canonical_json.h"
#include "render/worker_pool.h"
#include "spec/frame_spec.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {

inline FrameSpec small_spec(std::int64_t frame) {
  FrameSpec spec;
  spec.render.width = 16;
  spec.render.height = 12;
  spec.render.samples = 1;
  spec.render.seed = static_cast<std::uint32_t>(frame);
  spec.camera = {{20.0, 20.0}, {7.5, 5.5}, 0.01, 100.0};
  spec.materials.emplace_back();
  InstanceSpec instance;
  instance.name = "thing/0";
  instance.id = 1;
  instance.category = 1;
  instance.mesh = std::string(64, 'a');
  instance.materials = {0};
  instance.camera_from_object.translation() = Eigen::Vector3d(0, 0, -1);
  spec.instances.push_back(instance);
  return spec;
}

/// Judges at once: good if the file is there and of full length, unless a test brings its own
/// judge.
class RecordingClient : public RenderClient {
 public:
  explicit RecordingClient(std::filesystem::path folder) : folder_(std::move(folder)) {}

  Result<std::optional<RenderRequest>> request(const FrameJob& job) override {
    if (on_request) {
      if (const Status status = on_request(job); !status) return forward_error(status);
    }
    RenderRequest request;
    request.spec = canonical_json(to_json(small_spec(job.frame)));
    request.output = output(job);
    request.frame_id = fmt::format("{:064}", job.frame);
    return request;
  }
  void started(const FrameJob& job, int worker) override {
    events.push_back(fmt::format("started {}.{}", job.frame, job.attempt));
    last_worker = worker;
    if (on_started) on_started(job);
  }
  void rendered(const FrameJob& job, const RenderTimings& timings, int) override {
    events.push_back(fmt::format("rendered {}.{}", job.frame, job.attempt));
    EXPECT_GE(timings.total_s, 0.0);
    on_rendered(job);
  }
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override {
    const char* end = failure.consequence == Consequence::kRetry    ? ""
                      : failure.consequence == Consequence::kFailed ? " for good"
                                                                    : " into quarantine";
    events.push_back(fmt::format("{} {}.{}{}",
                                 failure.failure == Failure::kCrash ? "crashed" : "failed",
                                 job.frame, job.attempt, end));
    messages.push_back(failure.message);
    last_log = failure.log;
    if (on_failed) on_failed();
  }
  Status check_system() override { return system; }
  void worker_ready(int, const ReadyMessage& ready) override {
    EXPECT_EQ(ready.build, "fake");
    ++workers_ready;
  }

  std::filesystem::path output(const FrameJob& job) const {
    return folder_ / fmt::format("{}-{}.exr", job.frame, job.attempt);
  }

  Status judge(const FrameJob& job) const {
    std::error_code error;
    const auto size = std::filesystem::file_size(output(job), error);
    if (error) return fail(ErrorKind::kRender, "no file");
    if (size < 2000) return fail(ErrorKind::kRender, "half a file");
    return {};
  }

  std::function<void(const FrameJob&)> on_rendered;
  std::function<void(const FrameJob&)> on_started;
  std::function<void()> on_failed;
  std::function<Status(const FrameJob&)> on_request;
  std::vector<std::string> events;
  std::vector<std::string> messages;
  std::string last_log;
  Status system;
  int workers_ready = 0;
  int last_worker = -1;

 private:
  std::filesystem::path folder_;
};

class PoolTest : public testing::Test {
 protected:
  PoolTest() {
    client = std::make_unique<RecordingClient>(folder);
    options.worker.blender = SEEDFRAME_HOME "/tests/fake_blender/fake_blender.py";
    options.worker.scripts = SEEDFRAME_HOME "/blender_scripts";
    options.worker.log_path = [this](int worker) {
      return folder / fmt::format("worker-{}.log", worker);
    };
    // Long enough for a busy machine: only a test that wants a timeout sets a short one.
    options.frame_timeout = std::chrono::seconds(60);
  }

  /// `wishes` is SEEDFRAME_FAKE without the log of starts.
  void make_pool(Json wishes = Json::object()) {
    wishes["starts_log"] = starts_log().string();
    options.worker.environment["SEEDFRAME_FAKE"] = wishes.dump();
    pool = std::make_unique<WorkerPool>(options, *client);
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
  std::unique_ptr<RecordingClient> client;
  std::unique_ptr<WorkerPool> pool;
};

}  // namespace seedframe
