#include "console/progress.h"

#include <cmath>
#include <cstdio>

#include <fmt/core.h>
#include <unistd.h>

#include "base/message_text.h"
#include "console/say.h"

namespace seedframe {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

std::string bar(double share) {
  constexpr int kCells = 24;
  const int full = static_cast<int>(share * kCells);
  std::string text;
  for (int i = 0; i < kCells; ++i) text += i < full ? "█" : "·";
  return text;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::string duration_text(double seconds) {
  const long long whole = std::llround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

Progress::Progress(std::int64_t frames, std::int64_t done_before, bool quiet)
    : frames_(frames),
      done_before_(done_before),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_shown_(start_) {
  show(true);
}

Progress::~Progress() { finish(); }

std::string Progress::line() const {
  const std::int64_t all = frames_ + done_before_;
  const std::int64_t ended = done_before_ + done_ + failed_;
  const double share = all == 0 ? 1.0 : static_cast<double>(ended) / static_cast<double>(all);
  std::string text = fmt::format("{}/{} frames", done_before_ + done_, all);
  if (failed_ > 0) text += fmt::format(", {} failed", failed_);
  // The first frame waits for Blender to start; the rate is that of the frames after it.
  const double elapsed = done_ > 1 ? seconds_between(first_done_, Clock::now()) : 0.0;
  constexpr double kKnown = 0.5;  // s: a rate over less means nothing
  if (elapsed > kKnown) {
    const double rate = static_cast<double>(done_ - 1) / elapsed;
    text += fmt::format(", {:.2f} frames/s", rate);
    const std::int64_t left = frames_ - done_ - failed_;
    if (left > 0) text += ", about " + duration_text(static_cast<double>(left) / rate) + " left";
  }
  return terminal_ ? bar(share) + " " + text : text;
}

void Progress::show(bool now) {
  if (quiet_) return;
  const auto time = Clock::now();
  constexpr double kTerminalInterval = 0.1;
  constexpr double kPlainInterval = 10.0;
  const double interval = terminal_ ? kTerminalInterval : kPlainInterval;
  if (!now && seconds_between(last_shown_, time) < interval) return;
  last_shown_ = time;
  if (terminal_) {
    std::fprintf(stderr, "\r\033[K%s", line().c_str());
    line_open_ = true;
  } else {
    std::fprintf(stderr, "%s\n", line().c_str());
  }
  std::fflush(stderr);
}

void Progress::frame_done(std::int64_t) {
  if (done_++ == 0) first_done_ = Clock::now();
  show(done_ + failed_ == frames_);
}

void Progress::attempt_failed(const FrameJob& job, const AttemptFailure& failure) {
  const bool final = failure.consequence != Consequence::kRetry;
  if (final) ++failed_;
  if (line_open_) std::fputs("\r\033[K", stderr);
  const char* next = failure.consequence == Consequence::kQuarantined ? " and is quarantined"
                     : final                                          ? " for good"
                                                                      : ", trying again";
  say_aside("frame {}, attempt {} {}{}: {}\n", job.frame, job.attempt,
            failure.failure == Failure::kCrash ? "cost a worker" : "failed", next,
            first_line(failure.message));
  show(terminal_);
}

void Progress::noted(const std::string& text) {
  if (line_open_) std::fputs("\r\033[K", stderr);
  say_aside("seedframe: note: {}\n", text);
  show(terminal_);
}

void Progress::paused(const Error& why, double limit_s) {
  finish();
  say_aside("seedframe: paused: {}\n", why.message);
  std::fprintf(stderr, "seedframe: waiting up to %s for it to pass; Ctrl-C ends\n",
               duration_text(limit_s).c_str());
}

void Progress::goes_on(std::int64_t frames) {
  std::fprintf(stderr, "seedframe: going on with %lld frames\n", static_cast<long long>(frames));
}

void Progress::finish() {
  if (line_open_) std::fputc('\n', stderr);
  line_open_ = false;
}

StepProgress::StepProgress(std::string what) : what_(std::move(what)) {
  if (isatty(STDERR_FILENO) != 0) thread_ = std::thread([this] { show_until_stopped(); });
}

StepProgress::~StepProgress() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  stop_.notify_one();
  thread_.join();
}

void StepProgress::begin(const std::string& step) {
  const std::lock_guard lock(mutex_);
  step_ = step;
}

void StepProgress::show_until_stopped() {
  using std::chrono::milliseconds;
  const auto start = Clock::now();
  std::unique_lock lock(mutex_);
  milliseconds wait(2000);
  bool shown = false;
  while (!stop_.wait_for(lock, wait, [this] { return stopped_; })) {
    std::fprintf(stderr, "\r\033[K%s: %s, %s", printable(what_).c_str(), step_.c_str(),
                 duration_text(seconds_between(start, Clock::now())).c_str());
    std::fflush(stderr);
    shown = true;
    wait = milliseconds(200);
  }
  if (shown) std::fputs("\r\033[K", stderr);
}

}  // namespace seedframe
