// On which faces the assets of a campaign can stand, found out once.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "assets/asset_library.h"
#include "mesh/stable_faces.h"

namespace seedframe {

/// Safe to use from several threads.
class StablePoses {
 public:
  /// stable_faces() of an asset at a scale, which is above 0; an error names the asset.
  Result<std::shared_ptr<const std::vector<StableFace>>> of(const Asset& asset,
                                                            const Eigen::Vector3d& scale);

 private:
  using Key = std::pair<std::string, std::array<double, 3>>;
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const std::vector<StableFace>>> known_;
};

}  // namespace seedframe
