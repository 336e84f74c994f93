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

Eigen::Vector3d SeenPoints::position(std::int32_t pixel) const {
  const double depth = rays_.depth[static_cast<std::size_t>(pixel)];
  const int column = pixel % rays_.width, row = pixel / rays_.width;
  return {(column - camera_.center_px[0]) / camera_.focal_px[0] * depth,
          (camera_.center_px[1] - row) / camera_.focal_px[1] * depth, -depth};
}

Eigen::Vector3d SeenPoints::above(std::int32_t pixel) const {
  constexpr double kLift = 3e-5;  // of the depth: beyond what float32 rounds
  const double lift = kLift * rays_.depth[static_cast<std::size_t>(pixel)];
  return position(pixel) + lift * normal(pixel).cast<double>();
}

Eigen::Vector3f SeenPoints::normal(std::int32_t pixel) const {
  return Eigen::Map<const Eigen::Vector3f>(rays_.normals[static_cast<std::size_t>(pixel)].data());
}

float SeenPoints::pixel_width_m(std::int32_t pixel) const {
  return rays_.depth[static_cast<std::size_t>(pixel)] /
         static_cast<float>(std::sqrt(camera_.focal_px[0] * camera_.focal_px[1]));
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
  std::vector<float> sums(static_cast<std::size_t>(channels));
  float* out = values.data();
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column, out += channels) {
      const std::int32_t own = grid.at(row, column);
      if (own < 0) continue;
      const float* mine = at(row, column);
      std::copy(mine, mine + channels, sums.begin());
      int count = 1;
      for (int y = std::max(0, row - before); y < std::min(row + end, grid.height); ++y) {
        for (int x = std::max(0, column - before); x < std::min(column + end, grid.width); ++x) {
          const std::int32_t other = grid.at(y, x);
          if (other < 0 || other == own || !on_same_surface(own, other)) continue;
          const float* theirs = at(y, x);
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

std::vector<std::array<std::int32_t, 4>> SeenPoints::points_around(
    const PixelGrid& one_of_four) const {
  std::vector<std::array<std::int32_t, 4>> found(rays_.instance.size(), {-1, -1, -1, -1});
  for (int row = 0; row < rays_.height; ++row) {
    const int top = std::max(0, (row - 1) / 2), bottom = std::min(top + 1, one_of_four.height - 1);
    for (int column = 0; column < rays_.width; ++column) {
      const int left = std::max(0, (column - 1) / 2);
      const int right = std::min(left + 1, one_of_four.width - 1);
      const std::size_t pixel = rays_.index(column, row);
      const std::array<std::int32_t, 4> around = {
          one_of_four.at(top, left), one_of_four.at(top, right), one_of_four.at(bottom, left),
          one_of_four.at(bottom, right)};
      const bool all = std::all_of(around.begin(), around.end(), [&](std::int32_t other) {
        return other >= 0 && on_same_surface(static_cast<std::int32_t>(pixel), other);
      });
      if (all && rays_.instance[pixel] >= 0) found[pixel] = around;
    }
  }
  return found;
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
  constexpr double kSameHeight = 3.0;  // pixels
  if (a == b) return true;
  if (rays_.instance[static_cast<std::size_t>(a)] != rays_.instance[static_cast<std::size_t>(b)]) {
    return false;
  }
  const Eigen::Vector3f facing = normal(a);
  if (facing.dot(normal(b)) < kSameWay) return false;
  const double height = facing.cast<double>().dot(position(b) - position(a));
  return std::abs(height) < kSameHeight * pixel_width_m(a);
}

}  // namespace seedframe
