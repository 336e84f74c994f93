#include "image/edge_error.h"

#include <cmath>
#include <limits>

#include "image/luminance.h"

namespace seedframe {
namespace {

/// A pixel of an edge and the step that leads away from it.
struct EdgeSide {
  int row, column;
  int down, right;
};

template <class T>
double luminance_at(const Image<T>& image, int row, int column) {
  return luminance(image.at(row, column, 0), image.at(row, column, 1), image.at(row, column, 2));
}

template <class T>
class EdgeSums {
 public:
  EdgeSums(const Image<T>& rendering, const Image<T>& reference, const Image<std::uint16_t>& ids)
      : rendering_(rendering), reference_(reference), ids_(ids) {}

  void add(const EdgeSide& a, const EdgeSide& b) {
    const double measured = side(rendering_, a) - side(rendering_, b);
    const double expected = side(reference_, a) - side(reference_, b);
    const double difference = measured - expected;
    if (!std::isfinite(difference)) return;
    ++pairs_;
    contrast_ += std::abs(expected);
    kept_ += expected < 0.0 ? -measured : expected > 0.0 ? measured : 0.0;
    squares_ += difference * difference;
  }

  EdgeError error() const {
    EdgeError error;
    error.pairs = pairs_;
    if (pairs_ == 0) return error;
    error.contrast = contrast_ / static_cast<double>(pairs_);
    error.mean_square = squares_ / static_cast<double>(pairs_);
    if (contrast_ > 0.0) error.kept = kept_ / contrast_;
    return error;
  }

 private:
  double side(const Image<T>& image, const EdgeSide& side) const {
    const int row = side.row + side.down;
    const int column = side.column + side.right;
    const double nearest = luminance_at(image, side.row, side.column);
    const bool inside = row >= 0 && row < ids_.height && column >= 0 && column < ids_.width;
    if (!inside || ids_.at(row, column) != ids_.at(side.row, side.column)) return nearest;
    return (nearest + luminance_at(image, row, column)) / 2.0;
  }

  const Image<T>& rendering_;
  const Image<T>& reference_;
  const Image<std::uint16_t>& ids_;
  std::int64_t pairs_ = 0;
  double contrast_ = 0.0;
  double kept_ = 0.0;
  double squares_ = 0.0;
};

template <class T>
EdgeError edge_error_of(const Image<T>& rendering, const Image<T>& reference,
                        const Image<std::uint16_t>& ids) {
  assert(rendering.width == ids.width && rendering.height == ids.height);
  assert(reference.width == ids.width && reference.height == ids.height);
  assert(rendering.channels >= 3 && reference.channels >= 3 && ids.channels == 1);
  EdgeSums<T> sums(rendering, reference, ids);
  for (int row = 0; row < ids.height; ++row) {
    for (int column = 0; column < ids.width; ++column) {
      const std::uint16_t id = ids.at(row, column);
      if (column + 1 < ids.width && ids.at(row, column + 1) != id) {
        sums.add({row, column, 0, -1}, {row, column + 1, 0, 1});
      }
      if (row + 1 < ids.height && ids.at(row + 1, column) != id) {
        sums.add({row, column, -1, 0}, {row + 1, column, 1, 0});
      }
    }
  }
  return sums.error();
}

}  // namespace

double EdgeError::noise() const { return std::sqrt(mean_square); }

double EdgeError::signal_to_noise() const {
  return mean_square > 0.0 ? contrast / noise() : std::numeric_limits<double>::infinity();
}

EdgeError edge_error(const Image<float>& rendering, const Image<float>& reference,
                     const Image<std::uint16_t>& ids) {
  return edge_error_of(rendering, reference, ids);
}

EdgeError edge_error(const Image<std::uint8_t>& rendering, const Image<std::uint8_t>& reference,
                     const Image<std::uint16_t>& ids) {
  return edge_error_of(rendering, reference, ids);
}

}  // namespace seedframe
