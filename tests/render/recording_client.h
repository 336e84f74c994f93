// A client of the pool that writes down what it is told.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/canonical_json.h"
#include "render/worker_pool.h"
#include "spec/frame_spec.h"

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

}  // namespace seedframe
