#include "stream/frame_maker.h"

#include <cmath>

#include <fmt/format.h>

#include "annotate/amodal.h"
#include "base/clock.h"
#include "base/files.h"
#include "campaign/worker_requests.h"
#include "draws/graphs.h"
#include "frames/rendered_frame.h"
#include "frames/take_rendered.h"
#include "image/color_management.h"
#include "image/pixel_hash.h"
#include "preview/display_curve.h"
#include "preview/twin_shading.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

tl::unexpected<Error> cancelled() { return fail(ErrorKind::kInput, "cancelled"); }

/// Nobody waits for it any longer.
Status still_wanted(const FrameOrder& order) {
  if (*order.cancelled) return cancelled();
  if (order.request.deadline_s > 0.0 && seconds_since(order.came) > order.request.deadline_s) {
    return fail(ErrorKind::kInput, "its deadline of {} s has passed", order.request.deadline_s);
  }
  return {};
}

}  // namespace

FrameMaker::FrameMaker(const PreparedCampaign& prepared, int threads, fs::path scratch,
                       SetUp set_up, FrameKeeper* keeper)
    : prepared_(prepared),
      scratch_(std::move(scratch)),
      set_up_(std::move(set_up)),
      keeper_(keeper),
      finisher_(prepared.settings.categories, prepared.settings.twin_check, 1,
                prepared.settings.image_encoding),
      queue_(std::make_unique<FinishQueue>(threads)) {}

FrameMaker::~FrameMaker() {
  for (const std::unique_ptr<Pool>& pool : pools_) {
    pool->workers->drain();
    pool->thread.join();
  }
  queue_.reset();
  if (keeper_ != nullptr) keeper_->wait();
}

void FrameMaker::make(FrameOrder order) {
  queue_->push([this, order = std::move(order)]() mutable { begin(std::move(order)); });
}

void FrameMaker::begin(FrameOrder order) {
  const auto begun = std::chrono::steady_clock::now();
  if (Status wanted = still_wanted(order); !wanted) return order.done(forward_error(wanted));
  Result<ExpandedFrame> frame = expand(order.request);
  if (!frame) return order.done(forward_error(frame));
  if (order.request.fidelity != Fidelity::kRender) {
    Result<MadeFrame> made = trace(order.request, *frame);
    if (made) made->made_s = seconds_since(begun);
    return order.done(std::move(made));
  }
  std::int64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    if (Status able = can_render(); !able) return order.done(forward_error(able));
    number = ++last_number_;
    renderings_[number] = std::make_shared<Rendering>(
        Rendering{.order = std::move(order), .frame = std::move(*frame), .begun = begun});
    pool_.load()->add({number});  // under the lock: the pool may be over by its end
  }
}

Result<ExpandedFrame> FrameMaker::expand(const FrameRequest& request) const {
  return prepared_.expander.expand_given(request.scene, request.values, request.rendering,
                                         "values");
}

Result<MadeFrame> FrameMaker::trace(const FrameRequest& request, const ExpandedFrame& frame) {
  MadeFrame made;
  made.frame_id = frame.id;
  made.width = frame.spec.render.width;
  made.height = frame.spec.render.height;
  Result<Twin> twin = tracer_.trace(frame.spec, frame.meshes, TwinTracer::Passes::kAsked);
  if (!twin) return forward_error(twin);
  made.pixel_hashes["index"] = pixel_hash(twin->instance_ids, "X");
  if (twin->depth) made.pixel_hashes["depth"] = pixel_hash(*twin->depth, "float", "Z");
  if (request.labels) {
    Result<FrameLabels> labels =
        make_labels(frame.spec, prepared_.settings.categories, twin->instance_ids);
    if (!labels) return forward_error(labels);
    add_amodal_labels(*labels, frame.spec, *twin, twin->instance_ids);
    made.labels = std::move(*labels);
  }
  if (request.depth) made.depth = std::move(twin->depth);
  if (request.ids) made.ids = std::move(twin->instance_ids);
  if (request.image) {
    if (Status shaded = shade(frame, made); !shaded) return forward_error(shaded);
  }
  return made;
}

Status FrameMaker::shade(const ExpandedFrame& frame, MadeFrame& made) {
  const Result<Shading> shading = shaded(frame.spec, frame, tracer_, images_);
  if (!shading) return forward_error(shading);
  const ImageSettings& settings = frame.spec.image;
  made.image = DisplayCurve(settings, std::exp2(settings.exposure_stops)).display(shading->light);
  return {};
}

// ---- Rendered frames ----

Status FrameMaker::can_render() {
  if (Status started = start_pool(); !started) return started;
  return keeper_ != nullptr ? keeper_->check_room() : Status();
}

Status FrameMaker::start_pool() {
  if (pool_ != nullptr && pool_state_) return {};
  // Room may come again. What else is missing does not, and is told to everyone who asks.
  if (!pool_state_ && pool_state_.error().kind != ErrorKind::kExhausted) return pool_state_;
  if (!setup_) {
    Status set_up = set_up_rendering();
    if (!set_up) return pool_state_ = set_up;
  } else if (keeper_ != nullptr) {
    if (Status disk = keeper_->check_disk(); !disk) return disk;
  }
  pool_state_ = {};
  begin_pool();
  return {};
}

Status FrameMaker::set_up_rendering() {
  Result<RunSetup> setup = set_up_();
  if (!setup) return forward_error(setup);
  if (keeper_ != nullptr) {
    if (Status begun = keeper_->begin(*setup); !begun) return begun;
  }
  setup->options.pool.stays = true;
  setup_ = std::move(*setup);
  return {};
}

void FrameMaker::begin_pool() {
  pools_.push_back(std::make_unique<Pool>());
  Pool& pool = *pools_.back();
  pool.executor =
      std::make_unique<LocalExecutor>(worker_options(setup_->options, scratch_, [this](int worker) {
        return keeper_ != nullptr ? keeper_->files().worker_log(worker)
                                  : scratch_ / fmt::format("worker-{}.log", worker);
      }));
  RenderClient& client = *this;
  pool.workers = std::make_unique<WorkerPool>(setup_->options.pool, *pool.executor, client);
  pool_ = pool.workers.get();
  pool.thread = std::jthread([this, workers = pool.workers.get()] {
    const Result<RunSummary> run = workers->run({});
    std::map<std::int64_t, std::shared_ptr<Rendering>> left;
    {
      const std::lock_guard lock(mutex_);
      pool_state_ = run ? fail(ErrorKind::kEnvironment, "the workers have ended")
                        : Status(forward_error(run));
      left.swap(renderings_);
    }
    for (const auto& [number, rendering] : left) {
      rendering->order.done(run ? Result<MadeFrame>(cancelled()) : forward_error(run));
    }
  });
}

fs::path FrameMaker::given_folder(const FrameJob& job) const {
  return scratch_ / CampaignFiles::attempt_name(job.frame, job.attempt);
}

fs::path FrameMaker::attempt_folder(const FrameJob& job) const {
  return keeper_ != nullptr ? keeper_->files().attempt(job.frame, job.attempt) : given_folder(job);
}

std::shared_ptr<FrameMaker::Rendering> FrameMaker::rendering_of(std::int64_t number) {
  const std::lock_guard lock(mutex_);
  const auto found = renderings_.find(number);
  return found == renderings_.end() ? nullptr : found->second;
}

void FrameMaker::answer(std::int64_t number, Result<MadeFrame> made) {
  std::map<std::int64_t, std::shared_ptr<Rendering>>::node_type over;
  {
    const std::lock_guard lock(mutex_);
    over = renderings_.extract(number);
  }
  if (over) over.mapped()->order.done(std::move(made));
}

Result<std::optional<RenderRequest>> FrameMaker::request(const FrameJob& job) {
  const std::shared_ptr<Rendering> rendering = rendering_of(job.frame);
  if (rendering == nullptr) return fail(ErrorKind::kInput, "it is over");
  Result<RenderRequest> request = prepare(job, *rendering);
  if (request) return std::move(*request);
  // Of this frame alone, whatever it is: the pool would end for a disk that is full.
  answer(job.frame, forward_error(request));
  return fail(ErrorKind::kInput, "it is over");
}

Result<RenderRequest> FrameMaker::prepare(const FrameJob& job, const Rendering& rendering) const {
  if (Status wanted = still_wanted(rendering.order); !wanted) return forward_error(wanted);
  if (Status made = make_folders_in(scratch_, given_folder(job)); !made) {
    return forward_error(made);
  }
  return make_render_request(
      rendering.frame, rendered_passes(given_folder(job)),
      [this](const std::string& sha256) { return scratch_ / (sha256 + ".mesh"); });
}

void FrameMaker::worker_ready(int worker, const ReadyMessage& ready) {
  const std::lock_guard lock(mutex_);
  ready_[worker] = ready;
}

void FrameMaker::started(const FrameJob& job, int worker) {
  const std::lock_guard lock(mutex_);
  const auto found = renderings_.find(job.frame);
  if (found == renderings_.end()) return;
  found->second->worker = worker;
  found->second->started = unix_time();
  found->second->made_by = ready_[worker];
}

void FrameMaker::rendered(const FrameJob& job, const RenderTimings& timings, int) {
  queue_->push([this, job, timings] { finish(job, timings); });
}

void FrameMaker::finish(const FrameJob& job, const RenderTimings& timings) {
  const std::shared_ptr<Rendering> rendering = rendering_of(job.frame);
  Status finished = rendering ? still_wanted(rendering->order) : cancelled();
  if (finished) finished = finish(job, timings, *rendering);
  if (!finished) settle(job, forward_error(finished));
}

Status FrameMaker::finish(const FrameJob& job, const RenderTimings& timings,
                          const Rendering& rendering) {
  const FrameRequest& request = rendering.order.request;
  const FrameSpec& spec = rendering.frame.spec;
  const FinishTask task{spec, rendering.frame.id, rendering.frame.meshes, attempt_folder(job),
                        fs::path()};
  if (keeper_ != nullptr) {
    Status taken =
        take_rendered(scratch_, given_folder(job).filename().string(), task.attempt_folder);
    if (!taken) return taken;
  }
  Result<DevelopedFrame> frame =
      finisher_.develop(task, *setup_->color, request.labels || keeper_ != nullptr);
  if (!frame) return forward_error(frame);
  Result<FinishedFrame> finished = FinishedFrame{};
  if (keeper_ != nullptr) finished = finisher_.write(task, *frame);
  if (!finished) return forward_error(finished);
  MadeFrame made;
  made.frame_id = task.frame_id;
  made.width = spec.render.width;
  made.height = spec.render.height;
  made.worker_s = timings.build_s + timings.render_s;
  made.pixel_hashes = frame->pixel_hashes();
  if (request.labels) made.labels = std::move(frame->labels);
  if (request.image) made.image = std::move(frame->image);
  if (request.depth) made.depth = std::move(frame->passes.depth);
  if (request.ids) made.ids = std::move(frame->passes.instance_ids);
  if (keeper_ == nullptr) {
    settle(job, std::move(made));
  } else {
    keep(job, timings, rendering, task, *finished, std::move(made));
  }
  return {};
}

void FrameMaker::keep(const FrameJob& job, const RenderTimings& timings, const Rendering& rendering,
                      const FinishTask& task, const FinishedFrame& finished, MadeFrame made) {
  const FrameRequest& request = rendering.order.request;
  FrameToKeep frame;
  frame.graph = graph_line(request.values, request.scene, request.rendering);
  frame.frame_id = task.frame_id;
  frame.used = rendering.frame.used;
  frame.attempt = task.attempt_folder;
  frame.finished = finished;
  frame.timings = {timings.build_s, timings.render_s,
                   std::max(0.0, unix_time() - rendering.started - made.worker_s)};
  frame.worker = rendering.worker;
  frame.started = rendering.started;
  frame.made_by = rendering.made_by;
  frame.failures = rendering.failures;
  frame.done = [this, job, made = std::make_shared<MadeFrame>(std::move(made))](
                   const Result<std::int64_t>& kept) {
    if (!kept) return settle(job, forward_error(kept));
    made->kept = *kept;
    settle(job, std::move(*made));
  };
  keeper_->keep(std::move(frame));
}

void FrameMaker::settle(const FrameJob& job, Result<MadeFrame> made) {
  std::error_code ignored;
  for (const fs::path& folder : {given_folder(job), attempt_folder(job)}) {
    fs::remove_all(folder, ignored);
  }
  if (!made && made.error().kind == ErrorKind::kRender) {
    pool_.load()->post_verdict(job, forward_error(made));  // tried again, or told by attempt_failed
    return;
  }
  const std::shared_ptr<Rendering> rendering = rendering_of(job.frame);
  if (made && rendering) made->made_s = seconds_since(rendering->begun);
  answer(job.frame, std::move(made));
  pool_.load()->post_verdict(job, {});
}

void FrameMaker::attempt_failed(const FrameJob& job, const AttemptFailure& failure) {
  std::error_code ignored;
  fs::remove_all(given_folder(job), ignored);
  if (failure.consequence == Consequence::kRetry) {
    const std::lock_guard lock(mutex_);
    const auto found = renderings_.find(job.frame);
    if (found != renderings_.end()) found->second->failures.push_back(failure);
    return;
  }
  const Status disk = keeper_ != nullptr ? keeper_->check_disk() : Status();
  answer(job.frame, disk ? fail(ErrorKind::kRender, "{}", failure.message) : forward_error(disk));
}

}  // namespace seedframe
