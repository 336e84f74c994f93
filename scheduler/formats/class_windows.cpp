#include "formats/class_windows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/portable_math.h"

namespace seedframe {
namespace {

/// How many pixels of any rectangle are of some categories (Crow 1984: summed-area tables).
class ClassSums {
 public:
  template <class Counted>
  ClassSums(const Image<std::uint8_t>& classes, const Counted& counted)
      : sums_(classes.width + 1, classes.height + 1) {
    for (int row = 0; row < classes.height; ++row) {
      std::int32_t line = 0;
      for (int column = 0; column < classes.width; ++column) {
        line += counted(classes.at(row, column)) ? 1 : 0;
        sums_.at(row + 1, column + 1) = sums_.at(row, column + 1) + line;
      }
    }
  }

  std::int32_t in_square(int x, int y, int side) const {
    return sums_.at(y + side, x + side) - sums_.at(y, x + side) - sums_.at(y + side, x) +
           sums_.at(y, x);
  }

 private:
  Image<std::int32_t> sums_;
};

/// Calls visit(x, y) for every place of a square of that side that the rule lets pass; ends when
/// it returns false.
template <class Visit>
void for_each_place(const Image<std::uint8_t>& classes, const ClassSums& own,
                    const ClassSums& allowed, int side, const Visit& visit) {
  const std::int32_t area = side * side;
  for (int y = 0; y + side <= classes.height; ++y) {
    for (int x = 0; x + side <= classes.width; ++x) {
      const bool passes = allowed.in_square(x, y, side) == area &&
                          own.in_square(x, y, side) >= kLeastOwnShare * area;
      if (passes && !visit(x, y)) return;
    }
  }
}

}  // namespace

Image<std::uint8_t> class_image(const FrameLabels& labels,
                                const Image<std::uint16_t>& instance_ids) {
  std::vector<std::uint8_t> category_of(kLargestImageId + 1U, 0);
  for (const InstanceLabel& label : labels.instances) {
    category_of[static_cast<std::size_t>(label.id)] = static_cast<std::uint8_t>(label.category);
  }
  Image<std::uint8_t> classes(instance_ids.width, instance_ids.height);
  std::transform(instance_ids.values.begin(), instance_ids.values.end(), classes.values.begin(),
                 [&](std::uint16_t id) { return category_of[id]; });
  return classes;
}

std::optional<PixelRect> draw_window(const Image<std::uint8_t>& classes, const WindowRule& rule,
                                     const PhiloxStream& sides, const PhiloxStream& places,
                                     const PhiloxStream::Position& position) {
  const ClassSums own(classes, [&](int category) { return category == rule.category; });
  const ClassSums allowed(classes, [&](int category) {
    return category == rule.category ||
           std::find(rule.beside.begin(), rule.beside.end(), category) != rule.beside.end();
  });
  const int shorter = std::min(classes.width, classes.height);
  const int least = std::max(rule.min_side, std::min(kLeastWindowSide, shorter));
  if (least > shorter) return std::nullopt;
  const int most = std::max(least, shorter / 2);
  const double ratio = static_cast<double>(most) / least;
  int side = static_cast<int>(least * portable::pow(ratio, sides.uniform(position)));
  while (true) {
    std::int64_t count = 0;
    for_each_place(classes, own, allowed, side, [&](int, int) { return ++count > 0; });
    if (count > 0) {
      auto left = static_cast<std::int64_t>(places.uniform(position) * static_cast<double>(count));
      PixelRect window;
      for_each_place(classes, own, allowed, side, [&](int x, int y) {
        window = {x, y, side, side};
        return left-- > 0;
      });
      return window;
    }
    if (side == least) return std::nullopt;
    side = std::max(least, side * 3 / 4);
  }
}

}  // namespace seedframe
