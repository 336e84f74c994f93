// What a look at some frames tells about a config before anything is rendered.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/expander.h"

namespace seedframe {

struct SceneSurvey {
  std::vector<std::int64_t> frames;   ///< that were looked at
  int width = 0;                      ///< of the pictures that the twin made
  int height = 0;                     ///< the same
  std::vector<std::string> warnings;  ///< what is possible, and hardly meant
};

/// Has the twin look at up to 24 frames, spread over the campaign, in pictures of 160 pixels at
/// most.
Result<SceneSurvey> survey_scenes(const SceneExpander& expander,
                                  const std::vector<std::string>& categories);

}  // namespace seedframe
