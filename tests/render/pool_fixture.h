// A pool of workers that are in memory only.
#pragma once

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "render/worker_pool.h"
#include "tests/render/fake_executor.h"
#include "tests/render/recording_client.h"

namespace seedframe {

/// Frames are judged at once, as their workers behaved, unless a test judges itself.
class PoolTest : public testing::Test {
 protected:
  static constexpr int kAlways = 99;  ///< attempts

  Result<RunSummary> run(const std::vector<PendingFrame>& frames) {
    return make_pool().run(frames);
  }
  Result<RunSummary> run(int frames) {
    std::vector<PendingFrame> pending;
    for (int frame = 0; frame < frames; ++frame) pending.push_back({frame});
    return run(pending);
  }
  /// Of the options as they are; run does it if a test has not.
  WorkerPool& make_pool() {
    if (pool) return *pool;
    pool = std::make_unique<WorkerPool>(options, executor, client);
    if (!client.on_rendered) {
      client.on_rendered = [this](const FrameJob& job) { pool->post_verdict(job, judge(job)); };
    }
    return *pool;
  }
  Status judge(const FrameJob& job) const {
    if (executor.act_of(job) != Act::kBadFile) return {};
    return fail(ErrorKind::kRender, "half a file");
  }

  FakeExecutor executor;
  PoolOptions options;
  RecordingClient client{"/nowhere"};
  std::unique_ptr<WorkerPool> pool;
};

}  // namespace seedframe
