#include "rays/pixel_camera.h"

namespace seedframe {

PixelRect enlarged_canvas(const PixelCamera& camera) {
  return {-camera.width, -camera.height, 3 * camera.width, 3 * camera.height};
}

PixelRays::PixelRays(const PixelCamera& camera) : canvas_(enlarged_canvas(camera)) {
  x_.reserve(static_cast<std::size_t>(canvas_.width));
  y_.reserve(static_cast<std::size_t>(canvas_.height));
  for (int x = canvas_.x; x < canvas_.end_x(); ++x) x_.push_back(camera.ray_x(x));
  for (int y = canvas_.y; y < canvas_.end_y(); ++y) y_.push_back(camera.ray_y(y));
}

}  // namespace seedframe
