#include "render/worker_pool.h"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "render/pool_loop.h"

namespace seedframe {
namespace {

using namespace std::chrono_literals;

bool ends_the_run(const Error& error) {
  return error.kind == ErrorKind::kEnvironment || error.kind == ErrorKind::kExhausted;
}

}  // namespace

WorkerPool::WorkerPool(PoolOptions options, RenderClient& client)
    : loop_(std::make_unique<Loop>(std::move(options), client)) {}
WorkerPool::~WorkerPool() = default;

Result<RunSummary> WorkerPool::run(const std::vector<PendingFrame>& frames) {
  return loop_->run(frames);
}
void WorkerPool::post_verdict(const FrameJob& job, Status verdict) {
  loop_->post_verdict(job, std::move(verdict));
}
void WorkerPool::drain() { loop_->drain(); }

WorkerPool::Loop::Loop(PoolOptions options, RenderClient& client)
    : options_(std::move(options)),
      client_(client),
      timeout_(options_.frame_timeout),
      wake_fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  workers_.resize(static_cast<std::size_t>(std::max(1, options_.workers)));
  for (std::size_t i = 0; i < workers_.size(); ++i) workers_[i].number = static_cast<int>(i);
}

WorkerPool::Loop::~Loop() { close(wake_fd_); }

Result<RunSummary> WorkerPool::Loop::run(const std::vector<PendingFrame>& frames) {
  if (wake_fd_ < 0) return fail(ErrorKind::kExhausted, "cannot make an eventfd");
  Schedule schedule(frames, options_.attempts);
  while (!stopped_by_) {
    take_verdicts(schedule);
    take_drain(schedule);
    if (stopped_by_ || schedule.finished()) break;
    retire_workers(schedule);
    start_workers(schedule);
    hand_out(schedule);
    if (stopped_by_ || schedule.finished()) continue;
    wait_for_events();
    for (Worker& worker : workers_) {
      receive_from(worker, schedule);
      check_deadline(worker);
      take_end(worker, schedule);
    }
  }
  stop_all(schedule);
  if (stopped_by_) return tl::unexpected(*stopped_by_);
  return RunSummary{schedule.done(),    schedule.failed(), schedule.quarantined(),
                    schedule.waiting(), starts_,           /*from_cache=*/0};
}

void WorkerPool::Loop::stop_run(Error error) {
  if (!stopped_by_) stopped_by_ = std::move(error);  // the first one is the cause of the others
}

// ---- Work for workers ----

void WorkerPool::Loop::start_workers(Schedule& schedule) {
  std::int64_t wanted = schedule.workers_wanted() + (prepared_ ? 1 : 0);
  for (const Worker& worker : workers_) {
    if (worker.state == Worker::State::kStarting || worker.state == Worker::State::kIdle) --wanted;
  }
  for (Worker& worker : workers_) {
    if (wanted <= 0 || stopped_by_) return;
    if (worker.state != Worker::State::kStopped) continue;
    start(worker);
    --wanted;
  }
}

void WorkerPool::Loop::start(Worker& worker) {
  auto process = WorkerProcess::start(options_.worker, worker.number);
  if (!process) return stop_run(process.error());
  const int number = worker.number;
  worker = Worker{};
  worker.number = number;
  worker.state = Worker::State::kStarting;
  worker.process = std::move(*process);
  worker.start = ++starts_;
  worker.memory_kills = options_.out_of_memory_kills();
  worker.since = Clock::now();
  worker.deadline = worker.since + options_.start_timeout;
}

void WorkerPool::Loop::hand_out(Schedule& schedule) {
  bool somebody_busy = false;
  for (Worker& worker : workers_) {
    if (worker.state == Worker::State::kIdle && !worker.suspect && !stopped_by_) {
      const bool fresh = worker.frames == 0;
      std::optional<PreparedJob> next;
      if (prepared_ && !(fresh && schedule.has_retry_for_fresh_worker())) {
        next = std::exchange(prepared_, std::nullopt);
      } else {
        next = prepare(schedule, fresh);
      }
      if (next) give(worker, *next, schedule);
    }
    somebody_busy = somebody_busy || worker.state == Worker::State::kBusy;
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

void WorkerPool::Loop::give(Worker& worker, const PreparedJob& prepared, const Schedule& schedule) {
  worker.state = Worker::State::kBusy;
  worker.job = prepared.job;
  worker.since = Clock::now();
  worker.deadline = worker.since + timeout_.limit(schedule.crashes(worker.job.frame));
  worker.heartbeat = worker.since + options_.heartbeat_timeout;
  ++worker.frames;
  worker.process->send(prepared.message);
  client_.started(worker.job, worker.number);
}

void WorkerPool::Loop::retire_workers(Schedule& schedule) {
  for (Worker& worker : workers_) {
    if (worker.state != Worker::State::kIdle) continue;
    const bool worn = options_.frames_per_worker > 0 && worker.frames >= options_.frames_per_worker;
    const bool grown = options_.worker_memory_bytes > 0 && worker.frames > 0 &&
                       worker.memory_bytes > options_.worker_memory_bytes;
    const bool in_the_way = !prepared_ && schedule.wants_fresh_worker() && worker.frames > 0;
    if (worker.suspect || worn || grown || in_the_way) begin_end(worker, kPatience);
  }
}

// ---- From other threads and signal handlers ----

void WorkerPool::Loop::post_verdict(const FrameJob& job, Status verdict) {
  {
    const std::lock_guard lock(verdicts_mutex_);
    verdicts_.emplace_back(job, std::move(verdict));
  }
  wake();
}

void WorkerPool::Loop::drain() {
  drains_asked_.fetch_add(1);
  wake();
}

void WorkerPool::Loop::wake() {
  const int saved_errno = errno;
  const std::uint64_t one = 1;
  // It fails only when the counter is full, and then the loop is awake anyway.
  [[maybe_unused]] const ssize_t written = write(wake_fd_, &one, sizeof one);
  errno = saved_errno;
}

void WorkerPool::Loop::take_wake() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t bytes = read(wake_fd_, &count, sizeof count);
}

void WorkerPool::Loop::take_verdicts(Schedule& schedule) {
  take_wake();
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
  for (Worker& worker : workers_) {
    if (worker.state != Worker::State::kStopped && worker.start == start) worker.suspect = true;
  }
  fail_attempt(schedule, job, Failure::kBadFile, verdict.error().message, {});
}

void WorkerPool::Loop::take_drain(Schedule& schedule) {
  const int asked = drains_asked_.load();
  if (asked == 0) return;
  schedule.drain();
  if (prepared_) schedule.withdraw(prepared_->job);
  prepared_.reset();
  for (Worker& worker : workers_) {
    if (worker.state == Worker::State::kStarting) begin_end(worker, 0ms);
    if (asked < 2 || worker.process == nullptr) continue;
    const bool busy = worker.state == Worker::State::kBusy;
    if (busy || worker.charged) schedule.withdraw(busy ? worker.job : *worker.charged);
    worker.wrong.reset();
    worker.charged.reset();
    begin_end(worker, 0ms);
    worker.process->kill();
  }
}

}  // namespace seedframe
