#include "slurm/task_book.h"

#include <algorithm>
#include <random>

#include <fmt/format.h>

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

std::string random_token() {
  std::random_device device;  // names jobs; no frame depends on it
  return fmt::format("{:08x}{:08x}", device(), device());
}

std::string in_quotes(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + "'";
}

/// What Slurm starts for each task.
std::string script_text(const SubmissionFiles& files) {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  return fmt::format(
      "#!/bin/sh\n# One task of an array: makes the frames of its batch (docs/cluster.md).\n"
      "echo \"$SLURMD_NODENAME\" >{}/\"$SLURM_ARRAY_TASK_ID\".node\n"
      "exec {} run-batch {} \"$SLURM_ARRAY_TASK_ID\"\n",
      in_quotes(files.claims().string()), in_quotes(program.string()),
      in_quotes(files.root().string()));
}

/// "1234" of the task "1234_17".
std::optional<std::int64_t> job_of_task(const std::string& task) {
  return read_job_id(task.substr(0, task.find('_')));
}

}  // namespace

bool HeadSubmission::all_closed() const {
  return std::all_of(batches.begin(), batches.end(),
                     [](const HeadBatch& batch) { return batch.closed; });
}

bool HeadSubmission::owns(const QueuedTask& task) const {
  return job == task.job &&
         (task.comment == comment() || task.comment.empty() || task.comment == "(null)");
}

Result<std::unique_ptr<HeadSubmission>> TaskBook::load_one(const fs::path& folder) const {
  auto loaded = std::make_unique<HeadSubmission>();
  loaded->files = SubmissionFiles(folder);
  loaded->number = std::stoi(folder.filename().string());
  Result<Submission> submission = read_submission(loaded->files);
  if (!submission) return forward_error(submission);
  loaded->token = submission->token;
  for (std::size_t i = 0; i < submission->batches.size(); ++i) {
    const int index = static_cast<int>(i);
    HeadBatch batch{std::move(submission->batches[i])};
    batch.closed = is_closed(loaded->files, index);
    if (!batch.closed) loaded->order.indices.push_back(index);
    loaded->batches.push_back(std::move(batch));
  }
  const Result<std::string> job = read_file(loaded->files.job());
  if (job) loaded->job = read_job_id(*job);
  loaded->order.comment = loaded->comment();
  loaded->order.script = loaded->files.script();
  loaded->order.logs = files_.slurm_logs();
  loaded->order.name = files_.root().filename().string();
  loaded->asked = true;  // perhaps: the queue tells
  return loaded;
}

Status TaskBook::load(std::vector<std::string>& notes) {
  std::error_code missing;
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(files_.slurm(), missing)) {
    const std::string name = entry.path().filename().string();
    const bool numbered = name.find_first_not_of("0123456789") == std::string::npos;
    if (numbered && name.size() < 9) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  for (const fs::path& folder : folders) {
    last_number_ = std::max(last_number_, std::stoi(folder.filename().string()));
    if (!fs::exists(SubmissionFiles(folder).submission(), missing)) {
      fs::remove_all(folder, missing);  // no intent yet: nothing was submitted
      continue;
    }
    Result<std::unique_ptr<HeadSubmission>> loaded = load_one(folder);
    if (loaded) {
      submissions_.push_back(std::move(*loaded));
    } else {
      notes.push_back(loaded.error().message + "; what it submitted is left alone");
    }
  }
  return {};
}

Result<HeadSubmission*> TaskBook::create(Submission prototype, ArrayOrder order,
                                         FrameLedger& ledger) {
  auto made = std::make_unique<HeadSubmission>();
  made->number = ++last_number_;
  std::error_code ignored;
  made->files =
      SubmissionFiles(fs::absolute(files_.slurm(), ignored) / fmt::format("{:04}", made->number));
  made->token = random_token();
  prototype.token = made->token;
  for (const fs::path& folder :
       {files_.slurm(), files_.slurm_logs(), made->files.root(), made->files.claims()}) {
    if (Status ready = make_folders_in(files_.root(), folder); !ready) return forward_error(ready);
  }
  Status written = write_file_atomically(made->files.script(), script_text(made->files));
  if (written) {
    written = write_file_atomically(made->files.submission(), canonical_json(to_json(prototype)));
  }
  if (!written) return forward_error(written);
  order.comment = made->comment();
  order.script = made->files.script();
  order.logs = fs::absolute(files_.slurm_logs(), ignored);
  for (std::size_t i = 0; i < prototype.batches.size(); ++i) {
    const int index = static_cast<int>(i);
    order.indices.push_back(index);
    for (const std::int64_t frame : prototype.batches[i]) {
      ledger.give_out(frame, {made->number, index});
    }
    made->batches.push_back({std::move(prototype.batches[i])});
  }
  made->order = std::move(order);
  submissions_.push_back(std::move(made));
  return submissions_.back().get();
}

std::int64_t TaskBook::open_batches() const {
  std::int64_t open = 0;
  for (const auto& submission : submissions_) {
    open += std::count_if(submission->batches.begin(), submission->batches.end(),
                          [](const HeadBatch& batch) { return !batch.closed; });
  }
  return open;
}

void TaskBook::look_for_claims() {
  for (const auto& submission : submissions_) {
    std::set<std::string> claims;
    std::error_code missing;
    for (const auto& entry : fs::directory_iterator(submission->files.claims(), missing)) {
      claims.insert(entry.path().filename().string());
    }
    for (std::size_t i = 0; i < submission->batches.size(); ++i) {
      HeadBatch& batch = submission->batches[i];
      if (batch.claimed || !claims.contains(std::to_string(i))) continue;
      batch.claimed = true;
      const auto claim = read_claim(submission->files, static_cast<int>(i));
      if (claim && !claim->node.empty()) batch.node = claim->node;
    }
  }
}

Status TaskBook::set_job(HeadSubmission& submission, std::int64_t job) {
  submission.job = job;
  return write_file_atomically(submission.files.job(), std::to_string(job) + "\n");
}

Status TaskBook::find_jobs(const std::vector<QueuedTask>& queue) {
  std::map<std::string, std::int64_t> jobs;
  for (const QueuedTask& task : queue) jobs.emplace(task.comment, task.job);
  for (const auto& submission : submissions_) {
    submission->queued = std::any_of(
        queue.begin(), queue.end(), [&](const QueuedTask& task) { return submission->owns(task); });
    if (submission->job) continue;
    const auto found = jobs.find(submission->comment());
    std::optional<std::int64_t> job;
    if (found != jobs.end()) job = found->second;
    submission->queued = job.has_value();
    // Looked at after the queue: a job that has begun and ended before that is in neither
    // otherwise.
    for (std::size_t i = 0; !job && i < submission->batches.size(); ++i) {
      const auto claim = read_claim(submission->files, static_cast<int>(i));
      if (claim && !claim->by_head) job = job_of_task(claim->task);
    }
    submission->asked = false;
    if (!job) continue;
    if (Status set = set_job(*submission, *job); !set) return set;
  }
  return {};
}

void TaskBook::remove_closed(bool tidy) {
  std::error_code ignored;
  std::erase_if(submissions_, [&](const std::unique_ptr<HeadSubmission>& submission) {
    if (!submission->all_closed()) return false;
    fs::remove_all(submission->files.root(), ignored);
    return true;
  });
  if (tidy && submissions_.empty()) fs::remove_all(files_.slurm(), ignored);
}

}  // namespace seedframe
