// What has become of tasks: told by their records, never by Slurm's word alone.

#include <algorithm>
#include <thread>

#include <fmt/ranges.h>

#include "base/files.h"
#include "slurm/slurm_run.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// The queue is looked at so often before a task that it does not list counts as ended.
constexpr int kLooksToBeAbsent = 2;
constexpr int kMostBarrenLooks = 5;
constexpr int kMostBadEnds = 2;

}  // namespace

Status SlurmRun::judge(const std::vector<QueuedTask>& queue) {
  std::map<std::pair<std::int64_t, int>, const QueuedTask*> tasks;
  for (const QueuedTask& task : queue) tasks[{task.job, task.index}] = &task;
  for (const auto& submission : book_.submissions()) {
    if (!submission->job) continue;
    for (std::size_t i = 0; i < submission->batches.size(); ++i) {
      if (submission->batches[i].closed) continue;
      const int index = static_cast<int>(i);
      const auto task = tasks.find({*submission->job, index});
      const bool listed = task != tasks.end() && submission->owns(*task->second);
      Status judged = judge_batch(*submission, index, listed ? task->second : nullptr);
      if (!judged) return judged;
    }
  }
  if (barren_) ++barren_looks_;
  book_.remove_closed(/*tidy=*/false);
  return leave_out_bad_nodes();
}

Status SlurmRun::judge_batch(HeadSubmission& submission, int index, const QueuedTask* task) {
  HeadBatch& batch = submission.batches[static_cast<std::size_t>(index)];
  const bool put_back = task != nullptr && task->waits && batch.claimed;
  if (task != nullptr && !put_back) {
    batch.looks_absent = 0;
    if (!task->node.empty()) batch.node = task->node;
    return {};
  }
  // Its first start was its only one: another task makes what is left, and waits for nobody.
  if (put_back) (void)commands_.cancel_task(*submission.job, index);
  if (++batch.looks_absent < kLooksToBeAbsent) return {};
  return close(submission, index);
}

Status SlurmRun::close(HeadSubmission& submission, int index) {
  HeadBatch& batch = submission.batches[static_cast<std::size_t>(index)];
  const SubmissionFiles& files = submission.files;
  if (!batch.claimed) {
    const auto claim = claim_batch(files, index, {.by_head = true});
    if (!claim) return forward_error(claim);
    batch.claimed = *claim == ClaimOutcome::kTaken;
    if (batch.claimed) return {};  // it has begun after all, after the last look
  }
  while (ledger_.any_settling() && !ended_) {  // what is being moved out of the folder
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (Status closed = close_batch(files, index); !closed) return closed;
  batch.closed = true;
  const auto taken = collector_.collect(files.closed_results(index), times_);
  if (!taken) return forward_error(taken);
  while (ledger_.any_settling() && !ended_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  TaskEnd end;
  const Result<std::string> text = read_file(files.closed_results(index) / batch_files::kEnd);
  if (text) end = task_end_from_json(Json::parse(*text, nullptr, false));
  const std::vector<std::int64_t> left = ledger_.out_with({submission.number, index}, batch.frames);
  const bool nobodys_fault = !batch.claimed || end.stopped || !end.error.message.empty();
  for (const std::int64_t frame : left) {
    if (nobodys_fault) {
      ledger_.give_back(frame);
      continue;
    }
    any_lost_ = true;
    const FrameLedger::Lost lost = ledger_.lose(frame, left.size() == 1);
    if (lost.consequence == Consequence::kRetry) continue;
    collector_.fail(frame, lost,
                    fmt::format("its tasks end without a word, the last one on node {}: the node "
                                "was lost, or Slurm ended it for the memory or time that it "
                                "took{}",
                                batch.node, last_words(submission, index)));
  }
  if (const auto node = read_file(files.node(index)); batch.node.empty() && node) {
    batch.node = node->substr(0, node->find('\n'));  // it was over before the queue told us
  }
  const bool made_some = *taken > 0 || left.size() < batch.frames.size();
  if (!made_some && !left.empty()) blame(submission, index, end);
  return {};
}

Status SlurmRun::close_unstarted(HeadSubmission& submission) {
  for (std::size_t i = 0; i < submission.batches.size(); ++i) {
    if (submission.batches[i].closed) continue;
    if (Status closed = close(submission, static_cast<int>(i)); !closed) return closed;
  }
  return {};
}

void SlurmRun::blame(const HeadSubmission& submission, int index, const TaskEnd& end) {
  if (end.stopped || drains_ > 0) return;
  barren_ = true;
  const HeadBatch& batch = submission.batches[static_cast<std::size_t>(index)];
  const std::string words = last_words(submission, index);
  if (!end.error.message.empty()) {
    last_error_ = fmt::format("on node {}: {}", batch.node, end.error.message);
  } else if (!words.empty()) {
    last_error_ = fmt::format("on node {}{}", batch.node, words);
  } else {
    last_error_ = "they leave the queue before they begin, as if somebody cancelled them";
  }
  const bool begun = batch.claimed || !words.empty();
  if (begun && !batch.node.empty()) ++bad_ends_[batch.node];
}

Status SlurmRun::leave_out_bad_nodes() {
  for (const auto& [node, ends] : bad_ends_) {
    if (ends < kMostBadEnds || left_out_.contains(node)) continue;
    if (static_cast<int>(left_out_.size()) + 1 >= cluster_.nodes) continue;  // none would be left
    left_out_.insert(node);
    stage_.note(
        fmt::format("node {} is left out from now on: {} tasks in a row have made nothing "
                    "there. {}",
                    node, ends, last_error_));
    const std::vector<std::string> all(left_out_.begin(), left_out_.end());
    for (const auto& submission : book_.submissions()) {
      // Where Slurm does not allow that, tasks still go there, and others make their frames.
      if (submission->queued) (void)commands_.exclude(*submission->job, all);
    }
  }
  return {};
}

Status SlurmRun::check_hope() const {
  if (barren_looks_ < kMostBarrenLooks) return {};
  return fail(
      ErrorKind::kEnvironment,
      "tasks end without having made anything, {} times in a row: {}. What they print is in "
      "{}",
      barren_looks_, last_error_, campaign_.files.slurm_logs().string());
}

std::string SlurmRun::last_words(const HeadSubmission& submission, int index) const {
  if (!submission.job) return {};
  const fs::path log =
      campaign_.files.slurm_logs() / fmt::format("{}_{}.log", *submission.job, index);
  const Result<std::string> text = read_file(log);
  if (!text || text->empty()) return {};
  constexpr std::size_t kMost = 400;
  std::string words = text->substr(text->size() - std::min(text->size(), kMost));
  while (!words.empty() && words.back() == '\n') words.pop_back();
  return fmt::format(" ({}: {})", log.string(), words);
}

}  // namespace seedframe
