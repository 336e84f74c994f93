// What comes from workers, and how they end.
#include <algorithm>

#include <fmt/format.h>
#include <poll.h>

#include "render/pool_loop.h"

namespace seedframe {
namespace {

using namespace std::chrono_literals;

constexpr int kMostFailedStarts = 3;
constexpr std::size_t kQuotedLog = 2000;  // bytes of its log in the message about its end

double seconds(std::chrono::milliseconds time) { return static_cast<double>(time.count()) / 1e3; }

}  // namespace

void WorkerPool::Loop::wait_for_events() {
  std::vector<pollfd> waiting = {{wake_fd_, POLLIN, 0}};
  auto deadline = Clock::time_point::max();
  for (const Worker& worker : workers_) {
    if (worker.state == Worker::State::kStopped) continue;
    const short events = worker.process->has_unsent() ? POLLIN | POLLOUT : POLLIN;
    waiting.push_back({worker.process->channel(), events, 0});
    waiting.push_back({worker.process->log_pipe(), POLLIN, 0});
    if (worker.state == Worker::State::kEnding) {
      waiting.push_back({worker.process->end_event(), POLLIN, 0});
      deadline = std::min(deadline, worker.process->next_end_step());
    }
    const bool awaited =
        worker.state == Worker::State::kStarting || worker.state == Worker::State::kBusy;
    if (awaited) deadline = std::min(deadline, worker.deadline);
    if (worker.state == Worker::State::kBusy) deadline = std::min(deadline, worker.heartbeat);
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
  worker.process->read_log();
  if (worker.state == Worker::State::kEnding) return;
  worker.process->send_more();
  std::vector<std::string> lines;
  const bool open = worker.process->receive(lines);
  for (const std::string& line : lines) {
    if (!take_line(worker, line, schedule)) return;
  }
  if (!open) give_up(worker, "");
}

bool WorkerPool::Loop::take_line(Worker& worker, const std::string& line, Schedule& schedule) {
  const Result<WorkerMessage> message = parse_worker_message(line);
  if (!message) {
    give_up(worker, message.error().message);
    return false;
  }
  worker.heartbeat = Clock::now() + options_.heartbeat_timeout;
  if (const auto* alive = std::get_if<AliveMessage>(&*message)) {
    worker.memory_bytes = alive->memory_bytes;
    return true;
  }
  if (const auto* ready = std::get_if<ReadyMessage>(&*message)) {
    if (worker.state == Worker::State::kStarting) return take_ready(worker, *ready);
    give_up(worker, "it said \"ready\" twice");
    return false;
  }
  if (const auto* done = std::get_if<DoneMessage>(&*message)) {
    if (!take_answer(worker, done->job)) return false;
    take_done(worker, *done, schedule);
    return true;
  }
  const auto& failed = std::get<FailedMessage>(*message);
  if (!take_answer(worker, failed.job)) return false;
  fail_attempt(schedule, failed.job, Failure::kAnswered, failed.error, {});
  return true;
}

bool WorkerPool::Loop::take_ready(Worker& worker, const ReadyMessage& ready) {
  if (ready.protocol != kWorkerProtocol) {
    stop_run({ErrorKind::kEnvironment,
              fmt::format("the worker in {} speaks protocol {}, this program {}: the two are of "
                          "different versions of Seedframe",
                          options_.worker.scripts.string(), ready.protocol, kWorkerProtocol)});
    return false;
  }
  if (Status fits = check_worker(options_.worker.conditions, ready); !fits) {
    stop_run(fits.error());
    return false;
  }
  starts_failed_in_a_row_ = 0;
  worker.state = Worker::State::kIdle;
  client_.worker_ready(worker.number, ready);
  return true;
}

bool WorkerPool::Loop::take_answer(Worker& worker, const FrameJob& job) {
  if (worker.state == Worker::State::kBusy && job == worker.job) {
    worker.state = Worker::State::kIdle;
    return true;
  }
  give_up(worker,
          fmt::format("it answered about frame {}, attempt {}, which is not what it was asked for",
                      job.frame, job.attempt));
  return false;
}

void WorkerPool::Loop::take_done(Worker& worker, const DoneMessage& done, Schedule& schedule) {
  schedule.rendered(done.job);
  rendered_by_[done.job] = worker.start;
  const auto total = Clock::now() - worker.since;
  timeout_.rendered(std::chrono::ceil<std::chrono::milliseconds>(total));
  const std::chrono::duration<double> total_s = total;
  client_.rendered(done.job, {done.build_s, done.render_s, total_s.count()}, worker.number);
}

void WorkerPool::Loop::check_deadline(Worker& worker) {
  const auto now = Clock::now();
  if (worker.state == Worker::State::kStarting && now >= worker.deadline) {
    give_up(worker, fmt::format("it was not ready within {:g} s", seconds(options_.start_timeout)));
  }
  if (worker.state != Worker::State::kBusy) return;
  if (now >= worker.deadline) {
    const auto allowed =
        std::chrono::round<std::chrono::milliseconds>(worker.deadline - worker.since);
    give_up(worker, fmt::format("it gave no answer within {:g} s", seconds(allowed)));
  } else if (now >= worker.heartbeat) {
    give_up(worker,
            fmt::format("it gave no sign of life for {:g} s", seconds(options_.heartbeat_timeout)));
  }
}

// ---- The end of workers ----

void WorkerPool::Loop::give_up(Worker& worker, std::string wrong) {
  worker.was_starting = worker.state == Worker::State::kStarting;
  if (worker.state == Worker::State::kBusy) worker.charged = worker.job;
  // A worker that closed its channel is about to end; how it ends is worth a moment.
  const auto patience = wrong.empty() ? 1000ms : 0ms;
  worker.wrong = std::move(wrong);
  begin_end(worker, patience);
}

void WorkerPool::Loop::begin_end(Worker& worker, std::chrono::milliseconds patience) {
  worker.state = Worker::State::kEnding;
  worker.process->begin_end(patience);
}

void WorkerPool::Loop::take_end(Worker& worker, Schedule& schedule) {
  if (worker.state != Worker::State::kEnding) return;
  const std::optional<WorkerEnd> end = worker.process->take_end_steps();
  if (!end) return;
  if (worker.wrong) charge_end(worker, *end, schedule);
  const int number = worker.number;
  worker = Worker{};
  worker.number = number;
}

void WorkerPool::Loop::charge_end(const Worker& worker, const WorkerEnd& end, Schedule& schedule) {
  const std::string frame =
      worker.charged ? fmt::format(", which rendered frame {}", worker.charged->frame) : "";
  if (end.killed_by_others && options_.out_of_memory_kills() > worker.memory_kills) {
    if (worker.charged) schedule.withdraw(*worker.charged);
    return stop_run({ErrorKind::kExhausted,
                     fmt::format("the system ran out of memory and killed worker {}{}: give it "
                                 "fewer workers (--workers) or smaller frames",
                                 worker.number, frame)});
  }
  const std::string tail = worker.process->log_tail(kQuotedLog);
  std::string message = fmt::format("worker {}: {}", worker.number,
                                    worker.wrong->empty() ? "it " + end.how : *worker.wrong);
  message += tail.empty() ? "; its log is empty" : "; its log ends with:\n" + tail;
  if (worker.charged) {
    fail_attempt(schedule, *worker.charged, Failure::kCrash, std::move(message),
                 worker.process->log_tail(WorkerLog::kKept));
  } else if (worker.was_starting && ++starts_failed_in_a_row_ >= kMostFailedStarts) {
    stop_run({ErrorKind::kEnvironment,
              fmt::format("{} workers in a row did not get ready. The last was {}",
                          starts_failed_in_a_row_, message)});
  }
}

void WorkerPool::Loop::fail_attempt(Schedule& schedule, const FrameJob& job, Failure failure,
                                    std::string message, std::string log) {
  if (const Status system = client_.check_system(); !system) {
    schedule.withdraw(job);
    return stop_run(system.error());
  }
  const std::optional<Consequence> consequence = schedule.attempt_failed(job, failure);
  if (!consequence) return;
  client_.attempt_failed(job, {failure, *consequence, std::move(message), std::move(log)});
}

void WorkerPool::Loop::stop_all(Schedule& schedule) {
  for (Worker& worker : workers_) {
    if (worker.state == Worker::State::kStopped) continue;
    const bool idle = worker.state == Worker::State::kIdle;
    worker.wrong.reset();
    begin_end(worker, idle && !stopped_by_ ? kPatience : 0ms);
    if (stopped_by_) worker.process->kill();
  }
  const auto lives = [](const Worker& worker) { return worker.state != Worker::State::kStopped; };
  while (std::any_of(workers_.begin(), workers_.end(), lives)) {
    take_wake();  // or it would not wait
    for (Worker& worker : workers_) take_end(worker, schedule);
    if (std::any_of(workers_.begin(), workers_.end(), lives)) wait_for_events();
    for (Worker& worker : workers_) receive_from(worker, schedule);
  }
}

}  // namespace seedframe
