// What a variation costs and how wrong it is, in one measure: what charts and tables are made of.
#pragma once

#include <string>
#include <vector>

#include "quality/error_study.h"
#include "quality/measure.h"
#include "quality/pareto.h"

namespace seedframe {

struct Choice {
  std::string name;
  Lever lever = Lever::kSamples;
  int samples = 1;
  bool denoises = false;
  CostAndError at;
};

/// Of the variations that were measured: CPU seconds of a frame, and the error.
std::vector<Choice> choices_of(const SceneStudy& scene, const Measure& measure);

/// Over all frames of all scenes, of variations that each scene has: geometric means of cost and
/// error relative to those of 16 plain samples of the same frame. Empty if there is a scene without
/// these.
std::vector<Choice> choices_overall(const std::vector<SceneStudy>& scenes, const Measure& measure);

inline constexpr int kOverallSamples = 16;

/// Which are on the front (pareto.h); `denoised`: whether those that denoise may be.
std::vector<std::size_t> front_of(const std::vector<Choice>& choices, bool denoised);

/// What to take instead of plain samples for the same error, at the least cost.
struct Advice {
  Choice plain;
  Choice exact;     ///< the cheapest without a denoiser; plain itself if nothing is cheaper
  Choice denoised;  ///< the cheapest of all
};
/// For each of 4, 16, 64, 256 and 1024 plain samples that was measured.
std::vector<Advice> advice_for(const std::vector<Choice>& choices);

}  // namespace seedframe
