// A finished campaign as the exporters see it, read from its frames' folders only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "annotate/labels.h"
#include "base/error.h"
#include "image/image.h"

namespace seedframe {

struct DatasetFrame {
  std::int64_t index = 0;  ///< over the whole campaign
  int scene = 0;
  std::filesystem::path folder;  ///< holds what base/campaign_files.h names
  std::string frame_id;
};

struct Dataset {
  std::string name;
  std::vector<std::string> categories;  ///< category k of labels.json is categories[k - 1]
  std::vector<DatasetFrame> frames;     ///< the complete ones, by rising index
  bool has_images = true;               ///< false: labels only, nothing was rendered
};

struct LoadedFrame {
  FrameLabels labels;
  Image<std::uint16_t> instance_ids;
};

/// Reads labels.json and instances.png and compares them pixel by pixel. kCorrupt errors name the
/// frame, and the instance: another area or box than the pixels have, an id that only one of the
/// files knows, a category that the dataset does not have.
Result<LoadedFrame> load_frame(const Dataset& dataset, const DatasetFrame& frame);

}  // namespace seedframe
