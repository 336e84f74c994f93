#include "stream/frame_maker.h"

#include <cmath>

#include <fmt/format.h>

#include "annotate/amodal.h"
#include "base/files.h"
#include "campaign/worker_requests.h"
#include "frames/rendered_frame.h"
#include "image/color_management.h"
#include "image/pixel_hash.h"
#include "picture/pixel_scaling.h"
#include "preview/twin_shading.h"
#include "sensor/camera_sensor.h"
#include "spec/frame_spec_reader.h"
#include "spec/scaled_view.h"
#include "twin/twin_comparison.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kPointsOfPixel = 2;  // of a shaded one, both ways

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
                       SetUp set_up)
    : prepared_(prepared),
      scratch_(std::move(scratch)),
      set_up_(std::move(set_up)),
      queue_(std::make_unique<FinishQueue>(threads)) {}

FrameMaker::~FrameMaker() {
  if (pool_) pool_->drain();
  if (pool_thread_.joinable()) pool_thread_.join();
  queue_.reset();
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
    if (Status started = start_pool(); !started) {
      return order.done(forward_error(started));
    }
    number = ++last_number_;
    renderings_[number] =
        std::make_shared<Rendering>(Rendering{std::move(order), std::move(*frame), begun});
  }
  pool_->add({number});
}

Result<ExpandedFrame> FrameMaker::expand(const FrameRequest& request) const {
  Result<ExpandedFrame> frame =
      prepared_.expander.expand_given(request.scene, request.values, "values", {.id = false});
  if (!frame) return frame;
  RenderSettings& render = frame->spec.render;
  if (request.samples) render.samples = *request.samples;
  if (request.crop) {
    if (request.crop->end_x() > render.width || request.crop->end_y() > render.height) {
      return fail(ErrorKind::kInput, "crop: it reaches beyond the image of {} × {} pixels",
                  render.width, render.height);
    }
    render.region = request.crop;
  }
  if (request.depth) render.depth = true;
  frame->id = frame_id(frame->spec);
  return frame;
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
  FrameSpec fine = scaled_view(frame.spec, kPointsOfPixel);
  fine.render.depth = fine.render.normal = true;
  const Result<Twin> twin = tracer_.trace(fine, frame.meshes, TwinTracer::Passes::kAsked);
  if (!twin) return forward_error(twin);
  const Shading shading = shaded(fine, frame.world_from_camera, *twin);
  const double exposure = std::exp2(frame.spec.image.exposure_stops);
  made.image = shrunk(shaded_display(shading.light, exposure), made.width, made.height);
  return {};
}

// ---- Rendered frames ----

Status FrameMaker::start_pool() {
  if (pool_ || !pool_state_) return pool_state_;
  Result<RunSetup> setup = set_up_();
  if (!setup) {
    // Told to everyone who asks for a rendering: what is missing does not come by asking again.
    pool_state_ = forward_error(setup);
    return pool_state_;
  }
  setup_ = std::move(*setup);
  setup_->options.pool.stays = true;
  executor_ =
      std::make_unique<LocalExecutor>(worker_options(setup_->options, scratch_, [this](int worker) {
        return scratch_ / fmt::format("worker-{}.log", worker);
      }));
  RenderClient& client = *this;
  pool_ = std::make_unique<WorkerPool>(setup_->options.pool, *executor_, client);
  pool_thread_ = std::jthread([this] {
    const Result<RunSummary> run = pool_->run({});
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
  return {};
}

fs::path FrameMaker::passes_of(const FrameJob& job) const {
  return scratch_ / fmt::format("{}-{}.exr", job.frame, job.attempt);
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
  if (Status wanted = still_wanted(rendering->order); !wanted) return forward_error(wanted);
  Result<RenderRequest> request = make_render_request(
      rendering->frame, passes_of(job),
      [this](const std::string& sha256) { return scratch_ / (sha256 + ".mesh"); });
  if (!request) return forward_error(request);
  return std::move(*request);
}

void FrameMaker::rendered(const FrameJob& job, const RenderTimings& timings, int) {
  queue_->push([this, job, timings] { finish(job, timings); });
}

void FrameMaker::finish(const FrameJob& job, const RenderTimings& timings) {
  const std::shared_ptr<Rendering> rendering = rendering_of(job.frame);
  const fs::path passes = passes_of(job);
  Result<MadeFrame> made = rendering ? read(*rendering, passes) : Result<MadeFrame>(cancelled());
  std::error_code ignored;
  fs::remove(passes, ignored);
  fs::remove(sharp_passes(passes), ignored);
  if (!made && made.error().kind == ErrorKind::kRender) {
    pool_->post_verdict(job, forward_error(made));  // tried again, or told by attempt_failed
    return;
  }
  if (made) {
    made->worker_s = timings.build_s + timings.render_s;
    made->made_s = seconds_since(rendering->begun);
    if (Status wanted = still_wanted(rendering->order); !wanted) made = forward_error(wanted);
  }
  answer(job.frame, std::move(made));
  pool_->post_verdict(job, {});
}

Result<MadeFrame> FrameMaker::read(const Rendering& rendering, const fs::path& passes_file) {
  const FrameSpec& spec = rendering.frame.spec;
  const FrameRequest& request = rendering.order.request;
  Result<FramePasses> read = read_rendered_frame(spec, rendering.frame.id, passes_file);
  if (!read) return forward_error(read);
  FramePasses passes = on_whole_image(std::move(*read), spec.render);
  MadeFrame made;
  made.frame_id = rendering.frame.id;
  made.width = spec.render.width;
  made.height = spec.render.height;
  made.pixel_hashes = passes.pixel_hashes;
  Result<Image<std::uint8_t>> image = setup_->color->apply(passes.combined, spec.image);
  if (image && spec.sensor) image = through_sensor(*image, *spec.sensor);
  if (!image) return forward_error(image);
  made.pixel_hashes["image"] = pixel_hash(*image, "R,G,B");
  const Result<Twin> twin =
      tracer_.trace(spec, rendering.frame.meshes, TwinTracer::Passes::kIdsOnly);
  if (!twin) return forward_error(twin);
  const TwinCheck& check = prepared_.settings.twin_check;
  if (check.wanted && spec.labels.twin_exact) {
    const TwinVerdict verdict = compare_with_twin(spec, passes.instance_ids, twin->instance_ids,
                                                  check.tolerance, rounding_of(*twin));
    if (!verdict.complaint.empty()) return fail(ErrorKind::kRender, "{}", verdict.complaint);
  }
  if (request.labels) {
    Result<FrameLabels> labels =
        make_labels(spec, prepared_.settings.categories, passes.instance_ids);
    if (!labels) return forward_error(labels);
    add_amodal_labels(*labels, spec, *twin, passes.instance_ids);
    made.labels = std::move(*labels);
  }
  if (request.image) made.image = std::move(*image);
  if (request.depth) made.depth = std::move(passes.depth);
  if (request.ids) made.ids = std::move(passes.instance_ids);
  return made;
}

void FrameMaker::attempt_failed(const FrameJob& job, const AttemptFailure& failure) {
  if (failure.consequence == Consequence::kRetry) return;
  const bool asked_for = failure.failure == Failure::kAnswered;
  answer(job.frame, tl::unexpected(Error{asked_for ? ErrorKind::kInput : ErrorKind::kRender,
                                         failure.message}));
}

}  // namespace seedframe
