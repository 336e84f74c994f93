// Convolution of rasters with kernels that are products of a row and a column.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <vector>

namespace seedframe {

/// One channel of a raster; row 0 on top.
template <class T>
using Plane = Eigen::Array<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// `radius` more pixels on each side, like those on the edge.
template <class T>
Plane<T> with_border(const Plane<T>& plane, int radius) {
  Plane<T> wide(plane.rows() + 2 * radius, plane.cols() + 2 * radius);
  for (Eigen::Index row = 0; row < wide.rows(); ++row) {
    const auto from = std::clamp<Eigen::Index>(row - radius, 0, plane.rows() - 1);
    wide.row(row).head(radius).setConstant(plane(from, 0));
    wide.row(row).segment(radius, plane.cols()) = plane.row(from);
    wide.row(row).tail(radius).setConstant(plane(from, plane.cols() - 1));
  }
  return wide;
}

/// Each row correlated with the kernel where it lies inside: kernel.size() − 1 columns less.
template <class T>
Plane<T> filtered_rows(const Plane<T>& plane, const std::vector<T>& kernel) {
  const auto taps = static_cast<Eigen::Index>(kernel.size());
  assert(taps > 0 && plane.cols() >= taps);
  const Eigen::Index columns = plane.cols() - taps + 1;
  Plane<T> filtered = Plane<T>::Zero(plane.rows(), columns);
  for (Eigen::Index row = 0; row < plane.rows(); ++row) {
    for (Eigen::Index tap = 0; tap < taps; ++tap) {
      filtered.row(row) +=
          kernel[static_cast<std::size_t>(tap)] * plane.row(row).segment(tap, columns);
    }
  }
  return filtered;
}

/// The same of columns.
template <class T>
Plane<T> filtered_columns(const Plane<T>& plane, const std::vector<T>& kernel) {
  const auto taps = static_cast<Eigen::Index>(kernel.size());
  assert(taps > 0 && plane.rows() >= taps);
  Plane<T> filtered = Plane<T>::Zero(plane.rows() - taps + 1, plane.cols());
  for (Eigen::Index row = 0; row < filtered.rows(); ++row) {
    for (Eigen::Index tap = 0; tap < taps; ++tap) {
      filtered.row(row) += kernel[static_cast<std::size_t>(tap)] * plane.row(row + tap);
    }
  }
  return filtered;
}

}  // namespace seedframe
