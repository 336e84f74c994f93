// How far a run is: one moving line on a terminal, a plain line now and then elsewhere.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "campaign/campaign_run.h"

namespace seedframe {

class Progress : public RunObserver {
 public:
  /// `frames` are to be rendered; `done_before` were done by earlier runs.
  Progress(std::int64_t frames, std::int64_t done_before, bool quiet);
  ~Progress() override;

  void frame_done(std::int64_t frame) override;
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override;
  void noted(const std::string& text) override;
  void paused(const Error& why, double limit_s) override;
  void goes_on(std::int64_t frames) override;
  /// Ends the moving line.
  void finish();

 private:
  std::string line() const;
  void show(bool now);

  std::int64_t frames_;
  std::int64_t done_before_;
  bool quiet_;
  bool terminal_;
  std::int64_t done_ = 0;
  std::int64_t failed_ = 0;  ///< or quarantined
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point first_done_;
  std::chrono::steady_clock::time_point last_shown_;
  bool line_open_ = false;
};

/// What an import is doing, and for how long: a moving line on a terminal, from its third second
/// on; nothing elsewhere.
class StepProgress {
 public:
  explicit StepProgress(std::string what);
  ~StepProgress();

  void begin(const std::string& step);

 private:
  void show_until_stopped();

  std::string what_;
  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopped_ = false;  // guarded by mutex_, as is step_
  std::string step_;
  std::thread thread_;  // only on a terminal
};

/// "1 h 02 min", "3 min 20 s", "12 s".
std::string duration_text(double seconds);

}  // namespace seedframe
