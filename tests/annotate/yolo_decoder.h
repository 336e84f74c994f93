// What a YOLO loader makes of a row of a label file, written for the tests from its description.
//
// Coordinates are read as float32, multiplied by the image's sides, made integers (ultralytics
// truncates, others round), and the polygon is filled as OpenCV's fillPoly does it: its outline is
// drawn, pixel by pixel, and everything between the first and second, third and fourth, … edge of a
// row is filled.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "annotate/polygon.h"
#include "image/image.h"

namespace seedframe::yolo_decoder {

using Bitmap = Image<std::uint8_t>;

struct Row {
  int category = -1;  ///< 0-based, as written
  std::vector<float> numbers;
};

inline std::vector<Row> parse_rows(const std::string& text) {
  std::vector<Row> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    Row row;
    words >> row.category;
    for (std::string word; words >> word;) row.numbers.push_back(std::stof(word));
    rows.push_back(std::move(row));
  }
  return rows;
}

/// As it would be read from a label file.
inline Row yolo_row(const Polygon& polygon, int width, int height) {
  Row row{.category = 0, .numbers = {}};
  for (const Vertex& vertex : polygon) {
    row.numbers.push_back(static_cast<float>(vertex.x / 100.0 / width));
    row.numbers.push_back(static_cast<float>(vertex.y / 100.0 / height));
  }
  return row;
}

/// As ultralytics reads segments: 1,000 points by linear interpolation, the vertices among them,
/// the others evenly over the closed polygon's parameter, one a vertex. Of a polygon that has more,
/// the vertices alone.
inline Row resampled(const Row& row) {
  constexpr std::size_t kPoints = 1000;
  const std::size_t vertices = row.numbers.size() / 2;
  if (vertices == kPoints) return row;
  std::vector<double> places;
  const std::size_t closed = vertices + 1;
  const std::size_t even = closed < kPoints ? kPoints - closed : closed;
  for (std::size_t i = 0; i < even; ++i) {
    places.push_back(static_cast<double>(i) * static_cast<double>(vertices) /
                     static_cast<double>(std::max<std::size_t>(even - 1, 1)));
  }
  if (closed < kPoints) {
    for (std::size_t i = 0; i < closed; ++i) places.push_back(static_cast<double>(i));
    std::sort(places.begin(), places.end());
  }
  Row dense{.category = row.category, .numbers = {}};
  for (const double place : places) {
    const auto from = static_cast<std::size_t>(place) % vertices;
    const double share = place - std::floor(place);
    for (const std::size_t axis : {0, 1}) {
      const double a = row.numbers[2 * from + axis];
      const double b = row.numbers[2 * ((from + 1) % vertices) + axis];
      dense.numbers.push_back(static_cast<float>(a + share * (b - a)));
    }
  }
  return dense;
}

/// In pixels: left, top, right, bottom.
struct Box {
  double x0, y0, x1, y1;
};

inline Box box_of_centre_row(const Row& row, int width, int height) {
  const double x = row.numbers[0], y = row.numbers[1], w = row.numbers[2], h = row.numbers[3];
  return {(x - w / 2) * width, (y - h / 2) * height, (x + w / 2) * width, (y + h / 2) * height};
}

inline Box box_of_polygon_row(const Row& row, int width, int height) {
  Box box{1e9, 1e9, -1e9, -1e9};
  for (std::size_t i = 0; i + 1 < row.numbers.size(); i += 2) {
    box.x0 = std::min(box.x0, static_cast<double>(row.numbers[i]) * width);
    box.x1 = std::max(box.x1, static_cast<double>(row.numbers[i]) * width);
    box.y0 = std::min(box.y0, static_cast<double>(row.numbers[i + 1]) * height);
    box.y1 = std::max(box.y1, static_cast<double>(row.numbers[i + 1]) * height);
  }
  return box;
}

/// The largest distance of any side from where it should be.
inline double box_error(const Box& box, int x, int y, int width, int height) {
  return std::max({std::abs(box.x0 - x), std::abs(box.y0 - y), std::abs(box.x1 - (x + width)),
                   std::abs(box.y1 - (y + height))});
}

struct Point {
  int x;
  int y;
};

inline void paint(Bitmap& bitmap, std::int64_t x, std::int64_t y) {
  if (x < 0 || y < 0 || x >= bitmap.width || y >= bitmap.height) return;
  bitmap.at(static_cast<int>(y), static_cast<int>(x)) = 1;
}

/// One pixel a step of the longer axis, from left to right; half-way cases stay behind.
inline void draw_line(Bitmap& bitmap, Point a, Point b) {
  if (a.x > b.x) std::swap(a, b);
  const std::int64_t run = b.x - a.x;
  const std::int64_t rise = std::abs(b.y - a.y);
  const int down = b.y < a.y ? -1 : 1;
  const std::int64_t steps = std::max(run, rise);
  const std::int64_t across = std::min(run, rise);
  for (std::int64_t i = 0; i <= steps; ++i) {
    // ceil((2 i across - steps) / (2 steps)) for integers
    const std::int64_t aside =
        steps == 0 ? 0 : (2 * i * across - steps + (2 * steps - 1)) / (2 * steps);
    if (run >= rise) {
      paint(bitmap, a.x + i, a.y + down * aside);
    } else {
      paint(bitmap, a.x + aside, a.y + down * i);
    }
  }
}

inline Bitmap fill_polygon(const std::vector<Point>& points, int width, int height) {
  Bitmap bitmap(width, height);
  constexpr std::int64_t kOne = 1 << 16;
  std::vector<std::vector<std::int64_t>> crossings(static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point a = points[i];
    Point b = points[(i + 1) % points.size()];
    draw_line(bitmap, a, b);
    if (a.y == b.y) continue;
    if (a.y > b.y) std::swap(a, b);
    const std::int64_t slope = (b.x - a.x) * kOne / (b.y - a.y);
    for (int y = std::max(a.y, 0); y < std::min(b.y, height); ++y) {
      crossings[static_cast<std::size_t>(y)].push_back(a.x * kOne + slope * (y - a.y));
    }
  }
  for (int y = 0; y < height; ++y) {
    std::vector<std::int64_t>& row = crossings[static_cast<std::size_t>(y)];
    std::sort(row.begin(), row.end());
    for (std::size_t i = 0; i + 1 < row.size(); i += 2) {
      for (std::int64_t x = (row[i] + kOne - 1) / kOne; x <= row[i + 1] / kOne; ++x) {
        paint(bitmap, x, y);
      }
    }
  }
  return bitmap;
}

enum class ToPixels { kTruncate, kRound };

inline std::vector<Point> points_of_row(const Row& row, int width, int height,
                                        ToPixels to_pixels = ToPixels::kTruncate) {
  std::vector<Point> points;
  const auto pixel = [to_pixels](float coordinate, int side) {
    const float scaled = coordinate * static_cast<float>(side);
    return static_cast<int>(to_pixels == ToPixels::kRound ? std::nearbyint(scaled) : scaled);
  };
  for (std::size_t i = 0; i + 1 < row.numbers.size(); i += 2) {
    points.push_back({pixel(row.numbers[i], width), pixel(row.numbers[i + 1], height)});
  }
  return points;
}

inline Bitmap bitmap_of_row(const Row& row, int width, int height,
                            ToPixels to_pixels = ToPixels::kTruncate) {
  return fill_polygon(points_of_row(row, width, height, to_pixels), width, height);
}

}  // namespace seedframe::yolo_decoder
