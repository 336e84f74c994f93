#include "annotate/mask.h"

namespace seedframe {

Mask::Mask(const Image<std::uint16_t>& instance_ids, int id, const PixelBox& box)
    : ids_(&instance_ids), id_(static_cast<std::uint16_t>(id)), box_(box) {
  assert(id > 0 && id <= 65535);
  assert(box.x >= 0 && box.y >= 0 && box.x + box.width <= instance_ids.width &&
         box.y + box.height <= instance_ids.height);
}

std::int64_t Mask::area_px() const {
  std::int64_t area = 0;
  for (int row = box_.y; row < box_.y + box_.height; ++row) {
    for (int column = box_.x; column < box_.x + box_.width; ++column) area += at(row, column);
  }
  return area;
}

}  // namespace seedframe
