#include "quality/reference.h"

#include <utility>

#include "base/philox.h"

namespace seedframe {

Result<ExpandedFrame> expand_half(const PreparedCampaign& prepared, std::int64_t frame,
                                  ReferenceHalf half) {
  Result<ExpandedFrame> expanded = prepared.expander.expand(frame, {.id = false});
  if (!expanded) return expanded;
  const PhiloxStream stream(prepared.settings.seed, half == ReferenceHalf::kA
                                                        ? "quality.reference.a"
                                                        : "quality.reference.b");
  expanded->spec.render.seed = stream.cycles_seed({.frame = static_cast<std::uint32_t>(frame)});
  expanded->id = frame_id(expanded->spec);
  return expanded;
}

Result<Reference> make_reference(const FramePasses& a, const FramePasses& b,
                                 const ColorManagement& color, const ImageSettings& view) {
  Image<float> mean = mean_of(a.combined, b.combined);
  Result<Image<std::uint8_t>> display_a = color.apply(a.combined, view);
  if (!display_a) return forward_error(display_a);
  Result<Image<std::uint8_t>> display_b = color.apply(b.combined, view);
  if (!display_b) return forward_error(display_b);
  Result<Image<std::uint8_t>> display = color.apply(mean, view);
  if (!display) return forward_error(display);
  return Reference{{std::move(mean), std::move(*display)},
                   reference_variance({a.combined, std::move(*display_a)},
                                      {b.combined, std::move(*display_b)}, a.instance_ids),
                   a.instance_ids};
}

RenderingError error_against(const Reference& reference, const Picture& rendering) {
  return without_variance(rendering_error(rendering, reference.picture, reference.ids),
                          reference.variance);
}

}  // namespace seedframe
