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

constexpr int kMostFailedStarts = 3;
constexpr auto kPatience = 500ms;  // for a worker to end by itself

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
      wake_fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  workers_.resize(static_cast<std::size_t>(std::max(1, options_.workers)));
  for (std::size_t i = 0; i < workers_.size(); ++i) workers_[i].number = static_cast<int>(i);
}

WorkerPool::Loop::~Loop() { close(wake_fd_); }

Result<RunSummary> WorkerPool::Loop::run(const std::vector<PendingFrame>& frames) {
  if (wake_fd_ < 0) return fail(ErrorKind::kEnvironment, "cannot make an eventfd");
  Schedule schedule(frames, options_.max_attempts);
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
      check_deadline(worker, schedule);
    }
  }
  stop_all(stopped_by_ ? 0ms : kPatience);
  if (stopped_by_) return tl::unexpected(*stopped_by_);
  return RunSummary{schedule.done(), schedule.failed(), schedule.waiting(), starts_};
}

void WorkerPool::Loop::stop_run(Error error) {
  if (!stopped_by_) stopped_by_ = std::move(error);  // the first one is the cause of the others
}

// ---- Work for workers ----

void WorkerPool::Loop::start_workers(Schedule& schedule) {
  if (schedule.draining()) return;
  std::int64_t wanted = schedule.waiting() + (prepared_ ? 1 : 0);
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
  WorkerCommand command;
  command.blender = options_.blender;
  command.scripts = options_.scripts;
  command.log = options_.log_path(worker.number);
  command.threads = options_.threads;
  command.environment = options_.environment;
  Result<std::unique_ptr<WorkerProcess>> process = WorkerProcess::start(command);
  if (!process) return stop_run(process.error());
  const int number = worker.number;
  worker = Worker{};
  worker.number = number;
  worker.state = Worker::State::kStarting;
  worker.process = std::move(*process);
  worker.start = ++starts_;
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
      if (next) give(worker, *next);
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
    const Result<RenderRequest> request = client_.request(*job);
    if (request) return PreparedJob{*job, encode_render_message(*job, *request)};
    if (request.error().kind == ErrorKind::kEnvironment) {
      schedule.withdraw(*job);
      stop_run(request.error());
    } else {
      schedule.fail_for_good(*job);
      client_.attempt_failed(*job, request.error().message, true);
    }
  }
  return std::nullopt;
}

void WorkerPool::Loop::give(Worker& worker, const PreparedJob& prepared) {
  worker.state = Worker::State::kBusy;
  worker.job = prepared.job;
  worker.since = Clock::now();
  worker.deadline = worker.since + options_.frame_timeout;
  ++worker.frames;
  worker.process->send(prepared.message);
  client_.started(worker.job, worker.number);
}

void WorkerPool::Loop::retire_workers(Schedule& schedule) {
  for (Worker& worker : workers_) {
    if (worker.state != Worker::State::kIdle) continue;
    const bool worn = options_.frames_per_worker > 0 && worker.frames >= options_.frames_per_worker;
    const bool in_the_way = !prepared_ && schedule.wants_fresh_worker() && worker.frames > 0;
    if (worker.suspect || worn || in_the_way) stop(worker, kPatience);
  }
}

// ---- What comes from workers ----

void WorkerPool::Loop::wait_for_events() {
  std::vector<pollfd> waiting = {{wake_fd_, POLLIN, 0}};
  auto deadline = Clock::time_point::max();
  for (const Worker& worker : workers_) {
    if (worker.state == Worker::State::kStopped) continue;
    const short events = worker.process->has_unsent() ? POLLIN | POLLOUT : POLLIN;
    waiting.push_back({worker.process->channel(), events, 0});
    if (worker.state != Worker::State::kIdle) deadline = std::min(deadline, worker.deadline);
  }
  int timeout_ms = -1;
  if (deadline != Clock::time_point::max()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    timeout_ms = static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 60'000));
  }
  poll(waiting.data(), waiting.size(), timeout_ms);
}

void WorkerPool::Loop::receive_from(Worker& worker, Schedule& schedule) {
  if (worker.state == Worker::State::kStopped) return;
  worker.process->send_more();
  std::vector<std::string> lines;
  const bool open = worker.process->receive(lines);
  for (const std::string& line : lines) {
    if (!take_line(worker, line, schedule)) return;
  }
  if (!open) give_up(worker, schedule, "");
}

bool WorkerPool::Loop::take_line(Worker& worker, const std::string& line, Schedule& schedule) {
  const Result<WorkerMessage> message = parse_worker_message(line);
  if (!message) {
    give_up(worker, schedule, message.error().message);
    return false;
  }
  if (const auto* ready = std::get_if<ReadyMessage>(&*message)) {
    if (worker.state == Worker::State::kStarting) return take_ready(worker, *ready);
    give_up(worker, schedule, "it said \"ready\" twice");
    return false;
  }
  const auto* done = std::get_if<DoneMessage>(&*message);
  const auto* failed = std::get_if<FailedMessage>(&*message);
  const FrameJob& job = done != nullptr ? done->job : failed->job;
  if (worker.state != Worker::State::kBusy || job != worker.job) {
    give_up(
        worker, schedule,
        fmt::format("it answered about frame {}, attempt {}, which is not what it was asked for",
                    job.frame, job.attempt));
    return false;
  }
  worker.process->bound_log();
  worker.state = Worker::State::kIdle;
  return done != nullptr ? take_done(worker, *done, schedule)
                         : take_failed(worker, *failed, schedule);
}

bool WorkerPool::Loop::take_ready(Worker& worker, const ReadyMessage& ready) {
  if (ready.protocol != kWorkerProtocol) {
    stop_run({ErrorKind::kEnvironment,
              fmt::format("the worker in {} speaks protocol {}, this program {}: the two are of "
                          "different versions of Seedframe",
                          options_.scripts.string(), ready.protocol, kWorkerProtocol)});
    return false;
  }
  starts_failed_in_a_row_ = 0;
  worker.state = Worker::State::kIdle;
  client_.worker_ready(worker.number, ready);
  return true;
}

bool WorkerPool::Loop::take_done(Worker& worker, const DoneMessage& done, Schedule& schedule) {
  schedule.rendered(done.job);
  rendered_by_[done.job] = worker.start;
  const std::chrono::duration<double> total = Clock::now() - worker.since;
  client_.rendered(done.job, {done.build_s, done.render_s, total.count()}, worker.number);
  return true;
}

bool WorkerPool::Loop::take_failed(Worker&, const FailedMessage& failed, Schedule& schedule) {
  fail_attempt(schedule, failed.job, RetryIn::kAnyWorker, failed.error);
  return true;
}

void WorkerPool::Loop::check_deadline(Worker& worker, Schedule& schedule) {
  const bool waiting =
      worker.state == Worker::State::kStarting || worker.state == Worker::State::kBusy;
  if (!waiting || Clock::now() < worker.deadline) return;
  const auto allowed =
      worker.state == Worker::State::kStarting ? options_.start_timeout : options_.frame_timeout;
  give_up(
      worker, schedule,
      fmt::format("it gave no answer within {:g} s", static_cast<double>(allowed.count()) / 1e3));
}

void WorkerPool::Loop::give_up(Worker& worker, Schedule& schedule, const std::string& why) {
  const Worker::State state = worker.state;
  // A worker that closed its channel is about to end; how it ends is worth a moment.
  const std::string end = worker.process->end(why.empty() ? 1000ms : 0ms);
  const std::string tail = worker.process->log_tail();
  std::string message =
      fmt::format("worker {}: {}", worker.number, why.empty() ? "it " + end : why);
  message += tail.empty() ? "; its log is empty" : "; its log ends with:\n" + tail;
  stop(worker, 0ms);
  if (state == Worker::State::kBusy) {
    fail_attempt(schedule, worker.job, RetryIn::kFreshWorker, message);
  }
  if (state == Worker::State::kStarting && ++starts_failed_in_a_row_ >= kMostFailedStarts) {
    stop_run({ErrorKind::kEnvironment,
              fmt::format("{} workers in a row did not get ready. The last was {}",
                          starts_failed_in_a_row_, message)});
  }
}

void WorkerPool::Loop::fail_attempt(Schedule& schedule, const FrameJob& job, RetryIn where,
                                    const std::string& why) {
  const bool final = schedule.is_last_attempt(job);
  if (schedule.attempt_failed(job, where)) client_.attempt_failed(job, why, final);
}

void WorkerPool::Loop::stop(Worker& worker, std::chrono::milliseconds patience) {
  if (worker.process) worker.process->end(patience);
  worker.process.reset();
  worker.state = Worker::State::kStopped;
}

void WorkerPool::Loop::stop_all(std::chrono::milliseconds patience) {
  for (Worker& worker : workers_) {
    if (worker.process) worker.process->close_channel();  // so that they end at the same time
  }
  for (Worker& worker : workers_) {
    stop(worker, worker.state == Worker::State::kIdle ? patience : 0ms);
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

void WorkerPool::Loop::take_verdicts(Schedule& schedule) {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t bytes = read(wake_fd_, &count, sizeof count);
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
  if (verdict.error().kind == ErrorKind::kEnvironment) return stop_run(verdict.error());
  for (Worker& worker : workers_) {
    if (worker.state != Worker::State::kStopped && worker.start == start) worker.suspect = true;
  }
  fail_attempt(schedule, job, RetryIn::kFreshWorker, verdict.error().message);
}

void WorkerPool::Loop::take_drain(Schedule& schedule) {
  const int asked = drains_asked_.load();
  if (asked == 0) return;
  schedule.drain();
  if (prepared_) schedule.withdraw(prepared_->job);
  prepared_.reset();
  for (Worker& worker : workers_) {
    if (worker.state == Worker::State::kStarting) stop(worker, 0ms);
    if (asked < 2 || worker.state != Worker::State::kBusy) continue;
    stop(worker, 0ms);
    schedule.withdraw(worker.job);
  }
}

}  // namespace seedframe
