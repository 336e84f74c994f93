#include "preview/rendered_preview.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>

#include "frames/rendered_frame.h"
#include "image/color_management.h"
#include "quality/side_renderer.h"
#include "spec/scaled_view.h"

namespace seedframe {
namespace {

using Clock = std::chrono::steady_clock;

/// What a rendering is for: to be looked at, or to tell time with and without most of its samples.
enum class Purpose { kPicture, kAllSamples, kFewSamples, kAgain };

constexpr std::size_t kTimedFrames = 2;  // that are rendered again to tell time

struct Job {
  Purpose purpose = Purpose::kPicture;
  std::size_t frame = 0;  ///< index of PreviewWish::frames
};

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

class PreviewRun : public SideClient {
 public:
  PreviewRun(const PreparedCampaign& prepared, const RunSetup& setup, const PreviewWish& wish,
             Denoise denoise, const std::function<void(std::int64_t, std::int64_t)>& told)
      : prepared_(prepared), setup_(setup), wish_(wish), told_(told), denoise_(denoise) {
    const RenderSettings& render = prepared.settings.render;
    samples_ = std::min(render.samples, wish.most_samples);
    few_samples_ = std::max(1, samples_ / 4);
    for (std::size_t i = 0; i < wish.frames.size(); ++i) jobs_.push_back({Purpose::kPicture, i});
    // The last ones, whose workers are warm.
    const std::size_t timed = std::min(kTimedFrames, wish.frames.size());
    for (std::size_t i = wish.frames.size() - timed; i < wish.frames.size(); ++i) {
      if (denoise != render.denoise) jobs_.push_back({Purpose::kAllSamples, i});
      if (few_samples_ < samples_) jobs_.push_back({Purpose::kFewSamples, i});
    }
    told_of_ = job_count();
    if (denoise != render.denoise) {
      const auto begun_at_once = 2 * static_cast<std::size_t>(setup.options.pool.workers);
      jobs_.insert(jobs_.end(), begun_at_once, {Purpose::kAgain, 0});
    }
    pictures_.resize(wish.frames.size());
    whole_.resize(wish.frames.size());
  }

  std::int64_t job_count() const { return static_cast<std::int64_t>(jobs_.size()); }
  void begin() { begun_ = Clock::now(); }

  Result<ExpandedFrame> frame(std::int64_t number) override {
    if (!first_asked_) first_asked_ = Clock::now();
    Job& job = jobs_[static_cast<std::size_t>(number)];
    if (job.purpose == Purpose::kAgain) {
      if (again_.empty()) return fail(ErrorKind::kRender, "nothing is to be rendered again");
      job = {Purpose::kPicture, again_.back()};
      again_.pop_back();
    }
    Result<ExpandedFrame> expanded =
        prepared_.expander.expand(wish_.frames[job.frame], {.id = false});
    if (!expanded) return expanded;
    Whole& whole = whole_[job.frame];
    if (whole.width == 0) {
      whole = {expanded->spec.render.width, expanded->spec.render.samples};
    }
    if (whole.width > wish_.most_width) {
      expanded->spec = scaled_view(std::move(expanded->spec),
                                   static_cast<double>(wish_.most_width) / whole.width);
    }
    RenderSettings& small = expanded->spec.render;
    small.samples =
        std::min(small.samples, job.purpose == Purpose::kFewSamples ? few_samples_ : samples_);
    small.adaptive = {};
    if (job.purpose == Purpose::kPicture) small.denoise = denoise_;
    expanded->id = frame_id(expanded->spec);
    return expanded;
  }

  Status rendered(std::int64_t number, const SideFrame& frame) override {
    const Job& job = jobs_[static_cast<std::size_t>(number)];
    const double seconds = frame.timings.build_s + frame.timings.render_s;
    timings_[job.purpose][job.frame] = {seconds, frame.timings.build_s};
    told_(++done_, told_of_);
    return job.purpose == Purpose::kPicture ? keep_picture(job.frame, frame) : Status();
  }

  /// A Blender that was built without a denoiser says so of the first frames: noise is better than
  /// nothing.
  void failed(std::int64_t number, const std::string& why) override {
    const Job& job = jobs_[static_cast<std::size_t>(number)];
    if (job.purpose != Purpose::kPicture) return;
    const RenderSettings& render = prepared_.settings.render;
    if (why.find("Denoise") != std::string::npos && render.denoise == Denoise::kOff) {
      denoise_ = Denoise::kOff;
      again_.push_back(job.frame);
    } else {
      failures_.push_back(fmt::format("frame {} failed: {}", wish_.frames[job.frame], why));
    }
  }

  /// Whether all are to be rendered again, without the denoiser.
  bool lacked_denoiser() const { return !again_.empty(); }

  RenderedPreview result() {
    RenderedPreview preview;
    for (std::optional<PreviewedFrame>& picture : pictures_) {
      if (picture) preview.frames.push_back(std::move(*picture));
    }
    preview.failures = std::move(failures_);
    preview.samples = samples_;
    preview.denoised = denoise_ != Denoise::kOff;
    preview.costs = costs();
    return preview;
  }

 private:
  /// A frame as it is in the campaign.
  struct Whole {
    int width = 0;
    int samples = 0;
  };

  struct Timing {
    double frame_s = 0.0;
    double build_s = 0.0;
  };

  Status keep_picture(std::size_t at, const SideFrame& frame) {
    const FramePasses passes = on_whole_image(frame.passes, frame.spec.render);
    Result<FrameLabels> labels =
        make_labels(frame.spec, prepared_.settings.categories, passes.instance_ids);
    if (!labels) return forward_error(labels);
    auto image = setup_.color->apply(passes.combined, frame.spec.image);
    if (!image) return forward_error(image);
    PreviewedFrame& picture = pictures_[at].emplace();
    picture.index = wish_.frames[at];
    picture.scale = static_cast<double>(whole_[at].width) / frame.spec.render.width;
    picture.content.labels = std::move(*labels);
    picture.content.instance_ids = passes.instance_ids;
    picture.content.image = std::move(*image);
    return {};
  }

  /// Of a frame as it will be: what does not depend on its samples, and those, for all its pixels.
  /// The denoiser's time, which is part of the former, grows with the pixels.
  std::optional<double> full_frame_s(std::size_t at) const {
    const Denoise denoise = prepared_.settings.render.denoise;
    const std::optional<Timing> many =
        timing(denoise_ != denoise ? Purpose::kAllSamples : Purpose::kPicture, at);
    if (!many) return std::nullopt;
    const Whole& whole = whole_[at];
    const double larger =
        static_cast<double>(whole.width) / std::min(whole.width, wish_.most_width);
    if (whole.width <= wish_.most_width && whole.samples <= samples_) return many->frame_s;
    const std::optional<Timing> few = timing(Purpose::kFewSamples, at);
    if (!few) return std::nullopt;
    const double sample_s =
        std::max(0.0, (many->frame_s - few->frame_s) / (samples_ - few_samples_));
    const double fixed_s = std::max(0.0, many->frame_s - sample_s * samples_ - many->build_s);
    return many->build_s + fixed_s * (denoise == Denoise::kOff ? 1.0 : larger * larger) +
           sample_s * whole.samples * larger * larger;
  }

  std::optional<Timing> timing(Purpose purpose, std::size_t at) const {
    const auto of_purpose = timings_.find(purpose);
    if (of_purpose == timings_.end()) return std::nullopt;
    const auto found = of_purpose->second.find(at);
    return found == of_purpose->second.end() ? std::nullopt : std::optional(found->second);
  }

  /// Of the pictures, but for those that a worker began with; for them all if there are no others.
  double picture_s() const {
    const std::map<std::size_t, Timing>& pictures = timings_.at(Purpose::kPicture);
    const auto firsts = static_cast<std::size_t>(setup_.options.pool.workers);
    std::vector<double> all, warm;
    for (const auto& [at, timing] : pictures) {
      all.push_back(timing.frame_s);
      if (at >= firsts) warm.push_back(timing.frame_s);
    }
    return mean_of(warm.empty() ? all : warm);
  }

  std::optional<CampaignCosts> costs() const {
    std::vector<double> frames, pictures;
    for (std::size_t at = 0; at < whole_.size(); ++at) {
      const std::optional<double> seconds = full_frame_s(at);
      const std::optional<Timing> picture = timing(Purpose::kPicture, at);
      if (!seconds || !picture) continue;
      frames.push_back(*seconds);
      pictures.push_back(picture->frame_s);
    }
    if (frames.empty() || !first_asked_) return std::nullopt;
    CampaignCosts costs;
    // What tells is of few frames: their pictures say how much dearer than others they are.
    costs.frame_s = mean_of(frames) * picture_s() / std::max(1e-9, mean_of(pictures));
    costs.is_at_most = prepared_.settings.render.adaptive.threshold > 0.0;
    const std::int64_t count = prepared_.settings.frame_count();
    const auto at_once =
        static_cast<double>(std::min<std::int64_t>(setup_.options.pool.workers, count));
    const double start_s = std::chrono::duration<double>(*first_asked_ - begun_).count();
    costs.wall_s = start_s + static_cast<double>(count) * costs.frame_s / at_once;
    return costs;
  }

  const PreparedCampaign& prepared_;
  const RunSetup& setup_;
  const PreviewWish& wish_;
  const std::function<void(std::int64_t, std::int64_t)>& told_;
  Denoise denoise_;
  int samples_ = 0, few_samples_ = 0;
  std::vector<Job> jobs_;
  Clock::time_point begun_;
  std::optional<Clock::time_point> first_asked_;
  std::int64_t done_ = 0, told_of_ = 0;
  std::vector<Whole> whole_;        ///< of each frame of the wish; kept when it is first asked for
  std::vector<std::size_t> again_;  ///< that no denoiser was there for
  std::map<Purpose, std::map<std::size_t, Timing>> timings_;
  std::vector<std::optional<PreviewedFrame>> pictures_;
  std::vector<std::string> failures_;
};

}  // namespace

Result<RenderedPreview> preview_by_rendering(
    const PreparedCampaign& prepared, const RunSetup& setup, const PreviewWish& wish,
    const std::filesystem::path& scratch,
    const std::function<void(std::int64_t done, std::int64_t all)>& told) {
  const Denoise wanted = prepared.settings.render.denoise;
  Denoise denoise = wanted == Denoise::kOff ? Denoise::kOidnFast : wanted;
  while (true) {
    PreviewRun run(prepared, setup, wish, denoise, told);
    run.begin();
    const Status done = render_aside(run.job_count(), setup, scratch, run);
    if (!done) return forward_error(done);
    if (!run.lacked_denoiser()) return run.result();
    denoise = Denoise::kOff;
  }
}

}  // namespace seedframe
