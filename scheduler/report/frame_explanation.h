// Everything that is known about one frame of a campaign, as data.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "annotate/labels.h"
#include "base/canonical_json.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "frames/manifest.h"

namespace seedframe {

struct FrameExplanation {
  FrameRow row;
  ExpandedFrame expanded;  ///< as it would be today, with its draws
  bool alone = false;      ///< only the frame's own files are known: its spec and id, no draws
  std::vector<AttemptRow> attempts;
  std::optional<Manifest> manifest;   ///< none: its folder holds no frame
  std::optional<FrameLabels> labels;  ///< of that frame, if it is the one that is expanded
};

/// An object of the frame, as people look for it.
struct ExplainedObject {
  int id = 0;
  std::string name;
  std::string asset;
  std::string category;                                ///< empty: none
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of its origin, world, metres
  double distance_m = 0.0;                             ///< of its origin from the camera
  std::optional<std::int64_t> visible_px;              ///< none: the frame is not there
  std::optional<double> visible_share;                 ///< of its silhouette
};

std::vector<ExplainedObject> explained_objects(const FrameExplanation& explanation,
                                               const std::vector<std::string>& categories);

/// A kInput error for a frame that the campaign does not have.
Result<FrameExplanation> explain_frame(const Campaign& campaign, const PreparedCampaign& prepared,
                                       std::int64_t frame);

/// Of a finished frame of a campaign whose config cannot be read here. Positions are then in the
/// camera's frame (x right, y up, z backwards).
Result<FrameExplanation> explain_frame_alone(const Campaign& campaign, std::int64_t frame);

/// Of an attempt; null if there is none.
Json provenance_of(const AttemptRow& attempt);

/// `render_again`: the command that renders it again.
Json to_json(const FrameExplanation& explanation, const std::vector<std::string>& categories,
             const std::string& render_again);

}  // namespace seedframe
