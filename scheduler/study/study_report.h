// The study told: tables in Markdown, a plot in SVG, everything in JSON.
#pragma once

#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "study/study.h"

namespace seedframe {

struct StudyResult {
  int width = 0, height = 0;
  std::string made_with;  ///< a sentence: Blender, kernels, CPU threads
  std::vector<StudyRow> conditions;
  std::vector<StudyRow> samples;  ///< see sample_conditions
};

std::string study_markdown(const StudyResult& result);
Json to_json(const StudyResult& result);

/// Share of pixels that differ over samples a pixel, scene-linear and in 8 bits, for each scene.
std::string study_plot(const StudyResult& result);

}  // namespace seedframe
