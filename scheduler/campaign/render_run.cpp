#include "campaign/render_run.h"

#include <tbb/parallel_for.h>

#include "base/files.h"
#include "campaign/worker_requests.h"
#include "frames/rendered_frame.h"
#include "frames/take_rendered.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

// Finishing a frame takes a small share of rendering it.
constexpr int kFinishThreads = 2;

WorkerOptions options_for_workers(const RunOptions& options, const CampaignFiles& files) {
  return worker_options(options, files.workers(),
                        [files](int number) { return files.worker_log(number); });
}

}  // namespace

RenderRun::RenderRun(Campaign& campaign, const PreparedCampaign& prepared, Provenance& provenance,
                     const RunSetup& setup, RunObserver& observer)
    : campaign_(campaign),
      prepared_(prepared),
      provenance_(provenance),
      color_(setup.color),
      meshes_(setup.options.meshes.empty() ? campaign.files.meshes() : setup.options.meshes),
      room_needed_(room_for_attempts(setup)),
      cached_(setup.cache,
              setup.options.no_cache ? CachedFrames::Use::kAdd : CachedFrames::Use::kTakeAndAdd,
              prepared.settings, provenance.common(),
              options_for_workers(setup.options, campaign.files)),
      finisher_(prepared.settings.categories, prepared.settings.twin_check,
                1,  // the cores are the workers'
                prepared.settings.image_encoding),
      executor_(options_for_workers(setup.options, campaign.files)),
      stage_(campaign, observer, *this, kFinishThreads) {
  RenderClient& client = *this;
  for (std::unique_ptr<WorkerPool>& pool : pools_) {
    pool = std::make_unique<WorkerPool>(setup.options.pool, executor_, client);
  }
}

RenderRun::~RenderRun() = default;

void RenderRun::drain() {
  drained_ = true;
  for (const std::unique_ptr<WorkerPool>& pool : pools_) pool->drain();
}

void RenderRun::ends() { drain(); }

Result<RunSummary> RenderRun::run(const std::vector<PendingFrame>& frames) {
  const Result<FrameIds> found = find_in_cache(frames);
  if (!found) return forward_error(found);
  Result<RunSummary> summary = run_once(frames, *found);
  if (!cached_.was_mistaken() || taken_.empty()) return summary;
  const Result<std::vector<PendingFrame>> again = give_back();
  if (!again) return forward_error(again);
  if (!summary) return summary;
  pool_ = 1;
  Result<RunSummary> second = run_once(*again, {});
  if (!second) return second;
  summary->committed += second->committed - static_cast<std::int64_t>(again->size());
  summary->failed += second->failed;
  summary->quarantined += second->quarantined;
  summary->left += second->left;
  summary->worker_starts += second->worker_starts;
  summary->from_cache = second->from_cache;
  return summary;
}

Result<RunSummary> RenderRun::run_once(const std::vector<PendingFrame>& frames,
                                       const FrameIds& found) {
  for (const fs::path& folder :
       {campaign_.files.logs(), campaign_.files.meshes(), campaign_.files.workers()}) {
    if (Status made = make_folders_in(campaign_.files.root(), folder); !made)
      return forward_error(made);
  }
  if (Status opened = stage_.open(); !opened) return forward_error(opened);
  const std::vector<PendingFrame> rest = take_before_workers(frames, found);
  Result<RunSummary> summary = RunSummary{};
  if (!rest.empty()) {
    stage_.push([this] { load_view_tables(); });
    summary = pools_[pool_]->run(rest);
  }
  if (Status ended = stage_.close(); !ended) return forward_error(ended);
  if (!summary) return summary;
  summary->committed += static_cast<std::int64_t>(frames.size() - rest.size());
  summary->from_cache = from_cache_;
  return summary;
}

// ---- The cache ----

Result<RenderRun::FrameIds> RenderRun::find_in_cache(const std::vector<PendingFrame>& frames) {
  FrameIds found;
  const std::optional<ReadyMessage> expected = cached_.expected_worker();
  if (!expected) return found;
  cached_.expect(provenance_.text_of_worker(*expected));
  for (const PendingFrame& pending : frames) {
    const auto row = campaign_.store.frame(pending.frame);
    if (!row) return forward_error(row);
    if (*row && cached_.has((*row)->frame_id)) found[pending.frame] = (*row)->frame_id;
  }
  if (found.empty()) return found;
  const Result<std::string> made_with = provenance_.of_worker(*expected);
  if (!made_with) return forward_error(made_with);
  tell_departure(*made_with);
  return found;
}

std::vector<PendingFrame> RenderRun::take_before_workers(const std::vector<PendingFrame>& frames,
                                                         const FrameIds& found) {
  if (found.empty()) return frames;
  std::vector<char> taken(frames.size(), 0);
  tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t i) {
    const auto frame = found.find(frames[i].frame);
    if (frame == found.end() || drained_) return;
    const FrameJob job{frames[i].frame, frames[i].attempts_used + 1};
    const Result<bool> took = take(job, frame->second);
    if (!took) stage_.end(took.error());
    taken[i] = took && *took ? 1 : 0;
  });
  std::vector<PendingFrame> rest;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (taken[i] == 0) {
      rest.push_back(frames[i]);
    } else {
      taken_.push_back(frames[i].frame);
    }
  }
  return rest;
}

Result<bool> RenderRun::take(const FrameJob& job, const std::string& frame_id) {
  const auto start = std::chrono::steady_clock::now();
  const std::string made_with = cached_.made_with();
  if (!cached_.has(frame_id)) return false;
  if (Status room = look_for_room(); !room) return forward_error(room);
  const fs::path attempt = campaign_.files.attempt(job.frame, job.attempt);
  if (Status made = make_folders_in(campaign_.files.root(), attempt); !made)
    return forward_error(made);
  const std::optional<Manifest> manifest = cached_.take(frame_id, attempt);
  if (!manifest) return false;
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  ++from_cache_;
  begin(job, kNoWorker, {frame_id, made_with});
  stage_.commit({job, manifest->pixel_hash(), manifest->twin, {0.0, 0.0, seconds.count()}});
  return true;
}

Result<std::vector<PendingFrame>> RenderRun::give_back() {
  std::vector<PendingFrame> again;
  const Status reset = campaign_.store.write_together(JobStore::Sync::kNow, [&]() -> Status {
    for (const std::int64_t frame : taken_) {
      const auto row = campaign_.store.frame(frame);
      if (!row) return forward_error(row);
      if (Status done = campaign_.store.reset(frame); !done) return done;
      again.push_back({frame, (*row)->attempts, 0});
    }
    return {};
  });
  if (!reset) return forward_error(reset);
  from_cache_ -= static_cast<std::int64_t>(taken_.size());
  stage_.note(fmt::format(
      "{} frames that were found on this machine were made with something else than its workers "
      "now are, and are rendered",
      taken_.size()));
  taken_.clear();
  return again;
}

// ---- What the pool asks and tells ----

Status RenderRun::look_for_room() const { return check_room(campaign_.files.root(), room_needed_); }

Result<std::optional<RenderRequest>> RenderRun::request(const FrameJob& job) {
  if (Status room = look_for_room(); !room) return forward_error(room);
  Result<ExpandedFrame> expanded = prepared_.expander.expand(job.frame);
  if (!expanded) return forward_error(expanded);
  const Result<bool> taken = take(job, expanded->id);
  if (!taken) return forward_error(taken);
  if (*taken) return std::nullopt;
  const CampaignFiles& files = campaign_.files;
  const fs::path given = files.workers() / CampaignFiles::attempt_name(job.frame, job.attempt);
  if (Status made = make_folders_in(files.root(), given); !made) return forward_error(made);
  Result<RenderRequest> request =
      make_render_request(*expanded, rendered_passes(given),
                          [this](const auto& sha256) { return meshes_ / (sha256 + ".mesh"); });
  if (!request) return forward_error(request);
  tasks_[job] = {std::move(expanded->spec), std::move(expanded->id), std::move(expanded->meshes),
                 files.attempt(job.frame, job.attempt), files.rejected(job.frame)};
  return std::move(*request);
}

void RenderRun::begin(const FrameJob& job, int worker, Attempt attempt) {
  stage_.begin(job, worker, attempt.made_with);
  const std::lock_guard lock(mutex_);
  attempts_[job] = std::move(attempt);
}

RenderRun::Attempt RenderRun::ended(const FrameJob& job) {
  const std::lock_guard lock(mutex_);
  const auto attempt = attempts_.extract(job);
  return attempt ? std::move(attempt.mapped()) : Attempt();
}

void RenderRun::started(const FrameJob& job, int worker) {
  begin(job, worker, {tasks_.at(job).frame_id, provenance_of_worker_[worker]});
}

void RenderRun::rendered(const FrameJob& job, const RenderTimings& timings, int) {
  const auto task = tasks_.find(job);
  stage_.push([this, job, timings, task = std::move(task->second)] { finish(job, timings, task); });
  tasks_.erase(task);
}

void RenderRun::load_view_tables() {
  // An error comes again with the first frame.
  (void)color_->apply(Image<float>(1, 1, 4), prepared_.settings.image);
}

void RenderRun::finish(const FrameJob& job, const RenderTimings& timings, const FinishTask& task) {
  const auto start = std::chrono::steady_clock::now();
  const Status taken =
      take_rendered(campaign_.files.workers(), CampaignFiles::attempt_name(job.frame, job.attempt),
                    task.attempt_folder);
  const Result<FinishedFrame> finished =
      taken ? finisher_.finish(task, *color_) : forward_error(taken);
  const std::chrono::duration<double> finish_time = std::chrono::steady_clock::now() - start;
  if (!finished) {
    pools_[pool_]->post_verdict(job, forward_error(finished));
    return;
  }
  stage_.commit({job,
                 finished->pixel_hash,
                 finished->twin,
                 {timings.build_s, timings.render_s, finish_time.count()}});
}

Status RenderRun::check_system() { return check_disk(campaign_.files, room_needed_); }

void RenderRun::attempt_failed(const FrameJob& job, const AttemptFailure& failure) {
  tasks_.erase(job);
  ended(job);
  AttemptFailure told = failure;
  if (failure.failure == Failure::kCrash) {
    keep_crash_log(job, failure);
    told.message += fmt::format("\nits last words are in {}",
                                campaign_.files.crash_log(job.frame, job.attempt).string());
  }
  stage_.fail(job, std::move(told));
}

void RenderRun::keep_crash_log(const FrameJob& job, const AttemptFailure& failure) const {
  // That it cannot be written must not stop a run: the message says the most important.
  (void)write_file_unsynced(
      campaign_.files.crash_log(job.frame, job.attempt),
      fmt::format("frame {}, attempt {}: {}\nsee it again: {}\n\n{}\n", job.frame, job.attempt,
                  failure.message.substr(0, failure.message.find('\n')),
                  command_to_reproduce(campaign_.files.root(), job.frame), failure.log));
}

void RenderRun::worker_ready(int worker, const ReadyMessage& ready) {
  Result<std::string> made_with = provenance_.of_worker(ready);
  if (!made_with) return stage_.end(made_with.error());
  tell_departure(*made_with);
  cached_.worker_is_ready(ready, *made_with);
  provenance_of_worker_[worker] = std::move(*made_with);
}

void RenderRun::tell_departure(const std::string& made_with) {
  const std::string departure = provenance_.departure(made_with);
  if (!departure.empty() && !std::exchange(departure_told_, true)) stage_.note(departure);
}

// ---- What becomes of frames ----

void RenderRun::frame_written(const FrameJob& job, const Status& status) {
  const Attempt attempt = ended(job);
  if (status && !attempt.made_with.empty()) {
    cached_.add(attempt.frame_id, attempt.made_with, campaign_.files.frame(job.frame));
  }
  pools_[pool_]->post_verdict(job, {});
}

}  // namespace seedframe
