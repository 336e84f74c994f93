// A picture in the making: what is drawn of frames, their labels and legends (by cairo).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "image/image.h"
#include "picture/label_colors.h"

namespace seedframe {

/// x, y in pixels of the canvas; 0, 0 is the upper left corner of the first pixel.
using CanvasPoint = std::array<double, 2>;

struct CanvasBox {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;

  /// The area that both have, square pixels.
  double overlap(const CanvasBox& other) const {
    const double wide = std::min(x + width, other.x + other.width) - std::max(x, other.x);
    const double high = std::min(y + height, other.y + other.height) - std::max(y, other.y);
    return std::max(0.0, wide) * std::max(0.0, high);
  }
  bool overlaps(const CanvasBox& other) const { return overlap(other) > 0.0; }
};

struct LineStyle {
  DisplayColor color{};
  double width = 1.5;    ///< pixels
  double opacity = 1.0;  ///< 0 to 1
  bool dashed = false;
  bool is_filled = false;  ///< what it encloses, instead of the line
};

struct TextStyle {
  double size = 12.0;  ///< pixels
  DisplayColor color{};
  bool bold = false;
};

/// The same calls give the same pixels, on machines with the same fonts ("sans-serif").
class Canvas {
 public:
  /// At most 32,767 pixels both ways. Throws std::bad_alloc.
  Canvas(int width, int height, const DisplayColor& background);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }

  /// The pixels of an RGB image as they are, with its first one at `x`, `y`; what is outside of the
  /// canvas is left out.
  void put(const Image<std::uint8_t>& image, int x, int y);

  void fill(const CanvasBox& box, const DisplayColor& color, double opacity = 1.0);
  /// The line runs inside of the box.
  void outline(const CanvasBox& box, const LineStyle& style);
  /// Through the points of each and back to its first.
  void rings(const std::vector<std::vector<CanvasPoint>>& rings, const LineStyle& style);
  void line(const CanvasPoint& from, const CanvasPoint& to, const LineStyle& style);
  void disc(const CanvasPoint& centre, double radius, const LineStyle& style);

  /// How wide a text is, which may be any bytes: what is not UTF-8 or no letter is shown as '?'.
  double width_of(const std::string& text, const TextStyle& style);
  /// As much of the text as has room, with "…" in place of the rest.
  std::string fitted(const std::string& text, double width, const TextStyle& style);
  /// The text's words in lines that have room, longer ones in pieces; the last of `most_lines` is
  /// fitted.
  std::vector<std::string> wrapped(const std::string& text, double width, int most_lines,
                                   const TextStyle& style);
  /// Begins at `at`, which is on the base line.
  void text(const std::string& text, const CanvasPoint& at, const TextStyle& style);

  /// RGB.
  Image<std::uint8_t> image() const;

 private:
  struct Drawing;
  int width_, height_;
  std::unique_ptr<Drawing> drawing_;
};

}  // namespace seedframe
