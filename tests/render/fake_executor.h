// Workers in memory and a clock that moves only while the pool waits: whatever workers do, and for
// however long, a test of the pool takes a moment.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/canonical_json.h"
#include "render/worker.h"

namespace seedframe {

/// What a worker makes of an attempt.
enum class Act {
  kRender,
  kBadFile,         ///< says that it is done, and is not to be believed
  kFail,            ///< answers "failed"
  kCrash,           ///< segmentation fault
  kExit,            ///< ends in good order, without an answer
  kOutOfMemory,     ///< the system kills it for lack of memory
  kKilledByOthers,  ///< somebody kills it
  kHang,            ///< never answers, but gives signs of life
  kIgnoreTerm,      ///< the same, and ends only when it is killed
  kFreeze,          ///< gives no sign of life any more
  kGarbage,         ///< answers with something else than a message
  kReadyAgain,      ///< says that it is ready
  kWrongFrame,      ///< answers about another frame
  kWrongAttempt,    ///< answers about another attempt
};

class FakeExecutor : public Executor {
 public:
  using Milliseconds = std::chrono::milliseconds;

  // How workers are, to be set before they start.
  Milliseconds start_time{100};
  Milliseconds start_time_more{0};  ///< of each place of the pool than of the one before
  Milliseconds render_time{100};
  std::int64_t memory_bytes = 50'000'000;
  int protocol = kWorkerProtocol;
  int failing_starts = 0;         ///< so many of the first die before they are ready
  bool hangs_at_start = false;    ///< and never gets ready
  std::optional<Error> no_start;  ///< what start returns
  Status check_status;            ///< what check returns

  /// The first rule that fits an attempt counts; without one it renders.
  void act(Act act, const std::set<std::int64_t>& frames, int attempts = 1) {
    rules_.push_back({act, frames, attempts});
  }
  Act act_of(const FrameJob& job) const {
    for (const Rule& rule : rules_) {
      if (rule.frames.contains(job.frame) && job.attempt <= rule.attempts) return rule.act;
    }
    return Act::kRender;
  }
  /// Calls it when the pool waits that long after now.
  void after(Milliseconds delay, std::function<void()> call) {
    calls_.emplace(now_ + delay, std::move(call));
  }

  int starts() const { return starts_; }
  /// How many workers there are now.
  std::size_t living() { return workers().size(); }
  Milliseconds elapsed() const { return std::chrono::duration_cast<Milliseconds>(now_ - kBegin); }

  // Executor
  Result<std::shared_ptr<Worker>> start(int number) override;
  Status check(const ReadyMessage&) const override { return check_status; }
  Clock::time_point now() const override { return now_; }
  void wait(Clock::time_point deadline) override;
  void wake() override { woken_ = true; }

 private:
  class FakeWorker;
  struct Rule {
    Act act;
    std::set<std::int64_t> frames;
    int attempts;
  };
  static constexpr Clock::time_point kBegin{std::chrono::hours(1)};
  static constexpr Clock::time_point kEnd{std::chrono::hours(100)};

  std::vector<std::shared_ptr<FakeWorker>> workers() {
    std::vector<std::shared_ptr<FakeWorker>> living;
    for (const auto& each : started_) {
      if (auto worker = each.lock()) living.push_back(std::move(worker));
    }
    return living;
  }

  std::vector<Rule> rules_;
  std::multimap<Clock::time_point, std::function<void()>> calls_;
  std::vector<std::weak_ptr<FakeWorker>> started_;
  int starts_ = 0;
  Clock::time_point now_ = kBegin;
  std::atomic<bool> woken_ = false;
};

class FakeExecutor::FakeWorker : public Worker {
 public:
  using Time = Clock::time_point;
  static constexpr Time kNever = Time::max();

  FakeWorker(const FakeExecutor& executor, int number, int start) : executor_(executor) {
    const Time ready = executor.now() + executor.start_time + number * executor.start_time_more;
    if (executor.hangs_at_start) return;
    if (start <= executor.failing_starts) {
      print("fake: cannot open the display");
      leave(ready, "exited with status 1");
    } else {
      say_ready(ready);
      alive_ = ready;
    }
  }

  void send(std::string_view lines) override {
    const Json message = Json::parse(lines);
    const FrameJob job = {message.at("frame"), message.at("attempt")};
    const Time then = executor_.now() + executor_.render_time;
    answered_ = kNever;
    switch (const Act act = executor_.act_of(job); act) {
      case Act::kRender:
      case Act::kBadFile:
        return answer(then, "done", job);
      case Act::kWrongFrame:
        return answer(then, "done", {job.frame + 1, job.attempt});
      case Act::kWrongAttempt:
        return answer(then, "done", {job.frame, job.attempt + 1});
      case Act::kFail:
        return answer(then, "failed", job);
      case Act::kGarbage:
        lines_.emplace(then, "Fra:1 Mem:22.00M | Scene, ViewLayer");
        return;
      case Act::kReadyAgain:
        return say_ready(then);
      case Act::kCrash:
        print(fmt::format("fake: frame {} is too much", job.frame));
        return leave(then, "was killed by signal 11 (Segmentation fault)");
      case Act::kExit:
        return leave(then, "exited with status 0");
      case Act::kOutOfMemory:
      case Act::kKilledByOthers:
        end_.out_of_memory = act == Act::kOutOfMemory;
        return leave(then, "was killed by signal 9 (Killed)");
      case Act::kFreeze:
        alive_ = kNever;
        return;
      case Act::kIgnoreTerm:
        ignores_term_ = true;
        return;
      case Act::kHang:
        return;
    }
  }

  bool receive(std::vector<std::string>& lines) override {
    const Time now = executor_.now();
    while (alive_ <= now) {
      say(alive_, {{"type", "alive"}, {"memory_bytes", executor_.memory_bytes}});
      alive_ += Milliseconds(500);
    }
    while (!lines_.empty() && lines_.begin()->first <= now) {
      lines.push_back(std::move(lines_.begin()->second));
      lines_.erase(lines_.begin());
    }
    return now < ends_;
  }

  std::string log_tail(std::size_t most) const override {
    return log_.substr(log_.size() - std::min(most, log_.size()));
  }

  void stop(Milliseconds patience) override {
    if (std::exchange(stopped_, true)) return;
    const Time now = executor_.now();
    const bool idle = answered_ <= now;
    if (idle) return leave(now + Milliseconds(10), "exited with status 0");
    if (!ignores_term_) return leave(now + patience, "was killed by signal 15 (Terminated)");
    leave(now + patience + Milliseconds(500), "was killed by signal 9 (Killed)");
  }
  void kill() override {
    stopped_ = true;
    leave(executor_.now(), "was killed by signal 9 (Killed)");
  }
  std::optional<WorkerEnd> end() override {
    if (executor_.now() < ends_) return std::nullopt;
    return end_;
  }

  /// When the pool has a reason to look at it.
  Time next_event() const {
    if (stopped_) return ends_;
    return std::min({ends_, alive_, lines_.empty() ? kNever : lines_.begin()->first});
  }

 private:
  void say(Time when, const Json& message) { lines_.emplace(when, message.dump()); }
  void say_ready(Time when) {
    say(when, {{"type", "ready"},
               {"protocol", executor_.protocol},
               {"blender", "3.4.1"},
               {"build", "fake"},
               {"ocio_config", ""},
               {"kernel", "avx2"},
               {"embree", "avx2"},
               {"reciprocals", "fake"},
               {"libc", ""},
               {"device", "cpu"},
               {"devices", "CPU (fake)"},
               {"denoisers", ""}});
    answered_ = when;
  }
  void answer(Time when, const char* type, const FrameJob& job) {
    answered_ = when;
    say(when, {{"type", type},
               {"frame", job.frame},
               {"attempt", job.attempt},
               {"build_s", 0.001},
               {"render_s", 0.002},
               {"cpu_s", 0.003},
               {"error", "fake: will not render"}});
  }
  void print(const std::string& line) { log_ += (log_.empty() ? "" : "\n") + line; }
  void leave(Time when, const char* how) {
    if (ends_ <= when) return;
    ends_ = when;
    end_.how = how;
  }

  const FakeExecutor& executor_;
  std::multimap<Time, std::string> lines_;  ///< by when they come
  std::string log_;
  Time alive_ = kNever;     ///< when it gives the next sign of life
  Time answered_ = kNever;  ///< since when it has had nothing to do
  Time ends_ = kNever;
  WorkerEnd end_;
  bool ignores_term_ = false;
  bool stopped_ = false;
};

inline Result<std::shared_ptr<Worker>> FakeExecutor::start(int number) {
  if (no_start) return tl::unexpected(*no_start);
  auto worker = std::make_shared<FakeWorker>(*this, number, ++starts_);
  started_.push_back(worker);
  return worker;
}

inline void FakeExecutor::wait(Clock::time_point deadline) {
  if (woken_.exchange(false)) return;
  for (const auto& worker : workers()) deadline = std::min(deadline, worker->next_event());
  if (!calls_.empty()) deadline = std::min(deadline, calls_.begin()->first);
  if (deadline > kEnd) throw std::logic_error("the pool waits for what never comes");
  now_ = std::max(now_, deadline);
  while (!calls_.empty() && calls_.begin()->first <= now_) {
    const std::function<void()> call = std::move(calls_.begin()->second);
    calls_.erase(calls_.begin());
    call();
  }
}

}  // namespace seedframe
