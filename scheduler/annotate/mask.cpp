#include "annotate/mask.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>

namespace seedframe {

Mask::Mask(const Image<std::uint16_t>& instance_ids, int id, const PixelRect& box)
    : ids_(&instance_ids), id_(static_cast<std::uint16_t>(id)), box_(box) {
  assert(id > 0 && id <= 65535);
  assert(box.x >= 0 && box.y >= 0 && box.end_x() <= instance_ids.width &&
         box.end_y() <= instance_ids.height);
}

std::int64_t Mask::area_px() const {
  std::int64_t area = 0;
  for (int row = box_.y; row < box_.end_y(); ++row) {
    for (int column = box_.x; column < box_.end_x(); ++column) area += at(row, column);
  }
  return area;
}

namespace {

constexpr std::size_t kLanes = 16;  // pixels that are compared at once
template <class T>
using Lanes = std::array<T, kLanes>;

/// Where pixels are of the instance and those above them not, or the other way round; `above`
/// becomes these.
void compare(const Lanes<std::uint16_t>& ids, std::uint16_t id, std::uint8_t* above,
             std::uint8_t* changed) {
  Lanes<std::uint8_t> inside;
  for (std::size_t i = 0; i < kLanes; ++i) inside[i] = ids[i] == id ? 1 : 0;
  Lanes<std::uint8_t> before;
  std::memcpy(before.data(), above, kLanes);
  std::memcpy(above, inside.data(), kLanes);
  for (std::size_t i = 0; i < kLanes; ++i) before[i] ^= inside[i];
  std::memcpy(changed, before.data(), kLanes);
}

}  // namespace

void Mask::changes_by_column(std::vector<Change>& changes) const {
  if (box_.width == 0) return;
  const auto width = static_cast<std::size_t>(box_.width);
  // Row by row, as the image lies in memory: 1 where a pixel is not as the one above it.
  const std::size_t padded = (width + kLanes - 1) / kLanes * kLanes;
  std::vector<std::uint8_t> above(padded, 0);
  std::vector<std::uint8_t> changed(padded, 0);
  std::vector<Change> by_row;
  std::vector<std::size_t> next(width + 1, 0);  // first counts a column behind, then positions
  for (int row = box_.y; row <= box_.end_y(); ++row) {
    if (row < box_.end_y()) {
      const std::uint16_t* ids = &ids_->at(row, box_.x);
      for (std::size_t i = 0; i < width; i += kLanes) {
        Lanes<std::uint16_t> id_of{};  // what is behind the box's width is of no instance
        std::memcpy(id_of.data(), ids + i, 2 * std::min(kLanes, width - i));
        compare(id_of, id_, above.data() + i, changed.data() + i);
      }
    } else {
      std::copy(above.begin(), above.end(), changed.begin());
    }
    for (std::size_t word = 0; word < changed.size(); word += 8) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, changed.data() + word, sizeof eight);
      for (; eight != 0; eight &= eight - 1) {
        const std::size_t column = word + static_cast<std::size_t>(std::countr_zero(eight)) / 8;
        by_row.push_back({box_.x + static_cast<std::int32_t>(column), row});
        ++next[column + 1];
      }
    }
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  changes.resize(by_row.size());
  for (const Change& change : by_row) {
    changes[next[static_cast<std::size_t>(change.column - box_.x)]++] = change;
  }
}

}  // namespace seedframe
