#include "annotate/extents.h"

#include <algorithm>
#include <limits>

namespace seedframe {
namespace {

constexpr std::size_t kIdCount = std::numeric_limits<std::uint16_t>::max() + std::size_t{1};

/// Adds the pixels [begin, end) of one row.
void add_run(InstanceExtent& extent, int row, int begin, int end) {
  PixelBox& box = extent.box;
  const int right = std::max(box.x + box.width, end);
  box.x = std::min(box.x, begin);
  box.width = right - box.x;
  box.height = row + 1 - box.y;
  extent.area_px += end - begin;
}

}  // namespace

std::vector<InstanceExtent> measure_extents(const Image<std::uint16_t>& instance_ids) {
  std::vector<InstanceExtent> extents;
  std::vector<std::int32_t> extent_of_id(kIdCount, -1);
  const std::uint16_t* pixel = instance_ids.values.data();
  for (int row = 0; row < instance_ids.height; ++row, pixel += instance_ids.width) {
    for (int begin = 0; begin < instance_ids.width;) {
      const std::uint16_t id = pixel[begin];
      int end = begin + 1;
      while (end < instance_ids.width && pixel[end] == id) ++end;
      if (id != 0) {
        std::int32_t& known = extent_of_id[id];
        if (known < 0) {
          known = static_cast<std::int32_t>(extents.size());
          extents.push_back({.id = id,
                             .box = {.x = begin, .y = row, .width = 0, .height = 0},
                             .first_row = row,
                             .first_column = begin});
        }
        add_run(extents[static_cast<std::size_t>(known)], row, begin, end);
      }
      begin = end;
    }
  }
  return extents;
}

}  // namespace seedframe
