// Which files frames are made of.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "assets/asset_library.h"
#include "base/file_hashes.h"

namespace seedframe {

/// Of one frame, or of many together. Attempts that did not meet the constraints count too, for
/// what they drew decided over the frame.
struct UsedFiles {
  std::map<std::string, std::shared_ptr<const Asset>> assets;            ///< by name
  std::map<std::string_view, std::shared_ptr<const HashedFile>> images;  ///< by their own SHA-256

  void add(const UsedFiles& other);
};

}  // namespace seedframe
