#include "scene/view_window.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "rays/projected_bounds.h"

namespace seedframe {
namespace {

/// Of the sides of a window: Blender's pixels may be 200 times as long as wide, not more.
constexpr double kLargestAspect = 100.0;

/// What of the image an instance spans; none: nothing.
std::optional<PixelBounds> bounds_in_image(const PlacedInstance& instance,
                                           const PixelCamera& camera) {
  if (!instance.asset || instance.spec.hidden_from.camera) return std::nullopt;
  const auto bounds = projected_bounds(
      instance.asset->mesh, Eigen::Affine3d(instance.spec.camera_from_object.matrix()), camera);
  return bounds ? clipped_to_image(*bounds, camera) : std::nullopt;
}

/// As low as a number may be drawn, one of `count` indices.
std::size_t index_of(double uniform, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(uniform * static_cast<double>(count)));
}

/// Lengthens a side, half on each end.
void widen(double& low, double& high, double least) {
  const double more = 0.5 * std::max(0.0, least - (high - low));
  low -= more;
  high += more;
}

}  // namespace

PixelCamera pixel_camera_of(const FrameDraft& draft) {
  const CameraSpec& camera = draft.spec.camera;
  return {draft.spec.render.width, draft.spec.render.height, camera.focal_px,
          camera.center_px,        camera.clip_start_m,      camera.clip_end_m};
}

PixelRect region_of_objects(const FrameDraft& draft) {
  const PixelCamera camera = pixel_camera_of(draft);
  PixelRect region;
  for (const PlacedInstance& instance : draft.placed) {
    if (instance.spec.id == 0) continue;
    const auto bounds = bounds_in_image(instance, camera);
    if (!bounds) continue;
    // A pixel is the instance's if its centre is; one more for what rounds, and for levels of
    // detail, which may be off by 1/20.
    const int left = std::max(0, static_cast<int>(std::floor(bounds->left)) - 1);
    const int top = std::max(0, static_cast<int>(std::floor(bounds->top)) - 1);
    const int right = std::min(camera.width, static_cast<int>(std::ceil(bounds->right)) + 2);
    const int bottom = std::min(camera.height, static_cast<int>(std::ceil(bounds->bottom)) + 2);
    region = union_of(region, {left, top, right - left, bottom - top});
  }
  return region.empty() ? PixelRect{0, 0, 1, 1} : region;
}

PatchWindow::PatchWindow(const PatchConfig& config, std::uint64_t seed)
    : config_(config), stream_(seed, "patches.target") {}

std::size_t PatchWindow::choose(const FrameDraft& draft, const std::vector<std::size_t>& seen,
                                const EvaluationContext& context) const {
  std::set<int> categories;
  for (const std::size_t i : seen) categories.insert(draft.placed[i].spec.category);
  PhiloxStream::Position position = context.position(Level::kFrame);
  position.copy = 0;
  const int category = *std::next(
      categories.begin(),
      static_cast<std::ptrdiff_t>(index_of(stream_.uniform(position), categories.size())));
  std::vector<std::size_t> of_category;
  std::copy_if(seen.begin(), seen.end(), std::back_inserter(of_category),
               [&](std::size_t i) { return draft.placed[i].spec.category == category; });
  position.copy = 1;
  return of_category[index_of(stream_.uniform(position), of_category.size())];
}

void PatchWindow::cut(FrameDraft& draft, std::size_t target) const {
  PixelBounds window =
      bounds_in_image(draft.placed[target], pixel_camera_of(draft)).value_or(PixelBounds{});
  const double longer = std::max(window.right - window.left, window.bottom - window.top);
  const double least = config_.keep_shape ? longer : longer / kLargestAspect;
  widen(window.left, window.right, least);
  widen(window.top, window.bottom, least);
  // Pixel centres are whole numbers, so the patch's own corner is at -1/2.
  const double columns_per_pixel = config_.size / (window.right - window.left);
  const double rows_per_pixel = config_.size / (window.bottom - window.top);
  CameraSpec& camera = draft.spec.camera;
  camera.center_px = {(camera.center_px[0] - window.left) * columns_per_pixel - 0.5,
                      (camera.center_px[1] - window.top) * rows_per_pixel - 0.5};
  camera.focal_px = {camera.focal_px[0] * columns_per_pixel, camera.focal_px[1] * rows_per_pixel};
  draft.spec.render.width = draft.spec.render.height = config_.size;
  draft.spec.labels.target = draft.placed[target].spec.id;
}

}  // namespace seedframe
