// What is drawn of figures: curves and points over two axes.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace seedframe {

/// Red, green, blue, 0 to 1, as a display has them.
using ChartColor = std::array<double, 3>;

/// The i-th of ten colours that differ for most eyes (after that they begin again).
ChartColor chart_color(std::size_t i);

enum class Marker { kNone, kDot, kRing, kSquare, kTriangle, kCross };

struct Series {
  std::string name;  ///< for the legend; empty: not named there
  std::vector<std::array<double, 2>> points;
  ChartColor color{};
  Marker marker = Marker::kDot;
  bool line = false;                     ///< joins the points in their order
  double width_px = 1.5;                 ///< of the line
  bool dashed = false;                   ///< the line
  std::vector<std::string> labels = {};  ///< beside the points; empty, or as many as there are
};

struct Axis {
  std::string label;  ///< with the unit
  bool logarithmic = false;
};

struct Chart {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;  ///< the last one is drawn on top
  bool legend_inside = false;  ///< at the upper left of the plot, not beside it
};

/// Where an axis has its lines, and what stands there.
struct Ticks {
  double from = 0.0;  ///< the axis begins here
  double to = 1.0;
  std::vector<double> at;
  std::vector<std::string> text;  ///< of each; empty: a line without a number
};

/// Round numbers (1, 2 or 5 times a power of ten) that enclose the values; on a logarithmic axis,
/// where only values above 0 count, powers of ten and between them, and the axis begins and ends at
/// any whole step of a decade. Never empty: an axis without extent is widened.
Ticks ticks_for(const std::vector<double>& values, bool logarithmic);

/// "0.002", "20", "1e-05": as short as it can be told.
std::string tick_text(double value);

}  // namespace seedframe
