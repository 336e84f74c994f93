// What many frames tell together.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/expander.h"

namespace seedframe {

/// Of all frames that were added.
struct ExpansionSummary {
  std::int64_t frames = 0;
  std::size_t least_instances = SIZE_MAX;
  std::size_t most_instances = 0;
  std::int64_t attempts = 0;  ///< to meet the constraints
  std::int64_t image_px = 0;
  std::int64_t rendered_px = 0;  ///< of them; fewer where frames have a region
  UsedFiles used;
  std::set<std::string> meshes;              ///< SHA-256, without grounds
  std::vector<ConstraintTally> constraints;  ///< in the order of the config

  void add(const ExpandedFrame& frame);
};

/// Expands every frame and keeps none; an error if any cannot be expanded. `visit`, if given, sees
/// each.
Result<ExpansionSummary> expand_all(const SceneExpander& expander, const ExpansionWishes& wishes,
                                    const std::function<Status(const ExpandedFrame&)>& visit = {});

/// "constraint ball_seen: met in 812 of 1020 draws", a line for each constraint.
std::string describe_constraints(const SceneExpander& expander,
                                 const std::vector<ConstraintTally>& tallies);

}  // namespace seedframe
