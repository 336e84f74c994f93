#include "slurm/collector.h"

#include <algorithm>

#include "base/files.h"
#include "frames/manifest.h"
#include "slurm/cluster_state.h"

namespace seedframe {
namespace fs = std::filesystem;

Status Collector::load_nodes() {
  Result<std::vector<std::string>> nodes = read_nodes(files_);
  if (!nodes) return forward_error(nodes);
  nodes_ = std::move(*nodes);
  return {};
}

Result<int> Collector::number_of(const std::string& node) {
  const auto found = std::find(nodes_.begin(), nodes_.end(), node);
  const auto number = static_cast<int>(found - nodes_.begin());
  if (found != nodes_.end()) return number;
  nodes_.push_back(node);
  if (Status written = write_file_atomically(files_.nodes(), readable_json(Json(nodes_)));
      !written) {
    return forward_error(written);
  }
  return number;
}

Result<std::int64_t> Collector::collect(const fs::path& results, TaskTimes& times) {
  std::int64_t count = 0;
  std::error_code gone;
  std::vector<fs::path> records;
  for (const fs::directory_entry& entry : fs::directory_iterator(results, gone)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".json") || name == batch_files::kEnd) continue;
    records.push_back(entry.path());
  }
  std::sort(records.begin(), records.end());
  for (const fs::path& path : records) {
    // By its name in the batch, whether that is closed or not.
    const fs::path known = results.parent_path() / results.stem() / path.filename();
    if (!seen_.insert(known).second) continue;
    const Result<std::string> text = read_file(path);
    if (!text) return forward_error(text);
    const Json json = Json::parse(*text, nullptr, false);
    Result<TaskFrame> record = task_frame_from_json(json, path.string());
    if (!record) {
      stage_.note(record.error().message + "; it is not looked at");
      continue;
    }
    ++count;
    const auto attempts = static_cast<int>(record->attempts.size());
    const auto taken = ledger_.take(record->frame, attempts);
    if (!taken) continue;  // somebody else was first
    times.add_startup(record->startup_s);
    const AttemptRow& last = record->attempts.back();
    const bool rendered = last.render_s > 0.0;
    times.add_frame(rendered ? last.build_s + last.render_s : last.finish_s, record->workers);
    const Result<int> node = number_of(record->node);
    if (!node) return forward_error(node);
    for (AttemptRow& attempt : record->attempts) {
      if (attempt.worker != kNoWorker) attempt.worker += *node * kNodeWorkers;
      if (attempt.provenance.empty()) continue;
      const Result<std::string> noted = provenance_.of_record(attempt.provenance);
      if (!noted) return forward_error(noted);
    }
    stage_.push([this, found = Found{std::move(*record), results, taken->first_attempt,
                                     taken->frame_id}] { settle(found); });
  }
  return count;
}

std::string Collector::refusal(const Found& found) const {
  const TaskFrame& record = found.record;
  if (record.frame_id != found.frame_id) {
    return fmt::format(
        "node {} makes another frame of it: its assets, its config's files or its Seedframe are "
        "not those of the head",
        record.node);
  }
  const Json provenance = Json::parse(record.attempts.back().provenance, nullptr, false);
  const std::string ocio =
      provenance.is_object() ? provenance.value("ocio_config_sha256", "") : std::string();
  if (record.state == FrameState::kDone && ocio != ocio_hash_) {
    return fmt::format(
        "node {} works with another OpenColorIO config than the head, so that its colours are "
        "others: set image.ocio_config to a file that all nodes have",
        record.node);
  }
  return {};
}

void Collector::settle(const Found& found) {
  const TaskFrame& record = found.record;
  move_evidence(found);
  for (std::size_t i = 0; i < record.attempts.size(); ++i) {
    const AttemptRow& attempt = record.attempts[i];
    const FrameJob job{record.frame, found.first_attempt + static_cast<int>(i)};
    stage_.begin(job, attempt.worker, attempt.provenance, attempt.started);
    const Failure failure =
        attempt.outcome == AttemptOutcome::kCrash ? Failure::kCrash : Failure::kAnswered;
    if (i + 1 < record.attempts.size()) {
      stage_.fail(job, {failure, Consequence::kRetry, attempt.message, {}});
      continue;
    }
    if (record.state != FrameState::kDone) {
      end_attempt(job, {failure,
                        record.state == FrameState::kFailed ? Consequence::kFailed
                                                            : Consequence::kQuarantined,
                        attempt.message,
                        {}});
      continue;
    }
    Manifest manifest;
    std::string wrong = refusal(found);
    if (wrong.empty()) {
      const Status moved = move_frame(found, job, manifest);
      const bool ours = !moved && moved.error().kind != ErrorKind::kCorrupt;
      if (ours) return stage_.end(moved.error());
      if (!moved) wrong = moved.error().message;
    }
    if (!wrong.empty()) {
      end_attempt(job, {Failure::kBadFile, ledger_.refuse(record.frame), wrong, {}});
      continue;
    }
    stage_.commit({job,
                   manifest.pixel_hash(),
                   manifest.twin,
                   {attempt.build_s, attempt.render_s, attempt.finish_s}});
  }
}

Status Collector::move_frame(const Found& found, const FrameJob& job, Manifest& manifest) const {
  const fs::path from = found.results / batch_files::frame(job.frame);
  Result<Manifest> whole = verify_frame(from, found.frame_id, VerifyDepth::kContents);
  if (!whole) return tl::unexpected(Error{ErrorKind::kCorrupt, whole.error().message});
  manifest = std::move(*whole);
  return replace_folder(from, files_.attempt(job.frame, job.attempt));
}

void Collector::move_evidence(const Found& found) const {
  const TaskFrame& record = found.record;
  std::error_code ignored;
  const fs::path rejected = found.results / batch_files::rejected(record.frame);
  if (fs::exists(rejected, ignored)) {
    (void)make_folders_in(files_.root(), files_.rejected(record.frame).parent_path());
    (void)replace_folder(rejected, files_.rejected(record.frame));
  }
  for (std::size_t i = 0; i < record.attempts.size(); ++i) {
    const int here = found.first_attempt + static_cast<int>(i);
    fs::rename(found.results / batch_files::log(record.frame, record.attempts[i].attempt),
               files_.crash_log(record.frame, here), ignored);
  }
}

void Collector::fail(std::int64_t frame, const FrameLedger::Lost& lost,
                     const std::string& message) {
  const FrameJob job{frame, lost.attempt};
  stage_.begin(job, kNoWorker, {});
  end_attempt(job, {Failure::kCrash, lost.consequence, message, {}});
}

void Collector::end_attempt(const FrameJob& job, AttemptFailure failure) {
  {
    const std::lock_guard lock(mutex_);
    failing_[job] = failure.consequence;
  }
  stage_.fail(job, std::move(failure));
}

void Collector::frame_written(const FrameJob& job) { ledger_.settle_done(job.frame); }

void Collector::failure_written(const FrameJob& job) {
  std::map<FrameJob, Consequence>::node_type failed;
  {
    const std::lock_guard lock(mutex_);
    failed = failing_.extract(job);
  }
  if (failed) ledger_.settle_failed(job.frame, failed.mapped());
}

}  // namespace seedframe
