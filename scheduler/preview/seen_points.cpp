#include "preview/seen_points.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace seedframe {

std::size_t sample_number(int row, int column) {
  constexpr std::array<std::array<std::uint8_t, 4>, 4> kBayer = {
      {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}}};
  return kBayer[static_cast<std::size_t>(row % 4)][static_cast<std::size_t>(column % 4)];
}

std::array<std::int32_t, 4> points_around(const PixelGrid& one_of_four, int row, int column) {
  const int top = std::max(0, (row - 1) / 2), bottom = std::min(top + 1, one_of_four.height - 1);
  const int left = std::max(0, (column - 1) / 2);
  const int right = std::min(left + 1, one_of_four.width - 1);
  return {one_of_four.at(top, left), one_of_four.at(top, right), one_of_four.at(bottom, left),
          one_of_four.at(bottom, right)};
}

SeenPoints::SeenPoints(const RayImage& rays, const CameraSpec& camera)
    : rays_(rays),
      per_focal_(static_cast<float>(1.0 / std::sqrt(camera.focal_px[0] * camera.focal_px[1]))) {
  positions_.reserve(rays.depth.size());
  for (int row = 0; row < rays.height; ++row) {
    const double up = (camera.center_px[1] - row) / camera.focal_px[1];
    for (int column = 0; column < rays.width; ++column) {
      const double right = (column - camera.center_px[0]) / camera.focal_px[0];
      const double depth = rays.depth[positions_.size()];
      positions_.emplace_back(Eigen::Vector3d(right * depth, up * depth, -depth).cast<float>());
    }
  }
}

Eigen::Vector3d SeenPoints::above(std::int32_t pixel) const {
  constexpr double kLift = 3e-5;  // of the depth: beyond what float32 rounds
  const double lift = kLift * rays_.depth[static_cast<std::size_t>(pixel)];
  return position(pixel).cast<double>() + lift * normal(pixel).cast<double>();
}

PixelGrid SeenPoints::all_pixels() const {
  PixelGrid grid{rays_.width, rays_.height, std::vector<std::int32_t>(rays_.instance.size(), -1)};
  for (std::size_t i = 0; i < grid.pixels.size(); ++i) {
    if (rays_.instance[i] >= 0) grid.pixels[i] = static_cast<std::int32_t>(i);
  }
  return grid;
}

PixelGrid SeenPoints::one_of_four() const {
  PixelGrid grid{(rays_.width + 1) / 2, (rays_.height + 1) / 2, {}};
  grid.pixels.reserve(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      std::int32_t found = -1;
      for (int y = 2 * row; y < std::min(2 * row + 2, rays_.height) && found < 0; ++y) {
        for (int x = 2 * column; x < std::min(2 * column + 2, rays_.width) && found < 0; ++x) {
          const std::size_t pixel = rays_.index(x, y);
          if (rays_.instance[pixel] >= 0) found = static_cast<std::int32_t>(pixel);
        }
      }
      grid.pixels.push_back(found);
    }
  }
  return grid;
}

void SeenPoints::smooth(const PixelGrid& grid, std::vector<float>& values, int channels,
                        Reach reach) const {
  const int before = reach == Reach::kOneBefore ? 1 : 2, end = 4 - before;
  const std::vector<float> raw = values;
  const auto at = [&](int row, int column) {
    return &raw[(static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) +
                 static_cast<std::size_t>(column)) *
                static_cast<std::size_t>(channels)];
  };
  const auto is_even = [&](float value, int left, int right, int top, int bottom) {
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) {
        if (*at(y, x) != value && grid.at(y, x) >= 0) return false;
      }
    }
    return true;
  };
  std::vector<float> sums(static_cast<std::size_t>(channels));
  float* out = values.data();
  for (int row = 0; row < grid.height; ++row) {
    const int top = std::max(0, row - before), bottom = std::min(row + end, grid.height);
    for (int column = 0; column < grid.width; ++column, out += channels) {
      const std::int32_t own = grid.at(row, column);
      if (own < 0) continue;
      const float* mine = at(row, column);
      const int left = std::max(0, column - before), right = std::min(column + end, grid.width);
      // As in nearly all of a shadow, and out of it.
      if (channels == 1 && is_even(*mine, left, right, top, bottom)) continue;
      std::copy(mine, mine + channels, sums.begin());
      int count = 1;
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
          const std::int32_t other = grid.at(y, x);
          if (other < 0 || other == own) continue;
          const float* theirs = at(y, x);
          if (!on_same_surface(own, other)) continue;
          for (int c = 0; c < channels; ++c) sums[static_cast<std::size_t>(c)] += theirs[c];
          ++count;
        }
      }
      for (int c = 0; c < channels; ++c) {
        out[c] = sums[static_cast<std::size_t>(c)] / static_cast<float>(count);
      }
    }
  }
}

bool SeenPoints::on_surface_around(const PixelGrid& one_of_four, int row, int column) const {
  const std::array<std::int32_t, 4> around = points_around(one_of_four, row, column);
  const auto pixel = static_cast<std::int32_t>(rays_.index(column, row));
  return std::all_of(around.begin(), around.end(), [&](std::int32_t other) {
    return other >= 0 && on_same_surface(pixel, other);
  });
}

std::vector<std::int32_t> SeenPoints::points_for_pixels(const PixelGrid& one_of_four) const {
  constexpr std::array<std::array<int, 2>, 9> kNearest = {
      {{0, 0}, {0, 1}, {1, 0}, {0, -1}, {-1, 0}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
  std::vector<std::int32_t> found(rays_.instance.size(), -1);
  for (int row = 0; row < rays_.height; ++row) {
    for (int column = 0; column < rays_.width; ++column) {
      const std::size_t pixel = rays_.index(column, row);
      if (rays_.instance[pixel] < 0) continue;
      found[pixel] = row / 2 * one_of_four.width + column / 2;
      for (const auto& [down, right] : kNearest) {
        const int y = row / 2 + down, x = column / 2 + right;
        if (y < 0 || y >= one_of_four.height || x < 0 || x >= one_of_four.width) continue;
        const std::int32_t other = one_of_four.at(y, x);
        if (other < 0 || !on_same_surface(static_cast<std::int32_t>(pixel), other)) continue;
        found[pixel] = y * one_of_four.width + x;
        break;
      }
    }
  }
  return found;
}

bool SeenPoints::on_same_surface(std::int32_t a, std::int32_t b) const {
  constexpr float kSameWay = 0.9F;     // cosine
  constexpr float kSameHeight = 3.0F;  // pixels
  if (a == b) return true;
  if (rays_.instance[static_cast<std::size_t>(a)] != rays_.instance[static_cast<std::size_t>(b)]) {
    return false;
  }
  const Eigen::Vector3f facing = normal(a);
  if (facing.dot(normal(b)) < kSameWay) return false;
  return std::abs(facing.dot(position(b) - position(a))) < kSameHeight * pixel_width_m(a);
}

}  // namespace seedframe
