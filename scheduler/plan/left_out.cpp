#include "plan/left_out.h"

#include <fmt/format.h>

#include "plan/pass_plan.h"

namespace seedframe {

std::vector<LeftOut> left_out(const FrameSpec& spec) {
  const RenderSettings& render = spec.render;
  std::vector<LeftOut> list;
  if (spec.labels.source == LabelSource::kTwin) {
    list.push_back({"the picture, and Blender", "labels: geometry"});
  } else {
    if (!plan_passes(spec).sharp_rendering) {
      list.push_back({"a second rendering for the labels", "the camera is a pinhole (no f_stop)"});
    }
    if (render.region) {
      const PixelRect image{0, 0, render.width, render.height};
      const auto share =
          1.0 - static_cast<double>(render.region->area()) / static_cast<double>(image.area());
      list.push_back({fmt::format("{:.0f} % of the pixels: all but {} × {} from ({}, {})",
                                  100.0 * share, render.region->width, render.region->height,
                                  render.region->x, render.region->y),
                      "render.region"});
    }
  }
  if (!render.depth) list.push_back({"the pass depth", "render.passes does not name it"});
  if (!render.normal) list.push_back({"the pass normal", "render.passes does not name it"});
  return list;
}

}  // namespace seedframe
