// How wrong the frames of a campaign may be, and what each is rendered with so that they are not.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "base/canonical_json.h"
#include "base/error.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// What is bounded: relMSE of scene-linear pixels, mean FLIP, PSNR in dB, or RMSE in codes of 8
/// bits (docs/error_metrics.md).
enum class QualityMetric { kRelMse, kFlip, kPsnr, kRmse8 };
inline constexpr std::array<const char*, 4> kQualityMetricNames = {"relmse", "flip", "psnr",
                                                                   "rmse8"};

struct QualityWish {
  QualityMetric metric = QualityMetric::kRmse8;
  double max_error = 0.0;  ///< of a frame; with kPsnr the least that it may have
  double share = 0.95;     ///< of the frames that must keep to it
  bool may_denoise = false;

  bool operator==(const QualityWish&) const = default;
};

/// The same with less being better: a PSNR is told as the RMSE in codes that it means.
struct ErrorBound {
  QualityMetric metric = QualityMetric::kRmse8;
  double max_error = 0.0;
};
ErrorBound error_bound(const QualityWish& wish);

/// {"version": 1, "metric": "rmse8", "max_error": 4, "share": 0.95, "denoise": true}
Json to_json(const QualityWish& wish);
/// Reads what to_json wrote; the error (kCorrupt) names `what`.
Result<QualityWish> quality_wish_from_json(const Json& json, const std::string& what);

/// What is chosen of one frame's render settings.
struct RenderChoice {
  int samples = 1;
  AdaptiveSampling adaptive;
  Denoise denoise = Denoise::kOff;

  bool operator==(const RenderChoice&) const = default;
};

/// By frame of the campaign.
using RenderChoices = std::map<std::int64_t, RenderChoice>;

/// {"samples": 16, "denoise": "oidn_fast"}: what is not said is off.
Json to_json(const RenderChoice& choice);

/// {"version": 1, "frames": {"7": {"samples": 16, "denoise": "oidn_fast"}, …}}
Json to_json(const RenderChoices& choices);
/// Reads what to_json wrote; the error (kCorrupt) names `what`.
Result<RenderChoices> render_choices_from_json(const Json& json, const std::string& what);

}  // namespace seedframe
