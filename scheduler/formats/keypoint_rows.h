// The keypoints of an instance in the order of its class.
#pragma once

#include <array>
#include <vector>

#include "annotate/labels.h"
#include "base/error.h"
#include "export/dataset.h"

namespace seedframe {

struct KeypointRow {
  std::array<double, 2> px{};  ///< 0 is the edge of the first pixel
  Visibility visibility = Visibility::kOutside;
};

/// One for each name of the class; outside for a point that the instance's asset does not have. A
/// kCorrupt error for a point that the class does not have.
Result<std::vector<KeypointRow>> keypoint_rows(const CommittedFrame& frame,
                                               const InstanceLabel& label,
                                               const ClassKeypoints& keypoints);

/// A kInput error that says how to make some, if no class has any.
Status check_has_keypoints(const Dataset& dataset);

}  // namespace seedframe
