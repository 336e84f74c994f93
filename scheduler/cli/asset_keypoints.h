// seedframe asset keypoints: named points of an asset, shown and set.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace seedframe {

struct KeypointArguments {
  std::string asset;
  std::vector<std::string> points;    ///< "tip=0,0,-0.02", metres
  std::vector<std::string> inside;    ///< names of points that their own surface does not hide
  std::vector<std::string> lines;     ///< "head-tip"
  std::vector<std::string> mirrored;  ///< "left-right"
  bool clear = false;
};

/// Sets the asset's keypoints if there are any in the arguments, and prints them. Returns the exit
/// code.
int asset_keypoints(const std::filesystem::path& library_root, const KeypointArguments& arguments);

}  // namespace seedframe
