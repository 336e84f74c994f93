#include "preview/twin_preview.h"

#include <algorithm>
#include <optional>

#include <tbb/parallel_for.h>

#include "picture/pixel_scaling.h"
#include "preview/twin_shading.h"
#include "spec/scaled_view.h"
#include "twin/twin.h"

namespace seedframe {
namespace {

constexpr int kShadedPoints = 2;  // of a pixel, both ways

struct Looked {
  PreviewedFrame frame;
  Shading shading;
};

Result<Looked> look_at(const SceneExpander& expander, const std::vector<std::string>& categories,
                       std::int64_t index, int most_width, TwinTracer& tracer) {
  const Result<ExpandedFrame> expanded = expander.expand(index, {.id = false});
  if (!expanded) return forward_error(expanded);
  const int width = expanded->spec.render.width;
  const double scale = std::min(1.0, static_cast<double>(most_width) / width);
  const FrameSpec spec = scaled_view(expanded->spec, scale);
  const Result<Twin> twin = tracer.trace(spec, expanded->meshes, TwinTracer::Passes::kIdsOnly);
  if (!twin) return forward_error(twin);
  Result<FrameLabels> labels = make_labels(spec, categories, twin->instance_ids);
  if (!labels) return forward_error(labels);
  // Of a whole number of points a pixel, whatever the sides were rounded to.
  FrameSpec fine = scaled_view(spec, kShadedPoints);
  fine.render.depth = fine.render.normal = true;
  const Result<Twin> fine_twin = tracer.trace(fine, expanded->meshes, TwinTracer::Passes::kAsked);
  if (!fine_twin) return forward_error(fine_twin);
  Looked looked;
  looked.frame.index = index;
  looked.frame.scale = static_cast<double>(width) / spec.render.width;
  looked.frame.content.labels = std::move(*labels);
  looked.frame.content.instance_ids = twin->instance_ids;
  looked.shading = shaded(fine, expanded->world_from_camera, *fine_twin);
  return looked;
}

}  // namespace

Result<std::vector<PreviewedFrame>> preview_by_twin(const SceneExpander& expander,
                                                    const std::vector<std::string>& categories,
                                                    const std::vector<std::int64_t>& frames,
                                                    int most_width) {
  TwinTracer tracer;
  std::vector<std::optional<Result<Looked>>> results(frames.size());
  tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t i) {
    results[i] = look_at(expander, categories, frames[i], most_width, tracer);
  });
  std::vector<PreviewedFrame> previewed;
  std::vector<Shading> shadings;
  for (std::optional<Result<Looked>>& result : results) {
    if (!*result) return forward_error(*result);
    previewed.push_back(std::move((*result)->frame));
    shadings.push_back(std::move((*result)->shading));
  }
  const double exposure = exposure_for(shadings);
  tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t i) {
    const Image<std::uint16_t>& ids = previewed[i].content.instance_ids;
    previewed[i].content.image =
        shrunk(shaded_display(shadings[i].light, exposure), ids.width, ids.height);
  });
  return previewed;
}

}  // namespace seedframe
