// A finished campaign as the exporters see it, read from its frames' folders only.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "assets/offered_asset.h"
#include "base/error.h"
#include "frames/frame_reader.h"

namespace seedframe {

/// The named points of a category: those of all assets that can be in it.
struct ClassKeypoints {
  std::vector<std::string> names;
  std::vector<std::array<int, 2>> skeleton;  ///< indices of names
  std::vector<std::array<int, 2>> mirrored;
};

/// By asset name, then in the asset's order; a name that several assets have is one point.
std::vector<ClassKeypoints> class_keypoints(const std::vector<OfferedAsset>& assets,
                                            const std::vector<std::string>& categories);

/// The next of the complete frames, by rising index; none at the end.
using FrameCursor = std::function<Result<std::optional<CommittedFrame>>()>;

struct Dataset {
  std::string name;
  std::uint64_t seed = 0;                        ///< of the campaign; the splits' too
  std::vector<std::string> categories;           ///< category k of labels.json is categories[k - 1]
  std::vector<ClassKeypoints> keypoints;         ///< one for each category
  std::vector<OfferedAsset> assets;              ///< that a frame may hold, by name
  bool has_images = true;                        ///< false: labels only, nothing was rendered
  ImageFormat image_format = ImageFormat::kPng;  ///< of their pictures
  bool has_depth = false;
  std::function<FrameCursor()> frames;  ///< starts at the first frame
};

}  // namespace seedframe
