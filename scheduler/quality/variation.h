// Ways to render the same frames: what `seedframe bench error` measures.
#pragma once

#include <string>
#include <vector>

#include "scene/expanded_frame.h"
#include "spec/campaign_settings.h"
#include "spec/campaign_source.h"

namespace seedframe {

/// What a variation is about.
enum class Lever {
  kSamples,
  kDenoise,
  kAdaptive,
  kAdaptiveDenoise,
  kBounces,
  kLightThreshold,
  kClamp,
  kFilterGlossy,
  kImportanceMap,
  kTextures,
  kDetail,
  kGuiding,
};
/// "samples", "denoising", …, for tables and plots.
const char* name_of(Lever lever);

struct Variation {
  std::string name;  ///< "16 samples, oidn_fast"
  Lever lever = Lever::kSamples;
  int samples = 1;            ///< the most that a pixel gets
  std::vector<Override> set;  ///< what a user would say to have it: --set path=value

  bool denoises() const { return lever == Lever::kDenoise || lever == Lever::kAdaptiveDenoise; }
};

/// Every pixel has so many samples, and every lever that was there before is taken back but for the
/// bounces and clamps of the config.
Variation plain_samples(int samples);

/// The same with nothing that trades truth for speed or noise: what the others are compared with.
Variation reference_variation(int samples);

/// What is worth trying on such frames, the most telling first: importance maps only where there is
/// an environment map, texture sizes only where there are images, levels of detail of those
/// sections `objects` that the frames have copies of. Plain samples go up to `most_samples`.
std::vector<Variation> variation_grid(const std::vector<ExpandedFrame>& pilots, int most_samples);

}  // namespace seedframe
