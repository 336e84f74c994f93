#include "annotate/extents.h"

#include <algorithm>
#include <cstring>

namespace seedframe {
namespace {

constexpr std::size_t kIdCount = kLargestImageId + std::size_t{1};

/// Where the run of equal ids that begins at `begin` ends, four pixels at a time.
int end_of_run(const std::uint16_t* row, int begin, int width) {
  const std::uint16_t id = row[begin];
  const std::uint64_t four = std::uint64_t{id} * 0x0001'0001'0001'0001U;
  int end = begin + 1;
  for (; end + 4 <= width; end += 4) {
    std::uint64_t next = 0;
    std::memcpy(&next, row + end, sizeof next);
    if (next != four) break;
  }
  while (end < width && row[end] == id) ++end;
  return end;
}

/// Adds the pixels [begin, end) of one row.
void add_run(InstanceExtent& extent, int row, int begin, int end) {
  PixelRect& box = extent.box;
  const int right = std::max(box.end_x(), end);
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
      const int end = end_of_run(pixel, begin, instance_ids.width);
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
