#include "render/worker_pool.h"

#include <algorithm>

#include "render/pool_loop.h"

namespace seedframe {
namespace {

using namespace std::chrono_literals;

bool ends_the_run(const Error& error) {
  return error.kind == ErrorKind::kEnvironment || error.kind == ErrorKind::kExhausted;
}

}  // namespace

WorkerPool::WorkerPool(const PoolOptions& options, Executor& executor, RenderClient& client)
    : loop_(std::make_unique<Loop>(options, executor, client)) {}
WorkerPool::~WorkerPool() = default;

Result<RunSummary> WorkerPool::run(const std::vector<PendingFrame>& frames) {
  return loop_->run(frames);
}
void WorkerPool::post_verdict(const FrameJob& job, Status verdict) {
  loop_->post_verdict(job, std::move(verdict));
}
void WorkerPool::add(const PendingFrame& frame) { loop_->add(frame); }
void WorkerPool::drain() { loop_->drain(); }

WorkerPool::Loop::Loop(const PoolOptions& options, Executor& executor, RenderClient& client)
    : options_(options), executor_(executor), client_(client), timeout_(options_.frame_timeout) {
  slots_.resize(static_cast<std::size_t>(std::max(1, options_.workers)));
  for (std::size_t i = 0; i < slots_.size(); ++i) slots_[i].number = static_cast<int>(i);
}

Result<RunSummary> WorkerPool::Loop::run(const std::vector<PendingFrame>& frames) {
  Schedule schedule(frames, options_.attempts);
  while (!stopped_by_) {
    take_added(schedule);
    take_verdicts(schedule);
    take_drain(schedule);
    if (stopped_by_ || is_over(schedule)) break;
    retire_workers(schedule);
    start_workers(schedule);
    hand_out(schedule);
    if (stopped_by_ || is_over(schedule)) continue;
    wait_for_events();
    for (Slot& slot : slots_) {
      receive_from(slot, schedule);
      check_deadline(slot);
      take_end(slot, schedule);
    }
  }
  stop_all(schedule);
  if (stopped_by_) return tl::unexpected(*stopped_by_);
  return RunSummary{schedule.done(),    schedule.failed(), schedule.quarantined(),
                    schedule.waiting(), starts_,           /*from_cache=*/0};
}

bool WorkerPool::Loop::is_over(const Schedule& schedule) const {
  return schedule.finished() && (!options_.stays || drains_asked_ > 0);
}

void WorkerPool::Loop::stop_run(Error error) {
  if (!stopped_by_) stopped_by_ = std::move(error);  // the first one is the cause of the others
}

// ---- Work for workers ----

void WorkerPool::Loop::start_workers(Schedule& schedule) {
  std::int64_t wanted = schedule.workers_wanted() + (prepared_ ? 1 : 0);
  for (const Slot& slot : slots_) {
    if (slot.state == Slot::State::kStarting || slot.state == Slot::State::kIdle) --wanted;
  }
  for (Slot& slot : slots_) {
    if (wanted <= 0 || stopped_by_) return;
    if (slot.state != Slot::State::kStopped) continue;
    start(slot);
    --wanted;
  }
}

void WorkerPool::Loop::start(Slot& slot) {
  Result<std::shared_ptr<Worker>> worker = executor_.start(slot.number);
  if (!worker) return stop_run(worker.error());
  const int number = slot.number;
  slot = Slot{};
  slot.number = number;
  slot.state = Slot::State::kStarting;
  slot.worker = std::move(*worker);
  slot.start = ++starts_;
  slot.since = executor_.now();
  slot.deadline = slot.since + options_.start_timeout;
}

bool WorkerPool::Loop::waits_for_others() {
  has_begun_ = has_begun_ || !options_.begin_together ||
               std::none_of(slots_.begin(), slots_.end(), [](const Slot& slot) {
                 return slot.state == Slot::State::kStarting || slot.state == Slot::State::kEnding;
               });
  return !has_begun_;
}

void WorkerPool::Loop::hand_out(Schedule& schedule) {
  if (waits_for_others()) return;
  bool somebody_busy = false;
  for (Slot& slot : slots_) {
    if (slot.state == Slot::State::kIdle && !slot.suspect && !stopped_by_) {
      const bool fresh = slot.frames == 0;
      std::optional<PreparedJob> next;
      if (prepared_ && !(fresh && schedule.has_retry_for_fresh_worker())) {
        next = std::exchange(prepared_, std::nullopt);
      } else {
        next = prepare(schedule, fresh);
      }
      if (next) give(slot, *next, schedule);
    }
    somebody_busy = somebody_busy || slot.state == Slot::State::kBusy;
  }
  if (somebody_busy && !prepared_ && !stopped_by_) prepared_ = prepare(schedule, false);
}

std::optional<WorkerPool::Loop::PreparedJob> WorkerPool::Loop::prepare(Schedule& schedule,
                                                                       bool fresh_worker) {
  while (!stopped_by_ && schedule.unjudged() < options_.max_unjudged) {
    const std::optional<FrameJob> job = schedule.next(fresh_worker);
    if (!job) break;
    const Result<std::optional<RenderRequest>> request = client_.request(*job);
    if (request && *request) return PreparedJob{*job, encode_render_message(*job, **request)};
    if (request) {
      schedule.rendered(*job);
      rendered_by_[*job] = kNoStart;
    } else if (ends_the_run(request.error())) {
      schedule.withdraw(*job);
      stop_run(request.error());
    } else {
      schedule.fail_for_good(*job);
      client_.attempt_failed(
          *job, {Failure::kAnswered, Consequence::kFailed, request.error().message, {}});
    }
  }
  return std::nullopt;
}

void WorkerPool::Loop::give(Slot& slot, const PreparedJob& prepared, const Schedule& schedule) {
  slot.state = Slot::State::kBusy;
  slot.job = prepared.job;
  slot.since = executor_.now();
  slot.deadline = slot.since + timeout_.limit(schedule.crashes(slot.job.frame));
  slot.heartbeat = slot.since + options_.heartbeat_timeout;
  ++slot.frames;
  slot.worker->send(prepared.message);
  client_.started(slot.job, slot.number);
}

void WorkerPool::Loop::retire_workers(Schedule& schedule) {
  for (Slot& slot : slots_) {
    if (slot.state != Slot::State::kIdle) continue;
    const bool worn = options_.frames_per_worker > 0 && slot.frames >= options_.frames_per_worker;
    const bool grown = options_.worker_memory_bytes > 0 && slot.frames > 0 &&
                       slot.memory_bytes > options_.worker_memory_bytes;
    const bool in_the_way = !prepared_ && schedule.wants_fresh_worker() && slot.frames > 0;
    if (slot.suspect || worn || grown || in_the_way) stop(slot, kPatience);
  }
}

// ---- From other threads and signal handlers ----

void WorkerPool::Loop::post_verdict(const FrameJob& job, Status verdict) {
  {
    const std::lock_guard lock(verdicts_mutex_);
    verdicts_.emplace_back(job, std::move(verdict));
  }
  executor_.wake();
}

void WorkerPool::Loop::add(const PendingFrame& frame) {
  {
    const std::lock_guard lock(verdicts_mutex_);
    added_.push_back(frame);
  }
  executor_.wake();
}

void WorkerPool::Loop::take_added(Schedule& schedule) {
  const std::lock_guard lock(verdicts_mutex_);
  for (const PendingFrame& frame : added_) schedule.add(frame);
  added_.clear();
}

void WorkerPool::Loop::drain() {
  drains_asked_.fetch_add(1);
  executor_.wake();
}

void WorkerPool::Loop::take_verdicts(Schedule& schedule) {
  std::vector<std::pair<FrameJob, Status>> verdicts;
  {
    const std::lock_guard lock(verdicts_mutex_);
    verdicts.swap(verdicts_);
  }
  for (const auto& [job, verdict] : verdicts) take_verdict(schedule, job, verdict);
}

void WorkerPool::Loop::take_verdict(Schedule& schedule, const FrameJob& job,
                                    const Status& verdict) {
  const auto found = rendered_by_.find(job);
  if (found == rendered_by_.end()) return;
  const int start = found->second;
  rendered_by_.erase(found);
  if (verdict) {
    schedule.committed(job);
    return;
  }
  if (ends_the_run(verdict.error())) return stop_run(verdict.error());
  for (Slot& slot : slots_) {
    if (slot.state != Slot::State::kStopped && slot.start == start) slot.suspect = true;
  }
  fail_attempt(schedule, job, Failure::kBadFile, verdict.error().message, {});
}

void WorkerPool::Loop::take_drain(Schedule& schedule) {
  const int asked = drains_asked_.load();
  if (asked == 0) return;
  schedule.drain();
  if (prepared_) schedule.withdraw(prepared_->job);
  prepared_.reset();
  for (Slot& slot : slots_) {
    if (slot.state == Slot::State::kStarting) stop(slot, 0ms);
    if (asked < 2 || slot.worker == nullptr) continue;
    const bool busy = slot.state == Slot::State::kBusy;
    if (busy || slot.charged) schedule.withdraw(busy ? slot.job : *slot.charged);
    slot.wrong.reset();
    slot.charged.reset();
    stop(slot, 0ms);
    slot.worker->kill();
  }
}

}  // namespace seedframe
