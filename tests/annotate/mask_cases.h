// Masks that have caught polygon and run-length code out, as instance-id images for the tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "annotate/extents.h"
#include "annotate/mask.h"
#include "image/image.h"

namespace seedframe {

using IdImage = Image<std::uint16_t>;
using Bitmap = Image<std::uint8_t>;

inline constexpr int kMaskId = 7;
inline constexpr int kOtherId = 300;

/// Of the first instance, where there is but one.
inline Mask only_mask(const IdImage& ids) {
  const InstanceExtent extent = measure_extents(ids).front();
  return {ids, extent.id, extent.box};
}

struct MaskCase {
  std::string name;
  IdImage ids;
};

/// The mask's pixels are kMaskId; every third other pixel belongs to another instance.
inline MaskCase mask_case(std::string name, int width, int height,
                          const std::function<bool(int row, int column)>& inside) {
  IdImage ids(width, height);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const int other = (row * width + column) % 3 == 0 ? kOtherId : 0;
      ids.at(row, column) = static_cast<std::uint16_t>(inside(row, column) ? kMaskId : other);
    }
  }
  return {std::move(name), std::move(ids)};
}

/// From text, a row a string, '#' for the mask.
inline MaskCase mask_drawing(std::string name, const std::vector<std::string>& rows) {
  return mask_case(std::move(name), static_cast<int>(rows[0].size()), static_cast<int>(rows.size()),
                   [&rows](int row, int column) {
                     return rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] ==
                            '#';
                   });
}

inline Mask mask_of(const IdImage& ids) {
  for (const InstanceExtent& extent : measure_extents(ids)) {
    if (extent.id == kMaskId) return Mask(ids, kMaskId, extent.box);
  }
  return Mask(ids, kMaskId, PixelRect{});
}

inline Bitmap bitmap_of(const IdImage& ids, int id = kMaskId) {
  Bitmap bitmap(ids.width, ids.height);
  for (std::size_t i = 0; i < ids.values.size(); ++i) bitmap.values[i] = ids.values[i] == id;
  return bitmap;
}

inline double intersection_over_union(const Bitmap& a, const Bitmap& b) {
  double common = 0;
  double either = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    common += a.values[i] != 0 && b.values[i] != 0;
    either += a.values[i] != 0 || b.values[i] != 0;
  }
  return either == 0 ? 1.0 : common / either;
}

/// Number of connected regions of pixels equal to `value`; neighbours are 8 or 4.
inline int count_regions(const Bitmap& bitmap, std::uint8_t value, int neighbours) {
  Bitmap seen(bitmap.width, bitmap.height);
  int regions = 0;
  for (int r0 = 0; r0 < bitmap.height; ++r0) {
    for (int c0 = 0; c0 < bitmap.width; ++c0) {
      if (bitmap.at(r0, c0) != value || seen.at(r0, c0) != 0) continue;
      ++regions;
      std::vector<std::pair<int, int>> open = {{r0, c0}};
      seen.at(r0, c0) = 1;
      while (!open.empty()) {
        const auto [row, column] = open.back();
        open.pop_back();
        for (int r = std::max(row - 1, 0); r <= std::min(row + 1, bitmap.height - 1); ++r) {
          for (int c = std::max(column - 1, 0); c <= std::min(column + 1, bitmap.width - 1); ++c) {
            if (neighbours == 4 && r != row && c != column) continue;
            if (bitmap.at(r, c) != value || seen.at(r, c) != 0) continue;
            seen.at(r, c) = 1;
            open.emplace_back(r, c);
          }
        }
      }
    }
  }
  return regions;
}

inline int count_parts(const Bitmap& bitmap) { return count_regions(bitmap, 1, 8); }

/// 4-connected background regions of the image with one more row and column on every side, less the
/// outside.
inline int count_holes(const Bitmap& bitmap) {
  Bitmap framed(bitmap.width + 2, bitmap.height + 2);
  for (int row = 0; row < bitmap.height; ++row) {
    for (int column = 0; column < bitmap.width; ++column) {
      framed.at(row + 1, column + 1) = bitmap.at(row, column);
    }
  }
  return count_regions(framed, 0, 4) - 1;
}

/// How a decoded mask differs from the true one.
struct Difference {
  int lost = 0;   ///< pixels of the mask that are missing
  int added = 0;  ///< pixels that are not the mask's
};

inline Difference difference(const Bitmap& decoded, const Bitmap& truth) {
  Difference found;
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    found.lost += truth.values[i] != 0 && decoded.values[i] == 0;
    found.added += truth.values[i] == 0 && decoded.values[i] != 0;
  }
  return found;
}

/// Each 8-connected part's pixels that have a 4-neighbour outside of the mask.
inline std::vector<std::vector<std::pair<int, int>>> part_outlines(const Bitmap& bitmap) {
  std::vector<std::vector<std::pair<int, int>>> parts;
  const auto inside = [&bitmap](int r, int c) {
    return r >= 0 && c >= 0 && r < bitmap.height && c < bitmap.width && bitmap.at(r, c) != 0;
  };
  Bitmap seen(bitmap.width, bitmap.height);
  for (int r0 = 0; r0 < bitmap.height; ++r0) {
    for (int c0 = 0; c0 < bitmap.width; ++c0) {
      if (!inside(r0, c0) || seen.at(r0, c0) != 0) continue;
      parts.emplace_back();
      std::vector<std::pair<int, int>> open = {{r0, c0}};
      seen.at(r0, c0) = 1;
      while (!open.empty()) {
        const auto [r, c] = open.back();
        open.pop_back();
        if (!inside(r - 1, c) || !inside(r + 1, c) || !inside(r, c - 1) || !inside(r, c + 1)) {
          parts.back().emplace_back(r, c);
        }
        for (int i = 0; i < 9; ++i) {
          const int row = r + i / 3 - 1;
          const int column = c + i % 3 - 1;
          if (!inside(row, column) || seen.at(row, column) != 0) continue;
          seen.at(row, column) = 1;
          open.emplace_back(row, column);
        }
      }
    }
  }
  return parts;
}

/// The least number of background pixels under straight lines that join all parts of a mask, found
/// by trying every pair of pixels (Prim's algorithm). 0 for one part.
inline int shortest_bridges(const Bitmap& bitmap) {
  const auto parts = part_outlines(bitmap);
  const auto gap = [&parts](std::size_t a, std::size_t b) {
    int least = 1 << 30;
    for (const auto& [r0, c0] : parts[a]) {
      for (const auto& [r1, c1] : parts[b]) {
        least = std::min(least, std::max(std::abs(r0 - r1), std::abs(c0 - c1)) - 1);
      }
    }
    return least;
  };
  std::vector<int> gaps(parts.size(), 1 << 30);
  std::vector<bool> joined(parts.size(), false);
  int sum = 0;
  for (std::size_t count = 0, part = 0; count + 1 < parts.size(); ++count) {
    joined[part] = true;
    std::size_t next = parts.size();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (joined[i]) continue;
      gaps[i] = std::min(gaps[i], gap(part, i));
      if (next == parts.size() || gaps[i] < gaps[next]) next = i;
    }
    sum += gaps[next];
    part = next;
  }
  return sum;
}

inline bool in_disc(int row, int column, double y, double x, double radius) {
  return (row - y) * (row - y) + (column - x) * (column - x) <= radius * radius;
}

/// Discs added and taken away again: several parts, holes, islands in holes, cut by the border.
inline MaskCase random_blobs(std::uint64_t seed, int width, int height) {
  std::mt19937_64 random(seed);
  struct Disc {
    double y, x, radius;
    bool adds;
  };
  std::vector<Disc> discs;
  const auto number = [&random](int below) {
    return static_cast<double>(random() % static_cast<std::uint64_t>(below * 16)) / 16.0;
  };
  for (int i = 0; i < 8; ++i) {
    discs.push_back({number(height), number(width), 1.0 + number(width / 4), i % 3 != 2});
  }
  return mask_case("blobs " + std::to_string(seed), width, height, [&](int row, int column) {
    bool inside = false;
    for (const Disc& disc : discs) {
      if (in_disc(row, column, disc.y, disc.x, disc.radius)) inside = disc.adds;
    }
    return inside;
  });
}

inline MaskCase random_noise(std::uint64_t seed, int percent) {
  std::mt19937_64 random(seed);
  const int width = 1 + static_cast<int>(random() % 40);
  const int height = 1 + static_cast<int>(random() % 40);
  return mask_case(std::to_string(percent) + " % noise " + std::to_string(seed), width, height,
                   [&](int, int) { return static_cast<int>(random() % 100) < percent; });
}

/// Named shapes, then random ones; some of the random ones may be empty.
inline std::vector<MaskCase> mask_cases() {
  std::vector<MaskCase> cases;
  const auto add = [&cases](std::string name, int width, int height, auto inside) {
    cases.push_back(mask_case(std::move(name), width, height, inside));
  };
  add("one pixel image", 1, 1, [](int, int) { return true; });
  add("full image", 13, 9, [](int, int) { return true; });
  add("empty", 5, 4, [](int, int) { return false; });
  for (const int row : {0, 4, 8}) {
    for (const int column : {0, 6, 12}) {
      add("pixel " + std::to_string(row) + "," + std::to_string(column), 13, 9,
          [=](int r, int c) { return r == row && c == column; });
    }
  }
  add("frame along the border", 12, 10,
      [](int r, int c) { return r == 0 || c == 0 || r == 9 || c == 11; });
  add("first column", 12, 10, [](int, int c) { return c == 0; });
  add("last column", 12, 10, [](int, int c) { return c == 11; });
  add("last row", 12, 10, [](int r, int) { return r == 9; });
  add("lower half", 12, 10, [](int r, int) { return r >= 5; });
  add("diagonal", 11, 11, [](int r, int c) { return r == c; });
  add("antidiagonal", 11, 11, [](int r, int c) { return r + c == 10; });
  add("checkerboard", 10, 11, [](int r, int c) { return (r + c) % 2 == 0; });
  add("sparse grid", 17, 15, [](int r, int c) { return r % 3 == 1 && c % 4 == 2; });
  add("grid of holes", 17, 15, [](int r, int c) { return !(r % 3 == 1 && c % 4 == 2); });
  add("concentric squares", 21, 21,
      [](int r, int c) { return std::max(std::abs(r - 10), std::abs(c - 10)) % 2 == 0; });
  for (const double radius : {1.0, 2.5, 7.0, 20.0, 60.0}) {
    add("disc " + std::to_string(radius), 128, 130,
        [=](int r, int c) { return in_disc(r, c, 64.0, 63.0, radius); });
  }
  add("ring", 64, 64,
      [](int r, int c) { return in_disc(r, c, 31, 30, 25) && !in_disc(r, c, 33, 31, 12); });
  cases.push_back(
      mask_drawing("holes that touch at a corner", {"#####", "#.###", "##.##", "#####"}));
  cases.push_back(mask_drawing("a hole open at a corner", {"#####", "#.###", "#.###", "##.##"}));
  cases.push_back(mask_drawing("a comb", {"#.#.#.#", "#.#.#.#", "#######"}));
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    cases.push_back(random_noise(seed, 50));
    cases.push_back(random_noise(seed, 10));
    cases.push_back(random_noise(seed, 90));
    cases.push_back(random_blobs(seed, 96, 72));
  }
  return cases;
}

}  // namespace seedframe
