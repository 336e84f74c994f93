#include "campaign/color_config.h"

#include <vector>

namespace seedframe {
namespace fs = std::filesystem;

Result<fs::path> find_ocio_config(const BlenderInfo& blender) {
  std::error_code error;
  const bool is_module = !blender.program.module.empty();
  const fs::path folder =
      is_module ? blender.program.module : fs::canonical(blender.program.path, error).parent_path();
  const fs::path prefix = folder.parent_path();
  const std::string version = fmt::format("{}.{}", blender.major, blender.minor);
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
      blender.program.name(), candidates.front().string());
}

}  // namespace seedframe
