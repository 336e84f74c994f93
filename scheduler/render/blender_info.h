// Which Blender there is.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace seedframe {

struct BlenderInfo {
  std::filesystem::path program;  ///< absolute
  std::string version;            ///< "3.4.1"
  int major = 0;
  int minor = 0;
  int patch = 0;
  /// Seedframe's own tests run with this version (3.4); others from 3.3 on are expected to work.
  bool tested = false;
};

/// The program by that path, or of that name in PATH, absolute. kEnvironment errors: not found, not
/// executable.
Result<std::filesystem::path> find_blender(const std::string& program);

/// Finds `program` (a path, or a name to look up in PATH) and asks it for its version. kEnvironment
/// errors: not found, not executable, not Blender, older than 3.3; each says what to do.
Result<BlenderInfo> probe_blender(const std::string& program = "blender");

/// Reads the first line of `blender --version`: "Blender 3.4.1", "Blender 4.2.0 LTS".
Result<BlenderInfo> parse_blender_version(const std::string& output);

}  // namespace seedframe
