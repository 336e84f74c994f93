// A finished campaign as the exporters see it, read from its frames' folders only.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "annotate/labels.h"
#include "base/error.h"
#include "frames/manifest.h"
#include "image/image.h"
#include "scene/offered_assets.h"

namespace seedframe {

struct DatasetFrame {
  std::int64_t index = 0;  ///< over the whole campaign
  int scene = 0;
  std::filesystem::path folder;  ///< holds what frames/campaign_files.h names
  std::string frame_id;
};

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
using FrameCursor = std::function<Result<std::optional<DatasetFrame>>()>;

struct Dataset {
  std::string name;
  std::uint64_t seed = 0;                 ///< of the campaign; the splits' too
  std::vector<std::string> categories;    ///< category k of labels.json is categories[k - 1]
  std::vector<ClassKeypoints> keypoints;  ///< one for each category
  std::vector<OfferedAsset> assets;       ///< that a frame may hold, by name
  bool has_images = true;                 ///< false: labels only, nothing was rendered
  bool has_depth = false;
  std::function<FrameCursor()> frames;  ///< starts at the first frame
};

/// Which files of a frame are needed beside its labels.
struct FrameParts {
  bool image_file = false;    ///< image.png, as it is
  bool image_pixels = false;  ///< the same, decoded
  bool depth = false;
};

struct LoadedFrame {
  FrameLabels labels;
  Image<std::uint16_t> instance_ids;
  std::optional<Image<std::uint8_t>> image;  ///< RGB
  std::optional<Image<float>> depth;         ///< planar, metres
};

/// The files of a frame, read, and found to be those of its manifest.
class FrameFiles {
 public:
  /// kCorrupt errors name the frame and the file that is missing or not as it was written.
  static Result<FrameFiles> open(const Dataset& dataset, const DatasetFrame& frame,
                                 const FrameParts& parts);

  /// Changes whenever any file of the frame does, its id or its scene.
  const std::string& key() const { return key_; }
  /// As the manifest has it; empty for a file that the frame does not have.
  std::string sha256(const char* name) const;

  /// Decodes, and compares labels and pixels. kCorrupt errors name the frame, and the instance:
  /// another area or box than the pixels have, an id that only one of the files knows, other
  /// categories than the dataset's.
  Result<LoadedFrame> load() const;

 private:
  const Dataset* dataset_ = nullptr;
  const DatasetFrame* frame_ = nullptr;
  FrameParts parts_;
  Manifest manifest_;
  std::string key_;
  std::string labels_;
  std::string instances_;
};

}  // namespace seedframe
