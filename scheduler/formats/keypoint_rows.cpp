#include "formats/keypoint_rows.h"

#include <algorithm>

namespace seedframe {

Result<std::vector<KeypointRow>> keypoint_rows(const CommittedFrame& frame,
                                               const InstanceLabel& label,
                                               const ClassKeypoints& keypoints) {
  std::vector<KeypointRow> rows(keypoints.names.size());
  for (const KeypointLabel& point : label.keypoints) {
    const auto found = std::find(keypoints.names.begin(), keypoints.names.end(), point.name);
    if (found == keypoints.names.end()) {
      return fail(ErrorKind::kCorrupt,
                  "frame {}, instance {} ('{}') has a keypoint '{}', which the assets no longer "
                  "have: put it back with 'seedframe asset keypoints {}', or submit the campaign "
                  "again",
                  frame.index, label.id, label.name, point.name, label.asset);
    }
    rows[static_cast<std::size_t>(found - keypoints.names.begin())] = {point.px, point.visibility};
  }
  return rows;
}

Status check_has_keypoints(const Dataset& dataset) {
  for (const ClassKeypoints& keypoints : dataset.keypoints) {
    if (!keypoints.names.empty()) return {};
  }
  return fail(ErrorKind::kInput,
              "no asset of campaign '{}' has keypoints: 'seedframe asset keypoints' sets them, "
              "before the campaign is submitted",
              dataset.name);
}

}  // namespace seedframe
