#include "campaign/color_config.h"

#include <vector>

namespace seedframe {
namespace fs = std::filesystem;

Result<fs::path> find_ocio_config(const fs::path& blender, int major, int minor) {
  std::error_code error;
  const fs::path program = fs::canonical(blender, error);
  const fs::path folder = program.parent_path();
  const fs::path prefix = folder.parent_path();
  const std::string version = fmt::format("{}.{}", major, minor);
  const fs::path inside = fs::path("datafiles") / "colormanagement" / "config.ocio";
  const std::vector<fs::path> candidates = {folder / version / inside,
                                            prefix / "share" / "blender" / version / inside,
                                            prefix / "share" / "blender" / inside};
  for (const fs::path& candidate : candidates) {
    if (fs::is_regular_file(candidate, error)) return candidate;
  }
  return fail(
      ErrorKind::kEnvironment,
      "no OpenColorIO config was found for {} (looked for {}): set image.ocio_config in the "
      "campaign's config",
      blender.string(), candidates.front().string());
}

}  // namespace seedframe
