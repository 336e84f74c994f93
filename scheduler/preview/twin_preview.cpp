#include "preview/twin_preview.h"

#include <algorithm>
#include <optional>

#include <tbb/parallel_for.h>

#include "preview/display_curve.h"
#include "preview/twin_shading.h"
#include "spec/scaled_view.h"
#include "twin/twin.h"

namespace seedframe {
namespace {

struct Looked {
  PreviewedFrame frame;
  Shading shading;
  ImageSettings settings;
};

Result<Looked> look_at(const SceneExpander& expander, const std::vector<std::string>& categories,
                       std::int64_t index, int most_width, TwinTracer& tracer,
                       ShadingImages& images) {
  const Result<ExpandedFrame> expanded = expander.expand(index, {.id = false});
  if (!expanded) return forward_error(expanded);
  const int width = expanded->spec.render.width;
  const double scale = std::min(1.0, static_cast<double>(most_width) / width);
  const FrameSpec spec = scaled_view(expanded->spec, scale);
  const Result<Twin> twin = tracer.trace(spec, expanded->meshes, TwinTracer::Passes::kIdsOnly);
  if (!twin) return forward_error(twin);
  Result<FrameLabels> labels = make_labels(spec, categories, twin->instance_ids);
  if (!labels) return forward_error(labels);
  Result<Shading> shading = shaded(spec, *expanded, tracer, images);
  if (!shading) return forward_error(shading);
  Looked looked;
  looked.frame.index = index;
  looked.frame.scale = static_cast<double>(width) / spec.render.width;
  looked.frame.content.labels = std::move(*labels);
  looked.frame.content.instance_ids = twin->instance_ids;
  looked.shading = std::move(*shading);
  looked.settings = spec.image;
  return looked;
}

}  // namespace

Result<std::vector<PreviewedFrame>> preview_by_twin(const SceneExpander& expander,
                                                    const std::vector<std::string>& categories,
                                                    const std::vector<std::int64_t>& frames,
                                                    int most_width) {
  TwinTracer tracer;
  ShadingImages images;
  std::vector<std::optional<Result<Looked>>> results(frames.size());
  tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t i) {
    results[i] = look_at(expander, categories, frames[i], most_width, tracer, images);
  });
  std::vector<PreviewedFrame> previewed;
  std::vector<Shading> shadings;
  std::vector<ImageSettings> settings;
  for (std::optional<Result<Looked>>& result : results) {
    if (!*result) return forward_error(*result);
    previewed.push_back(std::move((*result)->frame));
    shadings.push_back(std::move((*result)->shading));
    settings.push_back(std::move((*result)->settings));
  }
  const double exposure = exposure_for(shadings);
  tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t i) {
    previewed[i].content.image = DisplayCurve(settings[i], exposure).display(shadings[i].light);
  });
  return previewed;
}

}  // namespace seedframe
