// What is given to which tasks, and how Slurm is asked for them.

#include <algorithm>

#include <fmt/ranges.h>

#include "base/files.h"
#include "slurm/slurm_run.h"

namespace seedframe {
namespace {

/// Of the jobs that the controller keeps, for all its users.
constexpr double kShareOfJobs = 0.5;
constexpr auto kLongestWait = std::chrono::seconds(60);
constexpr int kTriesToTell = 3;
/// Frames that were lost with their task are given out in so many times smaller batches, so that
/// the one that is to blame is alone in the end.
constexpr int kSmaller = 4;

std::chrono::steady_clock::duration wait_after(int tries) {
  const auto wait = std::chrono::seconds(1) * (1 << std::min(tries - 1, 6));
  return std::min<std::chrono::steady_clock::duration>(wait, kLongestWait);
}

}  // namespace

int SlurmRun::tasks_at_once() const {
  const int nodes = std::max(1, cluster_.nodes - static_cast<int>(left_out_.size()));
  return options_.nodes > 0 ? std::min(options_.nodes, nodes) : nodes;
}

TaskPlanWish SlurmRun::wish(std::int64_t frames) const {
  return {frames, tasks_at_once(), options_.time_s, options_.batch_frames};
}

Status SlurmRun::plan() {
  std::int64_t room =
      static_cast<std::int64_t>(kShareOfJobs * cluster_.most_jobs) - book_.open_batches();
  // Nothing is known yet of times: as many small tasks as run at once tell.
  const bool pilots = options_.batch_frames == 0 && !times_.known();
  if (pilots) room = std::min(room, tasks_at_once() - book_.open_batches());
  for (const auto& [losses, frames] : ledger_.free_frames()) {
    std::map<std::string, std::vector<std::int64_t>> by_avoided;
    for (const std::int64_t frame : frames) {
      const auto avoid = options_.avoid.find(frame);
      by_avoided[avoid == options_.avoid.end() ? std::string() : avoid->second].push_back(frame);
    }
    for (const auto& [avoided, group] : by_avoided) {
      if (Status given = submit_group(group, losses, avoided, room); !given) return given;
    }
  }
  return {};
}

std::vector<std::vector<std::int64_t>> SlurmRun::batches_of(const std::vector<std::int64_t>& frames,
                                                            int losses,
                                                            std::int64_t most_batches) const {
  std::int64_t size = frames_of_task(wish(static_cast<std::int64_t>(frames.size())), times_);
  for (int i = 0; i < losses; ++i) size = std::max<std::int64_t>(1, size / kSmaller);
  std::vector<std::vector<std::int64_t>> batches;
  for (std::size_t begin = 0; begin < frames.size();) {
    if (static_cast<std::int64_t>(batches.size()) == most_batches) break;
    const std::size_t end = std::min(frames.size(), begin + static_cast<std::size_t>(size));
    batches.emplace_back(frames.begin() + static_cast<std::ptrdiff_t>(begin),
                         frames.begin() + static_cast<std::ptrdiff_t>(end));
    begin = end;
  }
  return batches;
}

Status SlurmRun::submit_group(const std::vector<std::int64_t>& frames, int losses,
                              const std::string& avoided, std::int64_t& room) {
  std::size_t given = 0;
  while (given < frames.size() && room > 0) {
    const std::vector<std::int64_t> rest(frames.begin() + static_cast<std::ptrdiff_t>(given),
                                         frames.end());
    auto batches = batches_of(rest, losses, std::min<std::int64_t>(room, cluster_.most_tasks));
    Submission submission;
    std::size_t longest = 0;
    for (const std::vector<std::int64_t>& batch : batches) {
      given += batch.size();
      longest = std::max(longest, batch.size());
      for (const std::int64_t frame : batch) {
        if (const int crashes = ledger_.crashes(frame)) submission.crashes[frame] = crashes;
      }
    }
    room -= static_cast<std::int64_t>(batches.size());
    submission.batches = std::move(batches);
    submission.source = prepared_.source;
    submission.choices = prepared_.expander.choices();
    submission.node_folder = options_.node_folder;
    submission.run = options_for_tasks(asked_);
    ArrayOrder order;
    order.name = campaign_.files.root().filename().string();
    const auto count = static_cast<std::int64_t>(longest);
    order.time_s = time_of_task(count, wish(static_cast<std::int64_t>(frames.size())), times_);
    if (!avoided.empty()) order.exclude.push_back(avoided);
    const auto made = book_.create(std::move(submission), std::move(order), ledger_);
    if (!made) return forward_error(made);
  }
  return {};
}

Status SlurmRun::send_due() {
  const auto now = std::chrono::steady_clock::now();
  for (const auto& submission : book_.submissions()) {
    if (submission->job || submission->asked || now < submission->next_try) continue;
    if (submission->all_closed()) continue;
    if (Status sent = send(*submission); !sent) return sent;
  }
  return {};
}

Status SlurmRun::send(HeadSubmission& submission) {
  submission.asked = true;  // whatever the answer is: the queue is asked before it is called again
  ArrayOrder order = submission.order;
  order.exclude.insert(order.exclude.end(), left_out_.begin(), left_out_.end());
  order.cpus = options_.cpus > 0 ? options_.cpus : cluster_.cpus;
  const Result<std::int64_t> job = commands_.submit(order);
  if (job) {
    last_answer_ = std::chrono::steady_clock::now();
    return book_.set_job(submission, *job);
  }
  if (job.error().kind == ErrorKind::kInput) {
    // Nothing of it can have begun; it is planned anew when that is mended.
    std::error_code ignored;
    std::filesystem::remove_all(submission.files.root(), ignored);
    return fail(ErrorKind::kInput, "Slurm refuses the job: {}", job.error().message);
  }
  ++submission.tries;
  submission.next_try = std::chrono::steady_clock::now() + wait_after(submission.tries);
  if (submission.tries == kTriesToTell) {
    stage_.note("sbatch has failed and is tried again: " + job.error().message);
  }
  return bear(job.error());
}

}  // namespace seedframe
