// Named points of an asset (docs/formats/asset.md).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "spec/keypoint.h"

namespace seedframe {

struct KeypointSet {
  std::vector<Keypoint> points;
  std::vector<std::array<std::string, 2>> skeleton;  ///< points to be joined in drawings
  std::vector<std::array<std::string, 2>> mirrored;  ///< left and right: a flip swaps them
};

/// A kInput error for names that are empty or stand twice, for a join of points that do not exist,
/// and for coordinates that are not finite.
Status check_keypoints(const KeypointSet& keypoints, const std::string& what);

Json to_json(const KeypointSet& keypoints);
/// Reads what to_json wrote; kCorrupt errors name `what`.
Result<KeypointSet> keypoints_from_json(const Json& json, const std::string& what);

}  // namespace seedframe
