#include "campaign/render_run.h"

#include "base/clock.h"
#include "base/files.h"
#include "campaign/color_config.h"
#include "campaign/disk_space.h"
#include "frames/frame_link.h"
#include "image_files/image_writer.h"
#include "render/sandbox.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

// Finishing a frame takes a small share of rendering it.
constexpr int kFinishThreads = 2;

/// What no worker needs, and none gets: so that a mad one takes neither memory nor disk from the
/// others.
ResourceLimits worker_limits(const PoolOptions& options) {
  constexpr std::uint64_t kMostFrames = 10'000;  // of a worker that is never worn out
  constexpr std::uint64_t kLargestFile = 16ULL << 30;
  constexpr std::uint64_t kOpenFiles = 4096;
  const std::uint64_t frames = options.frames_per_worker > 0
                                   ? static_cast<std::uint64_t>(options.frames_per_worker)
                                   : kMostFrames;
  const auto frame_s = static_cast<std::uint64_t>(options.frame_timeout.count() / 1000 + 1);
  return {.memory_bytes = static_cast<std::uint64_t>(system_memory_bytes()),
          .cpu_s = (frames + 1) * frame_s * static_cast<std::uint64_t>(options.worker.threads),
          .file_bytes = kLargestFile,
          .open_files = kOpenFiles};
}

/// With what only the campaign's folder says.
WorkerOptions worker_options(const RunOptions& options, const CampaignFiles& files) {
  WorkerOptions worker = options.pool.worker;
  worker.log_path = [files](int number) { return files.worker_log(number); };
  worker.limits = worker_limits(options.pool);
  if (options.sandbox) worker.wrapper = sandbox_arguments(files.work());
  // A killed Blender leaves its temporary folder behind; here it goes with the rest of work/.
  std::error_code ignored;
  worker.environment.emplace("TMPDIR", fs::absolute(files.work(), ignored).string());
  return worker;
}

}  // namespace

Result<ColorManagement> load_color_management(const CampaignSettings& settings,
                                              const BlenderInfo& blender) {
  Result<fs::path> path = settings.ocio_config
                              ? Result<fs::path>(*settings.ocio_config)
                              : find_ocio_config(blender.program, blender.major, blender.minor);
  if (!path) return forward_error(path);
  Result<ColorManagement> color = ColorManagement::load(*path);
  if (!color) return color;
  if (Status known = color->check(settings.image); !known) {
    return fail(ErrorKind::kInput, "{}: {}",
                settings.image_place.file.empty() ? "image" : settings.image_place.text(),
                known.error().message);
  }
  if (Status possible = check_encoding(settings.image_encoding); !possible) {
    return forward_error(possible);
  }
  return color;
}

RenderRun::RenderRun(Campaign& campaign, PreparedCampaign& prepared, Provenance& provenance,
                     const RunSetup& setup, RunObserver& observer)
    : campaign_(campaign),
      prepared_(prepared),
      color_(setup.color),
      provenance_(provenance),
      observer_(observer),
      room_needed_(room_for_attempts(setup)),
      cache_(FrameCache::open(setup.cache)),
      take_from_cache_(!setup.options.no_cache),
      finisher_(prepared.settings.categories, prepared.settings.twin_check,
                1,  // the cores are the workers'
                prepared.settings.image_encoding),
      writer_(std::make_unique<StoreWriter>(
          campaign.files, campaign.store,
          [this](const StoreEvent& event, const Status& status) { written(event, status); })),
      queue_(std::make_unique<FinishQueue>(kFinishThreads)),
      executor_(worker_options(setup.options, campaign.files)),
      pool_(std::make_unique<WorkerPool>(setup.options.pool, executor_, *this)) {}

RenderRun::~RenderRun() {
  queue_.reset();
  writer_.reset();
}

Result<RunSummary> RenderRun::run(const std::vector<PendingFrame>& frames) {
  for (const fs::path& folder : {campaign_.files.logs(), campaign_.files.work() / "meshes",
                                 campaign_.files.work() / "attempts", campaign_.files.frames()}) {
    if (Status made = make_folders(folder); !made) return forward_error(made);
  }
  queue_->push([this] { load_view_tables(); });
  Result<RunSummary> summary = pool_->run(frames);
  queue_.reset();   // waits for what is being finished
  writer_.reset();  // and what is being written
  std::error_code ignored;
  fs::remove_all(campaign_.files.work(), ignored);
  if (!error_) return forward_error(error_);
  if (summary) summary->from_cache = from_cache_;
  return summary;
}

Result<std::optional<RenderRequest>> RenderRun::request(const FrameJob& job) {
  const Result<std::uint64_t> room = free_bytes(campaign_.files.root());
  if (room && *room < room_needed_) {
    if (Status disk = check_disk(campaign_.files, room_needed_); !disk) return forward_error(disk);
  }
  Result<ExpandedFrame> expanded = prepared_.expander.expand(job.frame);
  if (!expanded) return forward_error(expanded);
  const fs::path attempt = campaign_.files.attempt(job.frame, job.attempt);
  if (Status made = make_folders(attempt); !made) return forward_error(made);
  if (take_from_cache(job, expanded->id, attempt)) return std::nullopt;
  RenderRequest request;
  request.spec = canonical_text(expanded->spec);
  request.frame_id = expanded->id;
  std::error_code ignored;
  request.output = fs::absolute(rendered_passes(attempt), ignored);
  auto meshes = write_mesh_buffers(expanded->meshes);
  if (!meshes) return forward_error(meshes);
  request.meshes = std::move(*meshes);
  const auto add_image = [&](const std::string& sha256) {
    request.textures[sha256] = fs::absolute(expanded->used.images.at(sha256)->path, ignored);
  };
  for (const MaterialSpec& material : expanded->spec.materials) {
    for (const auto& texture : material.textures) add_image(texture.second);
  }
  if (!expanded->spec.world.hdri.empty()) add_image(expanded->spec.world.hdri);
  tasks_[job] = {std::move(expanded->spec), std::move(expanded->id), std::move(expanded->meshes),
                 attempt, campaign_.files.rejected(job.frame)};
  return request;
}

bool RenderRun::take_from_cache(const FrameJob& job, const std::string& frame_id,
                                const fs::path& attempt) {
  if (!cache_ || !take_from_cache_ || cache_key_.empty()) return false;
  const auto start = std::chrono::steady_clock::now();
  const std::optional<fs::path> found = cache_->find(frame_id, cache_key_);
  if (!found) return false;
  const Result<Manifest> manifest = link_frame(*found, frame_id, attempt);
  if (!manifest) {
    cache_->forget(frame_id, cache_key_);
    return false;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  ++from_cache_;
  writer_->push(AttemptStarted{job, kNoWorker, unix_time(), made_with_});
  writer_->push(
      FrameFinished{job, manifest->pixel_hash(), manifest->twin, {0.0, 0.0, seconds.count()}});
  return true;
}

void RenderRun::add_to_cache(const FrameJob& job) {
  if (!cache_ || !same_workers_) return;
  const auto row = campaign_.store.frame(job.frame);
  if (!row || !*row) return;
  std::error_code ignored;
  cache_->add((*row)->frame_id, cache_key_,
              fs::absolute(campaign_.files.frame(job.frame), ignored));
}

Result<std::map<std::string, fs::path>> RenderRun::write_mesh_buffers(const MeshBuffers& meshes) {
  std::map<std::string, fs::path> paths;
  std::error_code error;
  for (const auto& [sha256, buffer] : meshes) {
    const fs::path path = campaign_.files.mesh_buffer(sha256);
    if (!fs::exists(path, error)) {
      // Scratch: nobody reads it after a crash.
      if (Status written = write_file_unsynced(path, *buffer); !written) {
        return forward_error(written);
      }
    }
    paths[sha256] = fs::absolute(path, error);
  }
  return paths;
}

void RenderRun::started(const FrameJob& job, int worker) {
  writer_->push(AttemptStarted{job, worker, unix_time(), provenance_of_worker_[worker]});
}

void RenderRun::rendered(const FrameJob& job, const RenderTimings& timings, int) {
  const auto task = tasks_.find(job);
  queue_->push(
      [this, job, timings, task = std::move(task->second)] { finish(job, timings, task); });
  tasks_.erase(task);
}

void RenderRun::load_view_tables() {
  // An error comes again with the first frame.
  (void)color_->apply(Image<float>(1, 1, 4), prepared_.settings.image);
}

void RenderRun::finish(const FrameJob& job, const RenderTimings& timings, const FinishTask& task) {
  const auto start = std::chrono::steady_clock::now();
  const Result<FinishedFrame> finished = finisher_.finish(task, *color_);
  const std::chrono::duration<double> finish_time = std::chrono::steady_clock::now() - start;
  if (!finished) {
    pool_->post_verdict(job, forward_error(finished));
    return;
  }
  writer_->push(FrameFinished{job,
                              finished->pixel_hash,
                              finished->twin,
                              {timings.build_s, timings.render_s, finish_time.count()}});
}

Status RenderRun::check_system() { return check_disk(campaign_.files, room_needed_); }

void RenderRun::attempt_failed(const FrameJob& job, const AttemptFailure& failure) {
  tasks_.erase(job);
  std::error_code ignored;
  fs::remove_all(campaign_.files.attempt(job.frame, job.attempt), ignored);
  AttemptFailure told = failure;
  if (failure.failure == Failure::kCrash) {
    keep_crash_log(job, failure);
    told.message += fmt::format("\nits last words are in {}",
                                campaign_.files.crash_log(job.frame, job.attempt).string());
  }
  writer_->push(AttemptFailed{job, std::move(told)});
}

void RenderRun::keep_crash_log(const FrameJob& job, const AttemptFailure& failure) const {
  // That it cannot be written must not stop a run: the message says the most important.
  (void)write_file_unsynced(
      campaign_.files.crash_log(job.frame, job.attempt),
      fmt::format("frame {}, attempt {}: {}\nsee it again: {}\n\n{}\n", job.frame, job.attempt,
                  failure.message.substr(0, failure.message.find('\n')),
                  command_to_reproduce(campaign_.files.root(), job.frame), failure.log));
}

void RenderRun::written(const StoreEvent& event, const Status& status) {
  keep_error(status);
  if (const auto* finished = std::get_if<FrameFinished>(&event)) {
    if (status) {
      observer_.frame_done(finished->job.frame);
      add_to_cache(finished->job);
    }
    pool_->post_verdict(finished->job, {});
  }
  if (const auto* failed = std::get_if<AttemptFailed>(&event)) {
    observer_.attempt_failed(failed->job, failed->failure);
  }
}

void RenderRun::worker_ready(int worker, const ReadyMessage& ready) {
  Result<std::string> text = provenance_.of_worker(ready);
  if (!text) return keep_error(forward_error(text));
  const std::string departure = provenance_.departure(*text);
  if (!departure.empty() && !std::exchange(departure_noted_, true)) observer_.noted(departure);
  if (cache_ && cache_key_.empty()) {
    made_with_ = *text;
    cache_key_ = cache_key(Json::parse(*text), prepared_.settings);
  }
  if (*text != made_with_) same_workers_ = false;
  provenance_of_worker_[worker] = std::move(*text);
}

void RenderRun::keep_error(const Status& status) {
  if (status) return;
  {
    const std::lock_guard lock(mutex_);
    if (error_) error_ = status;
  }
  pool_->drain();
}

}  // namespace seedframe
