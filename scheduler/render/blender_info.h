// Which Blender there is.
#pragma once

#include <string>

#include "base/error.h"
#include "render/blender_program.h"

namespace seedframe {

struct BlenderInfo {
  BlenderProgram program;
  std::string sha256;   ///< over the program itself, see sha256_of
  std::string version;  ///< "3.4.1"
  int major = 0;
  int minor = 0;
  int patch = 0;
  /// Seedframe's own tests run with this version (docs/blender_versions.md); others from 3.3 on are
  /// expected to work.
  bool tested = false;
};

/// Finds Blender (see find_blender), asks it for its version and hashes it. A module is not started
/// for that. kEnvironment errors: not found, not executable, not Blender, older than 3.3; each says
/// what to do.
Result<BlenderInfo> probe_blender(const std::string& name = "blender");

/// Reads the first line of `blender --version`: "Blender 3.4.1", "Blender 4.2.0 LTS".
Result<BlenderInfo> parse_blender_version(const std::string& output);

/// "3.4, 4.2, 4.5 and 5.0": those that `tested` is true of.
std::string tested_blender_versions();

}  // namespace seedframe
