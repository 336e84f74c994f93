// What comes from workers, and how they end.
#include <algorithm>

#include <fmt/format.h>

#include "render/pool_loop.h"

namespace seedframe {
namespace {

using namespace std::chrono_literals;

constexpr int kMostFailedStarts = 3;
constexpr std::size_t kQuotedLog = 2000;  // bytes of its log in the message about its end

double seconds(std::chrono::milliseconds time) { return static_cast<double>(time.count()) / 1e3; }

}  // namespace

void WorkerPool::Loop::wait_for_events() {
  auto deadline = Clock::time_point::max();
  for (const Slot& slot : slots_) {
    const bool busy = slot.state == Slot::State::kBusy;
    if (busy || slot.state == Slot::State::kStarting) deadline = std::min(deadline, slot.deadline);
    if (busy) deadline = std::min(deadline, slot.heartbeat);
  }
  executor_.wait(deadline);
}

void WorkerPool::Loop::receive_from(Slot& slot, Schedule& schedule) {
  if (slot.state == Slot::State::kStopped || slot.state == Slot::State::kEnding) return;
  std::vector<std::string> lines;
  const bool open = slot.worker->receive(lines);
  for (const std::string& line : lines) {
    if (!take_line(slot, line, schedule)) return;
  }
  if (!open) give_up(slot, "");
}

bool WorkerPool::Loop::take_line(Slot& slot, const std::string& line, Schedule& schedule) {
  const Result<WorkerMessage> message = parse_worker_message(line);
  if (!message) {
    give_up(slot, message.error().message);
    return false;
  }
  slot.heartbeat = executor_.now() + options_.heartbeat_timeout;
  if (const auto* alive = std::get_if<AliveMessage>(&*message)) {
    slot.memory_bytes = alive->memory_bytes;
    return true;
  }
  if (const auto* ready = std::get_if<ReadyMessage>(&*message)) {
    if (slot.state == Slot::State::kStarting) return take_ready(slot, *ready);
    give_up(slot, "it said \"ready\" twice");
    return false;
  }
  if (const auto* done = std::get_if<DoneMessage>(&*message)) {
    if (!take_answer(slot, done->job)) return false;
    take_done(slot, *done, schedule);
    return true;
  }
  const auto& failed = std::get<FailedMessage>(*message);
  if (!take_answer(slot, failed.job)) return false;
  fail_attempt(schedule, failed.job, Failure::kAnswered, failed.error, {});
  return true;
}

bool WorkerPool::Loop::take_ready(Slot& slot, const ReadyMessage& ready) {
  if (ready.protocol != kWorkerProtocol) {
    stop_run({ErrorKind::kEnvironment,
              fmt::format("worker {} speaks protocol {}, this program {}: its blender_scripts/ and "
                          "the program are of different versions of Seedframe",
                          slot.number, ready.protocol, kWorkerProtocol)});
    return false;
  }
  if (Status fits = executor_.check(ready); !fits) {
    stop_run(fits.error());
    return false;
  }
  starts_failed_in_a_row_ = 0;
  slot.state = Slot::State::kIdle;
  client_.worker_ready(slot.number, ready);
  return true;
}

bool WorkerPool::Loop::take_answer(Slot& slot, const FrameJob& job) {
  if (slot.state == Slot::State::kBusy && job == slot.job) {
    slot.state = Slot::State::kIdle;
    return true;
  }
  give_up(slot,
          fmt::format("it answered about frame {}, attempt {}, which is not what it was asked for",
                      job.frame, job.attempt));
  return false;
}

void WorkerPool::Loop::take_done(Slot& slot, const DoneMessage& done, Schedule& schedule) {
  schedule.rendered(done.job);
  rendered_by_[done.job] = slot.start;
  const auto total = executor_.now() - slot.since;
  if (options_.equal_frames) {
    timeout_.rendered(std::chrono::ceil<std::chrono::milliseconds>(total));
  }
  const std::chrono::duration<double> total_s = total;
  client_.rendered(done.job, {done.build_s, done.render_s, total_s.count(), done.cpu_s},
                   slot.number);
}

void WorkerPool::Loop::check_deadline(Slot& slot) {
  const auto now = executor_.now();
  if (slot.state == Slot::State::kStarting && now >= slot.deadline) {
    give_up(slot, fmt::format("it was not ready within {:g} s", seconds(options_.start_timeout)));
  }
  if (slot.state != Slot::State::kBusy) return;
  if (now >= slot.deadline) {
    const auto allowed = std::chrono::round<std::chrono::milliseconds>(slot.deadline - slot.since);
    give_up(slot, fmt::format("it gave no answer within {:g} s", seconds(allowed)));
  } else if (now >= slot.heartbeat) {
    give_up(slot,
            fmt::format("it gave no sign of life for {:g} s", seconds(options_.heartbeat_timeout)));
  }
}

// ---- The end of workers ----

void WorkerPool::Loop::give_up(Slot& slot, std::string wrong) {
  slot.was_starting = slot.state == Slot::State::kStarting;
  if (slot.state == Slot::State::kBusy) slot.charged = slot.job;
  // A worker that closed its channel is about to end; how it ends is worth a moment.
  const auto patience = wrong.empty() ? 1000ms : 0ms;
  slot.wrong = std::move(wrong);
  stop(slot, patience);
}

void WorkerPool::Loop::stop(Slot& slot, std::chrono::milliseconds patience) {
  slot.state = Slot::State::kEnding;
  slot.worker->stop(patience);
}

void WorkerPool::Loop::take_end(Slot& slot, Schedule& schedule) {
  if (slot.state != Slot::State::kEnding) return;
  const std::optional<WorkerEnd> end = slot.worker->end();
  if (!end) return;
  if (slot.wrong) charge_end(slot, *end, schedule);
  const int number = slot.number;
  slot = Slot{};
  slot.number = number;
}

void WorkerPool::Loop::charge_end(const Slot& slot, const WorkerEnd& end, Schedule& schedule) {
  const std::string frame =
      slot.charged ? fmt::format(", which rendered frame {}", slot.charged->frame) : "";
  if (end.out_of_memory) {
    if (slot.charged) schedule.withdraw(*slot.charged);
    return stop_run({ErrorKind::kExhausted,
                     fmt::format("the system ran out of memory and killed worker {}{}: give it "
                                 "fewer workers (--workers) or smaller frames",
                                 slot.number, frame)});
  }
  const std::string tail = slot.worker->log_tail(kQuotedLog);
  std::string message = fmt::format("worker {}: {}", slot.number,
                                    slot.wrong->empty() ? "it " + end.how : *slot.wrong);
  message += tail.empty() ? "; its log is empty" : "; its log ends with:\n" + tail;
  if (slot.charged) {
    fail_attempt(schedule, *slot.charged, Failure::kCrash, std::move(message),
                 slot.worker->log_tail(WorkerLog::kKept));
  } else if (slot.was_starting && ++starts_failed_in_a_row_ >= kMostFailedStarts) {
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
  for (Slot& slot : slots_) {
    if (slot.state == Slot::State::kStopped) continue;
    const bool idle = slot.state == Slot::State::kIdle;
    slot.wrong.reset();
    stop(slot, idle && !stopped_by_ ? kPatience : 0ms);
    if (stopped_by_) slot.worker->kill();
  }
  const auto lives = [](const Slot& slot) { return slot.state != Slot::State::kStopped; };
  while (std::any_of(slots_.begin(), slots_.end(), lives)) {
    for (Slot& slot : slots_) take_end(slot, schedule);
    if (std::any_of(slots_.begin(), slots_.end(), lives)) wait_for_events();
    for (Slot& slot : slots_) receive_from(slot, schedule);
  }
}

}  // namespace seedframe
