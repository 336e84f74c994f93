#include "plot/chart_file.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>

#include <cairo-svg.h>
#include <cairo.h>

#ifdef __SANITIZE_ADDRESS__
// What fontconfig keeps for the fonts that it has found is no leak of ours.
extern "C" const char* __lsan_default_suppressions();   // NOLINT(*-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(*-reserved-identifier)
  return "leak:libfontconfig";
}
#endif

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr double kFontPx = 13.0;
constexpr double kTitlePx = 16.0;
constexpr double kMarginLeft = 74.0, kMarginTop = 52.0, kMarginBottom = 58.0, kMarginRight = 18.0;
constexpr double kLegend = 190.0;
constexpr double kBetweenNumbers = 6.0;  // of an axis: those without room are left out
constexpr ChartColor kInk = {0.15, 0.15, 0.15};
constexpr ChartColor kFaint = {0.88, 0.88, 0.88};
constexpr ChartColor kStrong = {0.72, 0.72, 0.72};

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

enum class Align { kLeft, kMiddle, kRight };

/// One chart, from the origin of a surface on.
class Drawing {
 public:
  Drawing(cairo_t* cairo, const Chart& chart, const ChartSize& size)
      : cairo_(cairo),
        chart_(chart),
        right_(size.width_px - (has_legend() && !chart.legend_inside ? kLegend : kMarginRight)),
        bottom_(size.height_px - kMarginBottom),
        x_(ticks_for(values(0), chart.x.logarithmic)),
        y_(ticks_for(values(1), chart.y.logarithmic)) {}

  void draw(const ChartSize& size) {
    cairo_select_font_face(cairo_, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    draw_axes();
    text(chart_.title, (kMarginLeft + right_) / 2.0, kMarginTop - 18.0, Align::kMiddle, kTitlePx);
    text(chart_.x.label, (kMarginLeft + right_) / 2.0, size.height_px - 14.0, Align::kMiddle);
    cairo_save(cairo_);
    cairo_translate(cairo_, 18.0, (kMarginTop + bottom_) / 2.0);
    cairo_rotate(cairo_, -std::numbers::pi / 2.0);
    text(chart_.y.label, 0.0, 0.0, Align::kMiddle);
    cairo_restore(cairo_);
    cairo_save(cairo_);
    cairo_rectangle(cairo_, kMarginLeft - 6.0, kMarginTop - 6.0, right_ - kMarginLeft + 12.0,
                    bottom_ - kMarginTop + 12.0);
    cairo_clip(cairo_);
    for (const Series& series : chart_.series) draw_series(series);
    cairo_restore(cairo_);
    for (const Series& series : chart_.series) draw_labels(series);
    draw_legend();
  }

 private:
  bool has_legend() const {
    return std::any_of(chart_.series.begin(), chart_.series.end(),
                       [](const Series& series) { return !series.name.empty(); });
  }

  std::vector<double> values(std::size_t axis) const {
    std::vector<double> all;
    for (const Series& series : chart_.series) {
      for (const auto& point : series.points) all.push_back(point[axis]);
    }
    return all;
  }

  static double share(double value, const Ticks& ticks, bool logarithmic) {
    if (logarithmic) return std::log(value / ticks.from) / std::log(ticks.to / ticks.from);
    return (value - ticks.from) / (ticks.to - ticks.from);
  }
  double x_px(double value) const {
    return kMarginLeft + (right_ - kMarginLeft) * share(value, x_, chart_.x.logarithmic);
  }
  double y_px(double value) const {
    return bottom_ - (bottom_ - kMarginTop) * share(value, y_, chart_.y.logarithmic);
  }
  bool can_stand(const std::array<double, 2>& point) const {
    return std::isfinite(point[0]) && std::isfinite(point[1]) &&
           (!chart_.x.logarithmic || point[0] > 0.0) && (!chart_.y.logarithmic || point[1] > 0.0);
  }

  void set_color(const ChartColor& color) {
    cairo_set_source_rgb(cairo_, color[0], color[1], color[2]);
  }

  double width_of(const std::string& words, double size = kFontPx) {
    cairo_set_font_size(cairo_, size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, words.c_str(), &extents);
    return extents.x_advance;
  }

  void text(const std::string& words, double x, double y, Align align, double size = kFontPx,
            const ChartColor& color = kInk) {
    set_color(color);
    const double width = width_of(words, size);
    const double shift = align == Align::kLeft    ? 0.0
                         : align == Align::kRight ? -width
                                                  : -width / 2.0;
    cairo_move_to(cairo_, x + shift, y);
    cairo_show_text(cairo_, words.c_str());
  }

  void rule(double x0, double y0, double x1, double y1, bool strong) {
    set_color(strong ? kStrong : kFaint);
    cairo_set_line_width(cairo_, 1.0);
    cairo_move_to(cairo_, x0, y0);
    cairo_line_to(cairo_, x1, y1);
    cairo_stroke(cairo_);
  }

  void draw_axes() {
    double written_to = 0.0;  // where the last number ends
    for (std::size_t i = 0; i < x_.at.size(); ++i) {
      const double x = x_px(x_.at[i]);
      rule(x, kMarginTop, x, bottom_, !x_.text[i].empty());
      const double half = width_of(x_.text[i]) / 2.0;
      if (x_.text[i].empty() || x - half < written_to + kBetweenNumbers) continue;
      const double in_picture = std::min(x, right_ + kMarginRight - half);
      text(x_.text[i], in_picture, bottom_ + 20.0, Align::kMiddle);
      written_to = x + half;
    }
    for (std::size_t i = 0; i < y_.at.size(); ++i) {
      const double y = y_px(y_.at[i]);
      rule(kMarginLeft, y, right_, y, !y_.text[i].empty());
      if (!y_.text[i].empty()) text(y_.text[i], kMarginLeft - 8.0, y + 4.5, Align::kRight);
    }
    set_color(kInk);
    cairo_set_line_width(cairo_, 1.0);
    cairo_rectangle(cairo_, kMarginLeft, kMarginTop, right_ - kMarginLeft, bottom_ - kMarginTop);
    cairo_stroke(cairo_);
  }

  /// Through places in pixels, as the series wants its line.
  void stroke_line(const Series& series, const std::vector<std::array<double, 2>>& places) {
    constexpr std::array<double, 2> kDashes = {6.0, 4.0};
    set_color(series.color);
    cairo_set_line_width(cairo_, series.width_px);
    cairo_set_dash(cairo_, kDashes.data(), series.dashed ? 2 : 0, 0.0);
    cairo_new_path(cairo_);
    for (const auto& place : places) cairo_line_to(cairo_, place[0], place[1]);
    cairo_stroke(cairo_);
    cairo_set_dash(cairo_, nullptr, 0, 0.0);
  }

  void draw_marker(Marker marker, double x, double y, const ChartColor& color) {
    constexpr double kRadius = 4.0;
    set_color(color);
    cairo_set_line_width(cairo_, 1.6);
    cairo_new_path(cairo_);
    switch (marker) {
      case Marker::kNone:
        return;
      case Marker::kDot:
      case Marker::kRing:
        cairo_arc(cairo_, x, y, marker == Marker::kRing ? kRadius + 3.0 : kRadius, 0.0,
                  2.0 * std::numbers::pi);
        break;
      case Marker::kSquare:
        cairo_rectangle(cairo_, x - kRadius, y - kRadius, 2.0 * kRadius, 2.0 * kRadius);
        break;
      case Marker::kTriangle:
        cairo_move_to(cairo_, x, y - kRadius * 1.2);
        cairo_line_to(cairo_, x + kRadius * 1.1, y + kRadius * 0.8);
        cairo_line_to(cairo_, x - kRadius * 1.1, y + kRadius * 0.8);
        cairo_close_path(cairo_);
        break;
      case Marker::kCross:
        cairo_move_to(cairo_, x - kRadius, y - kRadius);
        cairo_line_to(cairo_, x + kRadius, y + kRadius);
        cairo_move_to(cairo_, x - kRadius, y + kRadius);
        cairo_line_to(cairo_, x + kRadius, y - kRadius);
        break;
    }
    if (marker == Marker::kRing || marker == Marker::kCross) {
      cairo_stroke(cairo_);
    } else {
      cairo_fill(cairo_);
    }
  }

  void draw_series(const Series& series) {
    if (series.line) {
      std::vector<std::array<double, 2>> places;
      for (const auto& point : series.points) {
        if (can_stand(point)) places.push_back({x_px(point[0]), y_px(point[1])});
      }
      stroke_line(series, places);
    }
    for (const auto& point : series.points) {
      if (!can_stand(point)) continue;
      draw_marker(series.marker, x_px(point[0]), y_px(point[1]), series.color);
    }
  }

  void draw_labels(const Series& series) {
    for (std::size_t i = 0; i < series.labels.size(); ++i) {
      const auto& point = series.points[i];
      if (!can_stand(point)) continue;
      text(series.labels[i], x_px(point[0]) + 7.0, y_px(point[1]) - 6.0, Align::kLeft,
           kFontPx - 2.0, series.color);
    }
  }

  void draw_legend() {
    double y = kMarginTop + 10.0;
    for (const Series& series : chart_.series) {
      if (series.name.empty()) continue;
      const double x = (chart_.legend_inside ? kMarginLeft : right_) + 16.0;
      if (series.line) {
        stroke_line(series, {{x, y - 4.5}, {x + 22.0, y - 4.5}});
      }
      draw_marker(series.marker, x + 11.0, y - 4.5, series.color);
      text(series.name, x + 30.0, y, Align::kLeft);
      y += 21.0;
    }
  }

  cairo_t* cairo_;
  const Chart& chart_;
  double right_, bottom_;
  Ticks x_, y_;
};

Status failure(const fs::path& path, cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return {};
  return fail(ErrorKind::kEnvironment, "cannot write {}: {}", path.string(),
              cairo_status_to_string(status));
}

}  // namespace

Status write_chart(const Chart& chart, const fs::path& path, const ChartSize& size) {
  return write_charts({chart}, 1, path, size);
}

Status write_charts(const std::vector<Chart>& charts, int columns, const fs::path& path,
                    const ChartSize& size) {
  constexpr int kPixels = 2;  // of a PNG, for each of the chart's
  const bool svg = path.extension() == ".svg";
  assert(svg || path.extension() == ".png");
  const int width = columns * size.width_px;
  const int height = (static_cast<int>(charts.size()) + columns - 1) / columns * size.height_px;
  const Surface surface(
      svg ? cairo_svg_surface_create(path.c_str(), width, height)
          : cairo_image_surface_create(CAIRO_FORMAT_RGB24, kPixels * width, kPixels * height),
      cairo_surface_destroy);
  const Context cairo(cairo_create(surface.get()), cairo_destroy);
  if (!svg) cairo_scale(cairo.get(), kPixels, kPixels);
  cairo_set_source_rgb(cairo.get(), 1.0, 1.0, 1.0);
  cairo_paint(cairo.get());
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const auto [row, column] = std::div(static_cast<int>(i), columns);
    cairo_save(cairo.get());
    cairo_translate(cairo.get(), column * size.width_px, row * size.height_px);
    Drawing(cairo.get(), charts[i], size).draw(size);
    cairo_restore(cairo.get());
  }
  if (Status drawn = failure(path, cairo_status(cairo.get())); !drawn) return drawn;
  if (!svg) return failure(path, cairo_surface_write_to_png(surface.get(), path.c_str()));
  cairo_surface_finish(surface.get());
  return failure(path, cairo_surface_status(surface.get()));
}

}  // namespace seedframe
