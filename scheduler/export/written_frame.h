// What was written of one frame, read back.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "export/frame_record.h"

namespace seedframe {

struct WrittenFrame {
  std::map<std::string, std::string> files;  ///< bytes by path, without placed images
  std::vector<Chunk> chunks;

  /// Empty when there is no such file.
  const std::string& file(const std::string& path) const {
    static const std::string none;
    const auto found = files.find(path);
    return found == files.end() ? none : found->second;
  }
};

}  // namespace seedframe
