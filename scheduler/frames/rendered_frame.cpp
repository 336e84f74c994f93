#include "frames/rendered_frame.h"

#include <algorithm>

#include "plan/pass_plan.h"

namespace seedframe {
namespace fs = std::filesystem;

fs::path rendered_passes(const fs::path& folder) { return folder / "rendered.exr"; }

fs::path sharp_passes(const fs::path& rendered) { return rendered.string() + ".sharp"; }

Result<FramePasses> read_rendered_frame(const FrameSpec& spec, const std::string& frame_id,
                                        const fs::path& rendered) {
  const PassPlan plan = plan_passes(spec);
  PassExpectation expected;
  expected.frame_id = frame_id;
  expected.width = spec.render.width;
  expected.height = spec.render.height;
  expected.depth = plan.depth;
  expected.normal = plan.normal;
  for (const InstanceSpec& instance : spec.instances) {
    expected.max_instance_id = std::max(expected.max_instance_id, instance.id);
  }
  Result<FramePasses> passes = read_passes(rendered, expected);
  if (!passes || !plan.sharp_rendering) return passes;
  Result<FramePasses> sharp = read_passes(sharp_passes(rendered), expected);
  if (!sharp) return sharp;
  sharp->combined = std::move(passes->combined);
  sharp->pixel_hashes["combined"] = passes->pixel_hashes["combined"];
  return sharp;
}

}  // namespace seedframe
