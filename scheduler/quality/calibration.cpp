#include "quality/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "image/flip.h"
#include "quality/error_model.h"
#include "quality/error_study.h"
#include "quality/probe.h"
#include "quality/setting_steps.h"

namespace seedframe {
namespace {

constexpr int kPilots = 8;
constexpr int kScoutSamples = 4;
constexpr int kReferenceHalf = 128;     // samples of each half of a pilot's reference
constexpr int kScaleSamples = 16;       // that say what the whole resolution changes
constexpr int kLeastQuarterWidth = 64;  // pixels: below that, probes are of the frame's own size
constexpr std::array<int, 4> kPlainSettings = {1, 4, 16, 64};
constexpr std::array<double, 3> kThresholds = {kCoarsestThreshold, 0.1, 0.025};
constexpr std::array<int, 3> kDenoisedSettings = {1, 4, 16};

// Committed constants, from results/error_vs_time: they rank choices of the same predicted error.
// A sample of adaptive sampling takes as long as a plain one; with fewer than these plain samples
// nothing could stop early.
constexpr int kAdaptiveFrom = 32;
constexpr double kDenoiserCost = 2.0;  // samples that the denoiser takes as long as

/// Of a rendering x, by two of the same frame with samples of their own: (x − A)(x − B) has the
/// square of x's error for its mean, whatever noise A and B have (rendering_error.h).
double error_of(const Picture& x, const Picture& a, const Picture& b, QualityMetric metric) {
  // It has no such law: what noise A has stays in it.
  if (metric == QualityMetric::kFlip) return mean_flip(flip_map(x.display, a.display));
  if (metric == QualityMetric::kRelMse) {
    const Image<float> mean = mean_of(a.linear, b.linear);
    return without_variance(linear_error(x.linear, mean).squared,
                            linear_variance(a.linear, b.linear))
        .rel_mse;
  }
  const double measured =
      (display_error(x.display, a.display).mse + display_error(x.display, b.display).mse -
       display_error(a.display, b.display).mse) /
      2.0;
  return std::sqrt(std::max(0.0, measured));
}

/// Of one of two renderings with as many samples.
double noise_of(const Picture& a, const Picture& b, QualityMetric metric) {
  if (metric == QualityMetric::kFlip) return mean_flip(flip_map(a.display, b.display));
  if (metric == QualityMetric::kRelMse) return 2.0 * linear_variance(a.linear, b.linear).rel_mse;
  return std::sqrt(display_error(a.display, b.display).mse / 2.0);
}

enum class Family { kPlain, kAdaptive, kDenoised };

/// What a probe is rendered for: the frame's noise, or as a pilot its reference, a setting's error,
/// or what the whole resolution changes.
enum class Use { kScoutA, kScoutB, kHalfA, kHalfB, kSetting, kScaleX, kScaleA, kScaleB };
struct Purpose {
  Use use = Use::kScoutA;
  Family family = Family::kPlain;  ///< of kSetting
  double setting = 0.0;            ///< the same: samples, or a threshold

  auto operator<=>(const Purpose&) const = default;
};

class Calibrator {
 public:
  Calibrator(const PreparedCampaign& prepared, std::int64_t frames)
      : wish_(*prepared.settings.quality),
        bound_(error_bound(wish_)),
        most_(prepared.settings.render.samples),
        quarter_(prepared.settings.render.width >= 2 * kLeastQuarterWidth) {
    const auto pilots = static_cast<int>(std::min<std::int64_t>(kPilots, frames));
    for (const std::int64_t pilot : pilot_frames(frames, pilots)) add_pilot(pilot);
    for (std::int64_t frame = 0; frame < frames; ++frame) {
      add(frame, {Use::kScoutA}, plain(kScoutSamples), "scout.a", quarter_);
      add(frame, {Use::kScoutB}, plain(kScoutSamples), "scout.b", quarter_);
    }
  }

  const std::vector<Probe>& probes() const { return probes_; }
  void take(std::size_t probe, Result<ProbedFrame> frame);
  Result<Calibration> finish() const;

 private:
  static RenderChoice plain(int samples) { return {samples, {}, Denoise::kOff}; }
  RenderChoice adaptive(double threshold) const {
    return {most_, {threshold, std::min(kLeastAdaptiveSamples, most_)}, Denoise::kOff};
  }
  static RenderChoice denoised(int samples) { return {samples, {}, Denoise::kOidnFast}; }

  void add(std::int64_t frame, Purpose purpose, RenderChoice choice, std::string stream,
           bool quarter) {
    probes_.push_back({frame, choice, std::move(stream), quarter});
    purposes_.push_back(purpose);
  }
  void add_settings(std::int64_t frame, Family family, double setting, RenderChoice choice) {
    add(frame, {Use::kSetting, family, setting}, choice, "setting", quarter_);
  }
  void add_pilot(std::int64_t frame);

  /// Kept until all are there: with several workers they come in any order.
  using Pictures = std::map<Purpose, Picture>;
  /// Nothing if one of the renderings failed.
  std::optional<double> error_in(const Pictures& pilot, const Purpose& x, Use a, Use b) const;
  std::optional<double> noise(std::int64_t frame) const;

  ErrorModel model_of(Family family) const;
  ErrorModel model_of_samples() const;
  bool has_errors() const;
  double scale() const;
  struct Models {
    ErrorModel plain, adaptive, denoised;
    ErrorModel samples;  ///< that adaptive sampling takes, instead of an error
    double scale = 1.0;
  };
  struct Chosen {
    RenderChoice choice;
    bool in_reach = false;  ///< as predicted, the bound is kept
  };
  Chosen choose(double scout, const Models& models) const;
  /// Adaptive sampling in place of what was chosen, where that is cheaper.
  void consider_adaptive(double scout, const Models& models, double cost, Chosen& chosen) const;
  double margin(const Models& models, const ErrorModel& model) const {
    return models.scale * std::exp(normal_quantile(wish_.share) * model.spread());
  }

  QualityWish wish_;
  ErrorBound bound_;
  int most_;
  bool quarter_;
  std::vector<Probe> probes_;
  std::vector<Purpose> purposes_;
  std::map<std::int64_t, Pictures> pilots_;
  std::map<std::int64_t, std::array<std::optional<Picture>, 2>> scouts_;  ///< until both are there
  std::map<std::int64_t, double> noise_;                                  ///< by frame
  std::map<std::int64_t, std::map<double, double>> samples_;  ///< mean, of pilots by threshold
  std::string denoiser_failure_;
  std::string failure_;  ///< the first
  double pilots_cpu_s_ = 0.0;
  double scouts_cpu_s_ = 0.0;
};

void Calibrator::add_pilot(std::int64_t frame) {
  pilots_[frame];
  add(frame, {Use::kHalfA}, plain(kReferenceHalf), "half.a", quarter_);
  add(frame, {Use::kHalfB}, plain(kReferenceHalf), "half.b", quarter_);
  for (const int samples : kPlainSettings) {
    add_settings(frame, Family::kPlain, samples, plain(samples));
  }
  if (most_ > kAdaptiveFrom) {
    for (const double threshold : kThresholds) {
      add_settings(frame, Family::kAdaptive, threshold, adaptive(threshold));
    }
  }
  if (wish_.may_denoise) {
    for (const int samples : kDenoisedSettings) {
      add_settings(frame, Family::kDenoised, samples, denoised(samples));
    }
  }
  if (!quarter_) return;
  add(frame, {Use::kScaleX}, plain(kScaleSamples), "scale.x", false);
  add(frame, {Use::kScaleA}, plain(kScaleSamples), "scale.a", false);
  add(frame, {Use::kScaleB}, plain(kScaleSamples), "scale.b", false);
}

void Calibrator::take(std::size_t number, Result<ProbedFrame> probed) {
  const std::int64_t frame = probes_[number].frame;
  const Purpose& purpose = purposes_[number];
  if (!probed) {
    std::string& failure = purpose.family == Family::kDenoised ? denoiser_failure_ : failure_;
    if (failure.empty()) failure = probed.error().message;
    return;
  }
  const bool scout = purpose.use == Use::kScoutA || purpose.use == Use::kScoutB;
  (scout ? scouts_cpu_s_ : pilots_cpu_s_) += probed->cpu_s;
  if (purpose.family == Family::kAdaptive) {
    samples_[frame][purpose.setting] = probed->mean_samples;
  }
  if (!scout) {
    pilots_.at(frame)[purpose] = std::move(probed->picture);
    return;
  }
  auto& scouts = scouts_[frame];
  scouts[purpose.use == Use::kScoutA ? 0 : 1] = std::move(probed->picture);
  if (!scouts[0] || !scouts[1]) return;
  noise_[frame] = noise_of(*scouts[0], *scouts[1], bound_.metric);
  scouts_.erase(frame);
}

std::optional<double> Calibrator::noise(std::int64_t frame) const {
  const auto found = noise_.find(frame);
  return found == noise_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> Calibrator::error_in(const Pictures& pilot, const Purpose& x, Use a,
                                           Use b) const {
  const auto found_x = pilot.find(x);
  const auto found_a = pilot.find({a});
  const auto found_b = pilot.find({b});
  if (found_x == pilot.end() || found_a == pilot.end() || found_b == pilot.end()) {
    return std::nullopt;
  }
  return error_of(found_x->second, found_a->second, found_b->second, bound_.metric);
}

ErrorModel Calibrator::model_of(Family family) const {
  std::vector<Observation> observations;
  for (const auto& [frame, pilot] : pilots_) {
    const std::optional<double> scout = noise(frame);
    for (const auto& [purpose, picture] : pilot) {
      if (!scout || purpose.use != Use::kSetting || purpose.family != family) continue;
      const auto error = error_in(pilot, purpose, Use::kHalfA, Use::kHalfB);
      if (error) observations.push_back({*scout, purpose.setting, *error});
    }
  }
  return ErrorModel(observations);
}

ErrorModel Calibrator::model_of_samples() const {
  std::vector<Observation> observations;
  for (const auto& [frame, by_threshold] : samples_) {
    const std::optional<double> scout = noise(frame);
    for (const auto& [threshold, samples] : by_threshold) {
      if (scout) observations.push_back({*scout, threshold, samples});
    }
  }
  return ErrorModel(observations);
}

/// Whether any pilot's error is known, be it 0.
bool Calibrator::has_errors() const {
  return std::any_of(pilots_.begin(), pilots_.end(), [&](const auto& pilot) {
    return error_in(pilot.second, {Use::kSetting, Family::kPlain, 1}, Use::kHalfA, Use::kHalfB)
        .has_value();
  });
}

/// How much more a frame of all pixels is wrong than one of a quarter of them, with the same
/// samples: geometric mean over the pilots. FLIP's measure of few samples knows no such comparison.
double Calibrator::scale() const {
  if (!quarter_ || bound_.metric == QualityMetric::kFlip) return 1.0;
  double sum = 0.0;
  int count = 0;
  for (const auto& [frame, pilot] : pilots_) {
    const auto whole = error_in(pilot, {Use::kScaleX}, Use::kScaleA, Use::kScaleB);
    const auto quarter =
        error_in(pilot, {Use::kSetting, Family::kPlain, kScaleSamples}, Use::kHalfA, Use::kHalfB);
    if (!whole || !quarter || *whole <= 0.0 || *quarter <= 0.0) continue;
    sum += std::log(*whole / *quarter);
    ++count;
  }
  return count > 0 ? std::exp(sum / count) : 1.0;
}

Calibrator::Chosen Calibrator::choose(double scout, const Models& models) const {
  const auto samples_for = [&](const ErrorModel& model) {
    return setting_for(model, scout, bound_.max_error, margin(models, model), 1.0, 4.0 * most_,
                       false);
  };
  const double plain_samples = samples_for(models.plain);
  Chosen chosen{plain(std::min(most_, rounded_samples(plain_samples))), plain_samples <= most_};
  double cost = chosen.choice.samples;
  if (models.denoised.is_usable()) {
    const double samples = samples_for(models.denoised);
    const int rounded = std::min(most_, rounded_samples(samples));
    if (samples <= most_ && (rounded + kDenoiserCost < cost || !chosen.in_reach)) {
      chosen = {denoised(rounded), true};
      cost = rounded + kDenoiserCost;
    }
  }
  if (chosen.in_reach && plain_samples >= kAdaptiveFrom) {
    consider_adaptive(scout, models, cost, chosen);
  }
  return chosen;
}

void Calibrator::consider_adaptive(double scout, const Models& models, double cost,
                                   Chosen& chosen) const {
  if (!models.adaptive.is_usable() || !models.samples.is_usable()) return;
  const double allowance = margin(models, models.adaptive);
  const double threshold =
      rounded_threshold(setting_for(models.adaptive, scout, bound_.max_error, allowance,
                                    kFinestThreshold, kCoarsestThreshold, true));
  const double predicted = models.adaptive.predict(scout, threshold) * allowance;
  const double samples =
      std::clamp<double>(models.samples.predict(scout, threshold), kAdaptiveFrom, most_);
  if (predicted <= bound_.max_error * (1.0 + 1e-6) && samples < cost) {
    chosen.choice = adaptive(threshold);
  }
}

Result<Calibration> Calibrator::finish() const {
  const Models models{model_of(Family::kPlain), model_of(Family::kAdaptive),
                      model_of(Family::kDenoised), model_of_samples(), scale()};
  if (!has_errors()) {
    return fail(ErrorKind::kRender, "no pilot frame could be rendered to calibrate the quality{}{}",
                failure_.empty() ? "" : ": ", failure_);
  }
  Calibration calibration;
  calibration.pilots_cpu_s = pilots_cpu_s_;
  calibration.scouts_cpu_s = scouts_cpu_s_;
  for (const Probe& probe : probes_) {
    if (calibration.choices.contains(probe.frame)) continue;
    const std::optional<double> scout = noise(probe.frame);
    Chosen chosen{plain(most_), false};  // of a frame that nobody could look at
    if (scout && !models.plain.is_usable()) chosen = {plain(1), true};  // there is no noise
    if (scout && models.plain.is_usable()) {
      // Not a single value differs, or it could be told from the pilots.
      chosen = *scout > 0.0 ? choose(*scout, models) : Chosen{plain(1), true};
    }
    if (!chosen.in_reach) ++calibration.beyond_reach;
    if (chosen.choice.denoise != Denoise::kOff) ++calibration.denoised;
    calibration.choices[probe.frame] = chosen.choice;
  }
  if (!denoiser_failure_.empty()) {
    calibration.notes.push_back("nothing is denoised: " + denoiser_failure_);
  }
  return calibration;
}

}  // namespace

Result<Calibration> calibrate(const PreparedCampaign& prepared, std::int64_t frames,
                              const RunSetup& setup, const std::filesystem::path& scratch,
                              const OnCalibrating& on_calibrating) {
  if (!prepared.settings.quality) {
    return fail(ErrorKind::kInput, "the config has no section 'quality'");
  }
  Calibrator calibrator(prepared, frames);
  const auto all = static_cast<std::int64_t>(calibrator.probes().size());
  const Status rendered = render_probes(
      calibrator.probes(), prepared, setup, scratch,
      [&](std::int64_t probe) { on_calibrating(probe, all); },
      [&](std::size_t probe, Result<ProbedFrame> frame) {
        calibrator.take(probe, std::move(frame));
      });
  if (!rendered) return forward_error(rendered);
  return calibrator.finish();
}

}  // namespace seedframe
