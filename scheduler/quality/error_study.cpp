#include "quality/error_study.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>
#include <numeric>
#include <utility>

#include "quality/reference.h"
#include "quality/side_renderer.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

// So many samples are timed first: from them follows what more of them take.
constexpr int kFew = 1;
constexpr int kSome = 16;

constexpr const char* kNoRoom = "the budget did not reach so far";

/// Renders and judges; of one study. Calls come from two threads, so all is behind one mutex but
/// what the jobs are.
class ErrorStudy : public SideClient {
 public:
  ErrorStudy(const PreparedCampaign& prepared, const RunSetup& setup,
             const ErrorStudyWishes& wishes, std::vector<ExpandedFrame> pilots,
             const OnRendering& on_rendering)
      : prepared_(prepared),
        color_(*setup.color),
        wishes_(wishes),
        pilots_(std::move(pilots)),
        on_rendering_(on_rendering),
        start_(Clock::now()) {
    plan();
  }

  std::int64_t jobs() const { return static_cast<std::int64_t>(jobs_.size()); }
  Result<SceneStudy> result(SceneStudy study) const;

  Result<ExpandedFrame> frame(std::int64_t job) override;
  Status rendered(std::int64_t job, const SideFrame& frame) override;
  void failed(std::int64_t job, const std::string& why) override;

 private:
  enum class Purpose { kWarmUp, kTimed, kHalfA, kHalfB, kMeasured };
  struct Job {
    Purpose purpose = Purpose::kMeasured;
    std::size_t variation = 0;  ///< of kTimed and kMeasured
    std::size_t pilot = 0;
  };
  struct Measured {
    Variation variation;
    std::vector<std::optional<MeasuredFrame>> frames;
    std::vector<double> early_wall_s;  ///< of kTimed, pilots in any order
    std::string left_out;
  };

  void plan();
  void add_jobs(Purpose purpose, std::size_t variation);
  double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// Seconds of the clock, as far as known; nothing before 1 and 16 samples have been measured.
  std::optional<double> expected_s(int samples) const;
  void choose_reference();
  /// Once for all pilots: their jobs follow each other.
  Result<const PreparedCampaign*> prepared_for(const Variation& variation);
  std::int64_t frame_of(std::size_t pilot) const {
    return pilots_[pilot].scene * prepared_.settings.frames_per_scene + pilots_[pilot].view;
  }
  /// With both halves there is a reference.
  Status half_done(std::size_t pilot);

  const PreparedCampaign& prepared_;
  const ColorManagement& color_;
  ErrorStudyWishes wishes_;
  std::vector<ExpandedFrame> pilots_;
  const OnRendering& on_rendering_;
  Clock::time_point start_;
  std::vector<Job> jobs_;
  std::string prepared_name_;  ///< of the variation
  std::optional<PreparedCampaign> prepared_now_;

  std::mutex mutex_;
  std::vector<Measured> measured_;
  int reference_samples_ = 0;  ///< of both halves; 0: not chosen yet
  double reference_cpu_s_ = 0.0;
  std::array<std::vector<std::optional<FramePasses>>, 2> halves_;
  std::vector<std::optional<Reference>> references_;
  Status reference_error_;
};

void ErrorStudy::add_jobs(Purpose purpose, std::size_t variation) {
  for (std::size_t pilot = 0; pilot < pilots_.size(); ++pilot) {
    jobs_.push_back({purpose, variation, pilot});
  }
}

void ErrorStudy::plan() {
  for (Variation& variation : variation_grid(pilots_, wishes_.most_samples)) {
    measured_.push_back({std::move(variation), {}, {}, {}});
    measured_.back().frames.resize(pilots_.size());
  }
  for (auto& halves : halves_) halves.resize(pilots_.size());
  references_.resize(pilots_.size());
  // A worker's first renderings are slower than all that follow: they say how long a reference may
  // take, and are not measured.
  add_jobs(Purpose::kWarmUp, 0);
  for (const int samples : {kFew, kSome}) {
    const auto row = std::find_if(measured_.begin(), measured_.end(), [&](const Measured& each) {
      return each.variation.lever == Lever::kSamples && each.variation.samples == samples;
    });
    add_jobs(Purpose::kTimed, static_cast<std::size_t>(row - measured_.begin()));
  }
  add_jobs(Purpose::kWarmUp, 0);  // so that all that is timed is known when a reference begins
  add_jobs(Purpose::kHalfA, 0);
  add_jobs(Purpose::kHalfB, 0);
  for (std::size_t i = 0; i < measured_.size(); ++i) add_jobs(Purpose::kMeasured, i);
}

std::optional<double> ErrorStudy::expected_s(int samples) const {
  const auto seconds = [&](int of) -> std::optional<double> {
    for (const Measured& measured : measured_) {
      const std::vector<double>& wall_s = measured.early_wall_s;
      if (wall_s.empty() || measured.variation.samples != of) continue;
      return std::accumulate(wall_s.begin(), wall_s.end(), 0.0) /
             static_cast<double>(wall_s.size());
    }
    return std::nullopt;
  };
  const auto few = seconds(kFew);
  const auto some = seconds(kSome);
  if (!few) return std::nullopt;
  const double each = some ? std::max(0.0, *some - *few) / (kSome - kFew) : *few;
  return *few + each * (samples - kFew);
}

void ErrorStudy::choose_reference() {
  if (reference_samples_ > 0) return;
  constexpr int kLeast = 64;
  constexpr double kShare = 0.5;  // of the budget
  reference_samples_ = std::max(kLeast, wishes_.reference_samples);
  const double room = kShare * wishes_.budget_s / static_cast<double>(pilots_.size());
  while (reference_samples_ > kLeast && expected_s(reference_samples_).value_or(0.0) > room) {
    reference_samples_ /= 2;
  }
}

Result<const PreparedCampaign*> ErrorStudy::prepared_for(const Variation& variation) {
  if (prepared_now_ && prepared_name_ == variation.name) return &*prepared_now_;
  prepared_now_.reset();
  CampaignSource source = prepared_.source;
  source.overrides.insert(source.overrides.end(), variation.set.begin(), variation.set.end());
  Result<PreparedCampaign> prepared = prepare(std::move(source));
  if (!prepared) return forward_error(prepared);
  prepared_now_ = std::move(*prepared);
  prepared_name_ = variation.name;
  return &*prepared_now_;
}

Result<ExpandedFrame> ErrorStudy::frame(std::int64_t number) {
  const Job& job = jobs_[static_cast<std::size_t>(number)];
  const bool is_half = job.purpose == Purpose::kHalfA || job.purpose == Purpose::kHalfB;
  Variation variation;
  {
    const std::lock_guard lock(mutex_);
    if (is_half) choose_reference();
    variation =
        is_half ? reference_variation(reference_samples_ / 2) : measured_[job.variation].variation;
    if (job.purpose == Purpose::kMeasured) {
      const bool plain = variation.lever == Lever::kSamples;
      const double rest = static_cast<double>(pilots_.size() - job.pilot);
      const double needed = plain ? expected_s(variation.samples).value_or(0.0) * rest : 0.0;
      if (!measured_[job.variation].left_out.empty() || elapsed_s() + needed > wishes_.budget_s) {
        return fail(ErrorKind::kInput, "{}", kNoRoom);
      }
    }
  }
  const Result<const PreparedCampaign*> prepared = prepared_for(variation);
  if (!prepared) return forward_error(prepared);
  const std::int64_t frame = frame_of(job.pilot);
  Result<ExpandedFrame> expanded =
      is_half ? expand_half(**prepared, frame,
                            job.purpose == Purpose::kHalfA ? ReferenceHalf::kA : ReferenceHalf::kB)
              : (*prepared)->expander.expand(frame);
  if (expanded && job.purpose != Purpose::kWarmUp) on_rendering_(variation.name, frame);
  return expanded;
}

Status ErrorStudy::half_done(std::size_t pilot) {
  std::optional<FramePasses>& a = halves_[0][pilot];
  std::optional<FramePasses>& b = halves_[1][pilot];
  if (!a || !b) return {};
  Result<Reference> reference = make_reference(*a, *b, color_, pilots_[pilot].spec.image);
  if (!reference) return forward_error(reference);
  references_[pilot] = std::move(*reference);
  a.reset();
  b.reset();
  return {};
}

Status ErrorStudy::rendered(std::int64_t number, const SideFrame& frame) {
  const Job& job = jobs_[static_cast<std::size_t>(number)];
  if (job.purpose == Purpose::kWarmUp) return {};
  const std::lock_guard lock(mutex_);
  if (job.purpose == Purpose::kTimed) {
    measured_[job.variation].early_wall_s.push_back(frame.timings.build_s + frame.timings.render_s);
    return {};
  }
  if (job.purpose != Purpose::kMeasured) {
    halves_[job.purpose == Purpose::kHalfA ? 0 : 1][job.pilot] = frame.passes;
    reference_cpu_s_ += frame.timings.cpu_s;
    return half_done(job.pilot);
  }
  Result<Image<std::uint8_t>> display =
      color_.apply(frame.passes.combined, pilots_[job.pilot].spec.image);
  if (!display) return forward_error(display);
  Measured& measured = measured_[job.variation];
  measured.frames[job.pilot] =
      MeasuredFrame{frame.timings.cpu_s, frame.timings.build_s + frame.timings.render_s, {}};
  if (!references_[job.pilot]) return {};  // which failed: result() says so
  measured.frames[job.pilot]->error =
      error_against(*references_[job.pilot], {frame.passes.combined, std::move(*display)});
  return {};
}

void ErrorStudy::failed(std::int64_t number, const std::string& why) {
  const Job& job = jobs_[static_cast<std::size_t>(number)];
  const std::lock_guard lock(mutex_);
  if (job.purpose == Purpose::kMeasured) {
    std::string& left_out = measured_[job.variation].left_out;
    if (left_out.empty()) left_out = why.substr(0, why.find('\n'));
  } else if ((job.purpose == Purpose::kHalfA || job.purpose == Purpose::kHalfB) &&
             reference_error_) {
    reference_error_ = fail(ErrorKind::kRender, "the reference of frame {} was not rendered: {}",
                            frame_of(job.pilot), why);
  }
}

ReferenceVariance operator+(ReferenceVariance a, const ReferenceVariance& b) {
  a.linear.mse += b.linear.mse;
  a.linear.rel_mse += b.linear.rel_mse;
  a.linear.mrse += b.linear.mrse;
  a.display += b.display;
  a.edges += b.edges;
  return a;
}

ReferenceVariance mean_variance(const std::vector<std::optional<Reference>>& references) {
  ReferenceVariance sum;
  for (const auto& reference : references) sum = sum + reference->variance;
  const auto count = static_cast<double>(references.size());
  return {{sum.linear.mse / count, sum.linear.rel_mse / count, sum.linear.mrse / count},
          sum.display / count,
          sum.edges / count};
}

Result<SceneStudy> ErrorStudy::result(SceneStudy study) const {
  if (!reference_error_) return forward_error(reference_error_);
  const bool all = std::all_of(references_.begin(), references_.end(),
                               [](const auto& reference) { return reference.has_value(); });
  if (!all) return fail(ErrorKind::kRender, "not every pilot frame has a reference");
  study.reference_samples = reference_samples_;
  study.reference_cpu_s = reference_cpu_s_ / static_cast<double>(pilots_.size());
  study.reference = mean_variance(references_);
  for (const Measured& measured : measured_) {
    MeasuredVariation row{measured.variation, {}, measured.left_out};
    for (const auto& frame : measured.frames) {
      if (row.left_out.empty() && !frame) row.left_out = kNoRoom;
      if (frame) row.frames.push_back(*frame);
    }
    if (!row.left_out.empty()) row.frames.clear();
    study.variations.push_back(std::move(row));
  }
  return study;
}

template <class Value>
double mean_over(const std::vector<MeasuredFrame>& frames, const Value& value) {
  double sum = 0.0;
  for (const MeasuredFrame& frame : frames) sum += value(frame);
  return frames.empty() ? 0.0 : sum / static_cast<double>(frames.size());
}

}  // namespace

double MeasuredVariation::cpu_s() const {
  return mean_over(frames, [](const MeasuredFrame& frame) { return frame.cpu_s; });
}

double MeasuredVariation::wall_s() const {
  return mean_over(frames, [](const MeasuredFrame& frame) { return frame.wall_s; });
}

RenderingError MeasuredVariation::error() const {
  RenderingError sum;
  const auto add = [&](auto member, auto part) {
    part(sum).*member =
        mean_over(frames, [&](const MeasuredFrame& frame) { return part(frame.error).*member; });
  };
  const auto squared = [](auto& error) -> auto& { return error.linear.squared; };
  const auto linear = [](auto& error) -> auto& { return error.linear; };
  const auto display = [](auto& error) -> auto& { return error.display; };
  const auto edges = [](auto& error) -> auto& { return error.edges; };
  add(&SquaredErrors::mse, squared);
  add(&SquaredErrors::rel_mse, squared);
  add(&SquaredErrors::mrse, squared);
  add(&LinearError::luminance_bias, linear);
  add(&DisplayError::mse, display);
  add(&DisplayError::bias, display);
  add(&DisplayError::flip, display);
  add(&EdgeError::contrast, edges);
  add(&EdgeError::mean_square, edges);
  add(&EdgeError::kept, edges);
  if (!frames.empty() && frames.front().error.display.ssim) {
    sum.display.ssim = mean_over(
        frames, [](const MeasuredFrame& frame) { return frame.error.display.ssim.value_or(0.0); });
  }
  return sum;
}

const MeasuredVariation* SceneStudy::find(const std::string& variation) const {
  const auto found = std::find_if(
      variations.begin(), variations.end(),
      [&](const MeasuredVariation& measured) { return measured.variation.name == variation; });
  return found == variations.end() ? nullptr : &*found;
}

std::vector<std::int64_t> pilot_frames(std::int64_t all, int count) {
  std::vector<std::int64_t> frames;
  for (std::int64_t i = 0; i < count; ++i) frames.push_back((2 * i + 1) * all / (2 * count));
  return frames;
}

Result<SceneStudy> study_errors(const PreparedCampaign& prepared, const RunSetup& setup,
                                const fs::path& scratch, const ErrorStudyWishes& wishes,
                                const OnRendering& on_rendering) {
  const CampaignSettings& settings = prepared.settings;
  if (settings.labels == LabelSource::kTwin) {
    return fail(ErrorKind::kInput,
                "'{}' has labels without pictures (labels: geometry), so there is no error to "
                "measure",
                settings.name);
  }
  const std::int64_t all = prepared.expander.frame_count();
  if (all < wishes.frames) {
    return fail(ErrorKind::kInput, "'{}' has {} frames, and {} are to be measured: ask for fewer",
                settings.name, all, wishes.frames);
  }
  SceneStudy study;
  study.name = settings.name;
  study.width = settings.render.width;
  study.height = settings.render.height;
  study.frames = pilot_frames(all, wishes.frames);
  std::vector<ExpandedFrame> pilots;
  for (const std::int64_t frame : study.frames) {
    Result<ExpandedFrame> expanded = prepared.expander.expand(frame);
    if (!expanded) return forward_error(expanded);
    pilots.push_back(std::move(*expanded));
  }
  ErrorStudy run(prepared, setup, wishes, std::move(pilots), on_rendering);
  if (Status rendered = render_aside(run.jobs(), setup, scratch, run); !rendered) {
    return forward_error(rendered);
  }
  return run.result(std::move(study));
}

}  // namespace seedframe
