// Brings what a task makes from its node to the file system that the head sees.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/finish_queue.h"
#include "slurm/task_frame.h"

namespace seedframe {

/// Of the task, for its records.
struct TaskFacts {
  std::string node;
  double started = 0.0;  ///< Unix time, seconds
  int workers = 1;
};

/// Told by the run of a task. Each frame that is over is copied, forced to the disk, renamed to its
/// name and then recorded, in order, by a thread of its own; what was copied goes from the node.
class Delivery : public RunObserver {
 public:
  /// `results` exists. Its store is read only while the run tells something.
  Delivery(Campaign& campaign, std::filesystem::path results, TaskFacts task);
  ~Delivery() override;
  Delivery(const Delivery&) = delete;
  Delivery& operator=(const Delivery&) = delete;

  /// Called once, from some thread, when nothing more can be delivered. To be set before the run.
  void on_error(std::function<void()> tell) { tell_ = std::move(tell); }
  /// Waits for what is under way. The first error.
  Status close();

  void frame_done(std::int64_t frame) override;
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override;
  void noted(const std::string& text) override;
  void paused(const Error&, double) override {}
  void goes_on(std::int64_t) override {}

 private:
  /// Reads what the store says of the frame, and has it delivered.
  void push(std::int64_t frame, FrameState state);
  Result<TaskFrame> record_of(std::int64_t frame, FrameState state);
  Status deliver(const TaskFrame& record);
  Status deliver_evidence(const TaskFrame& record);
  void fail_with(const Error& error);

  Campaign& campaign_;
  std::filesystem::path results_;
  TaskFacts task_;
  double first_frame_ = 0.0;  ///< when it was begun
  std::function<void()> tell_;
  std::mutex mutex_;  ///< guards status_
  Status status_;
  std::unique_ptr<FinishQueue> queue_;
};

}  // namespace seedframe
