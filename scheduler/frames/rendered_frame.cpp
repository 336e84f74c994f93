#include "frames/rendered_frame.h"

#include <algorithm>

#include "base/files.h"
#include "frames/campaign_files.h"
#include "image/crop.h"
#include "plan/pass_plan.h"
#include "rays/ray_scene.h"
#include "spec/frame_spec_reader.h"

namespace seedframe {
namespace fs = std::filesystem;

fs::path rendered_passes(const fs::path& folder) { return folder / "rendered.exr"; }

fs::path sharp_passes(const fs::path& rendered) { return rendered.string() + ".sharp"; }

Result<FramePasses> read_rendered_frame(const FrameSpec& spec, const std::string& frame_id,
                                        const fs::path& rendered, bool sample_counts) {
  const PassPlan plan = plan_passes(spec);
  PassExpectation expected;
  expected.frame_id = frame_id;
  const PixelRect pixels = spec.render.rendered_pixels();
  expected.width = pixels.width;
  expected.height = pixels.height;
  expected.depth = plan.depth;
  expected.normal = plan.normal;
  for (const InstanceSpec& instance : spec.instances) {
    expected.max_instance_id = std::max(expected.max_instance_id, instance.id);
  }
  expected.sample_counts = sample_counts;
  Result<FramePasses> passes = read_passes(rendered, expected);
  if (!passes || !plan.sharp_rendering) return passes;
  expected.sample_counts = false;
  Result<FramePasses> sharp = read_passes(sharp_passes(rendered), expected);
  if (!sharp) return sharp;
  sharp->combined = std::move(passes->combined);
  sharp->sample_shares = std::move(passes->sample_shares);
  sharp->pixel_hashes["combined"] = passes->pixel_hashes["combined"];
  return sharp;
}

FramePasses on_whole_image(FramePasses rendered, const RenderSettings& render) {
  if (!render.region) return rendered;
  const auto place = [&](auto& image, auto fill) {
    image = placed_at(image, *render.region, render.width, render.height, fill);
  };
  place(rendered.combined, 0.0F);
  place(rendered.instance_ids, std::uint16_t{0});
  if (rendered.depth) place(*rendered.depth, kNoDepth);
  if (rendered.normal) place(*rendered.normal, 0.0F);
  return rendered;
}

Result<PixelRect> rendered_pixels_of(const fs::path& folder) {
  const fs::path path = folder / frame_files::kSpec;
  const Result<std::string> text = read_file(path);
  if (!text) return fail(ErrorKind::kCorrupt, "{}", text.error().message);
  const Json json = Json::parse(*text, nullptr, false);
  const Result<FrameSpec> spec = frame_spec_from_json(json, path.string());
  if (!spec) return fail(ErrorKind::kCorrupt, "{}", spec.error().message);
  return spec->render.rendered_pixels();
}

}  // namespace seedframe
