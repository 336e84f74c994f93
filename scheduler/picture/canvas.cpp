#include "picture/canvas.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <numbers>

#include <cairo.h>
#include <pango/pangocairo.h>

#include "base/message_text.h"
#include "base/utf8.h"

namespace seedframe {
namespace {

/// One line that cairo can show: UTF-8 without control characters.
std::string shown(const std::string& text) {
  std::string line = printable(as_utf8(text));
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  for (const char letter : shown(text) + " ") {
    if (letter != ' ') {
      word += letter;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  return words;
}

}  // namespace

struct Canvas::Drawing {
  Drawing(int width, int height)
      : surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
        cairo(cairo_create(surface)) {
    if (cairo_status(cairo) != CAIRO_STATUS_SUCCESS) {
      cairo_destroy(cairo);
      cairo_surface_destroy(surface);
      throw std::bad_alloc();
    }
    // What a desktop's settings say of fonts is not asked for.
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_SLIGHT);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    layout = pango_cairo_create_layout(cairo);
    pango_cairo_context_set_font_options(pango_layout_get_context(layout), options);
    pango_context_set_round_glyph_positions(pango_layout_get_context(layout), FALSE);
    pango_layout_set_single_paragraph_mode(layout, TRUE);
    cairo_font_options_destroy(options);
  }
  ~Drawing() {
    g_object_unref(layout);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
  }
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  void set_color(const DisplayColor& color, double opacity) {
    cairo_set_source_rgba(cairo, color[0], color[1], color[2], opacity);
  }

  /// Paints the path that is there.
  void paint(const LineStyle& style) {
    set_color(style.color, style.opacity);
    if (style.is_filled) {
      cairo_fill(cairo);
      return;
    }
    const std::array<double, 2> dashes = {3.0 * style.width, 2.0 * style.width};
    cairo_set_dash(cairo, dashes.data(), style.dashed ? 2 : 0, 0.0);
    cairo_set_line_width(cairo, style.width);
    cairo_stroke(cairo);
  }

  /// Pango looks for each letter in the fonts that there are.
  void set_font(const TextStyle& style) {
    PangoFontDescription* font = pango_font_description_new();
    pango_font_description_set_family_static(font, "sans-serif");
    pango_font_description_set_weight(font, style.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_font_description_set_absolute_size(font, style.size * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
  }

  double width_of(const std::string& line) {
    pango_layout_set_text(layout, line.data(), static_cast<int>(line.size()));
    PangoRectangle logical;
    pango_layout_get_extents(layout, nullptr, &logical);
    return static_cast<double>(logical.width) / PANGO_SCALE;
  }

  /// With the left end of its base line at the point that the path has come to.
  void show(const std::string& line) {
    pango_layout_set_text(layout, line.data(), static_cast<int>(line.size()));
    pango_cairo_show_layout_line(cairo, pango_layout_get_line_readonly(layout, 0));
  }

  /// Of whole characters from the line's begin that have room together with `end`.
  std::size_t fitting_bytes(const std::string& line, double width, const std::string& end) {
    std::vector<std::size_t> ends = {0};
    while (ends.back() < line.size()) {
      ends.push_back(ends.back() + std::max<std::size_t>(1, utf8_length(line, ends.back())));
    }
    std::size_t fits = 0, too_many = ends.size();
    while (fits + 1 < too_many) {
      const std::size_t middle = (fits + too_many) / 2;
      const bool has_room = width_of(line.substr(0, ends[middle]) + end) <= width;
      (has_room ? fits : too_many) = middle;
    }
    return ends[fits];
  }

  cairo_surface_t* surface;
  cairo_t* cairo;
  PangoLayout* layout = nullptr;
};

Canvas::Canvas(int width, int height, const DisplayColor& background)
    : width_(width), height_(height), drawing_(std::make_unique<Drawing>(width, height)) {
  fill({0.0, 0.0, static_cast<double>(width), static_cast<double>(height)}, background);
}

Canvas::~Canvas() = default;

void Canvas::put(const Image<std::uint8_t>& image, int x, int y) {
  cairo_surface_flush(drawing_->surface);
  unsigned char* data = cairo_image_surface_get_data(drawing_->surface);
  const int stride = cairo_image_surface_get_stride(drawing_->surface);
  const int first = std::max(0, -x), end = std::min(image.width, width_ - x);
  for (int row = std::max(0, -y); row < std::min(image.height, height_ - y); ++row) {
    unsigned char* line = data + static_cast<std::ptrdiff_t>(row + y) * stride;
    for (int column = first; column < end; ++column) {
      const std::uint8_t* rgb = &image.at(row, column);
      const std::uint32_t pixel =
          (std::uint32_t{rgb[0]} << 16U) | (std::uint32_t{rgb[1]} << 8U) | std::uint32_t{rgb[2]};
      std::memcpy(line + 4 * static_cast<std::ptrdiff_t>(column + x), &pixel, sizeof pixel);
    }
  }
  cairo_surface_mark_dirty(drawing_->surface);
}

void Canvas::fill(const CanvasBox& box, const DisplayColor& color, double opacity) {
  cairo_rectangle(drawing_->cairo, box.x, box.y, box.width, box.height);
  drawing_->paint({.color = color, .opacity = opacity, .is_filled = true});
}

void Canvas::outline(const CanvasBox& box, const LineStyle& style) {
  const double inside = std::min({style.width, box.width, box.height});
  cairo_rectangle(drawing_->cairo, box.x + inside / 2.0, box.y + inside / 2.0, box.width - inside,
                  box.height - inside);
  drawing_->paint(style);
}

void Canvas::rings(const std::vector<std::vector<CanvasPoint>>& rings, const LineStyle& style) {
  for (const std::vector<CanvasPoint>& ring : rings) {
    cairo_new_sub_path(drawing_->cairo);
    for (const CanvasPoint& point : ring) cairo_line_to(drawing_->cairo, point[0], point[1]);
    cairo_close_path(drawing_->cairo);
  }
  drawing_->paint(style);
}

void Canvas::line(const CanvasPoint& from, const CanvasPoint& to, const LineStyle& style) {
  cairo_move_to(drawing_->cairo, from[0], from[1]);
  cairo_line_to(drawing_->cairo, to[0], to[1]);
  drawing_->paint(style);
}

void Canvas::disc(const CanvasPoint& centre, double radius, const LineStyle& style) {
  cairo_new_sub_path(drawing_->cairo);
  cairo_arc(drawing_->cairo, centre[0], centre[1], radius, 0.0, 2.0 * std::numbers::pi);
  drawing_->paint(style);
}

double Canvas::width_of(const std::string& text, const TextStyle& style) {
  drawing_->set_font(style);
  return drawing_->width_of(shown(text));
}

std::string Canvas::fitted(const std::string& text, double width, const TextStyle& style) {
  drawing_->set_font(style);
  std::string line = shown(text);
  if (drawing_->width_of(line) <= width) return line;
  return line.substr(0, drawing_->fitting_bytes(line, width, "…")) + "…";
}

std::vector<std::string> Canvas::wrapped(const std::string& text, double width, int most_lines,
                                         const TextStyle& style) {
  drawing_->set_font(style);
  std::vector<std::string> lines;
  for (std::string word : words_of(text)) {
    while (!word.empty()) {
      const std::string longer = lines.empty() ? word : lines.back() + " " + word;
      const bool is_last = static_cast<int>(lines.size()) == most_lines;
      if (!lines.empty() && (is_last || drawing_->width_of(longer) <= width)) {
        lines.back() = longer;
        break;
      }
      // A word without room in a line of its own, such as a path, goes on in the next.
      const std::size_t fits = drawing_->fitting_bytes(word, width, "");
      const std::size_t bytes = fits == 0 ? std::max<std::size_t>(1, utf8_length(word, 0)) : fits;
      lines.push_back(word.substr(0, bytes));
      word.erase(0, bytes);
    }
  }
  for (std::string& line : lines) line = fitted(line, width, style);
  return lines;
}

void Canvas::text(const std::string& text, const CanvasPoint& at, const TextStyle& style) {
  drawing_->set_font(style);
  drawing_->set_color(style.color, 1.0);
  cairo_move_to(drawing_->cairo, at[0], at[1]);
  drawing_->show(shown(text));
}

Image<std::uint8_t> Canvas::image() const {
  cairo_surface_flush(drawing_->surface);
  const unsigned char* data = cairo_image_surface_get_data(drawing_->surface);
  const int stride = cairo_image_surface_get_stride(drawing_->surface);
  Image<std::uint8_t> image(width_, height_, 3);
  for (int row = 0; row < height_; ++row) {
    const unsigned char* line = data + static_cast<std::ptrdiff_t>(row) * stride;
    for (int column = 0; column < width_; ++column) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, line + 4 * static_cast<std::ptrdiff_t>(column), sizeof pixel);
      std::uint8_t* rgb = &image.at(row, column);
      rgb[0] = static_cast<std::uint8_t>(pixel >> 16U);
      rgb[1] = static_cast<std::uint8_t>(pixel >> 8U);
      rgb[2] = static_cast<std::uint8_t>(pixel);
    }
  }
  return image;
}

}  // namespace seedframe
