#include "picture/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "picture/canvas.h"
#include "picture/pixel_layers.h"

namespace seedframe {
namespace {

constexpr DisplayColor kPaper = {1.0, 1.0, 1.0};
constexpr DisplayColor kSheetInk = {0.12, 0.13, 0.15};
constexpr DisplayColor kPaleInk = {0.45, 0.46, 0.48};
constexpr TextStyle kTitleText{.size = 15.0, .color = kSheetInk, .bold = true};
constexpr TextStyle kSubtitleText{.size = 13.0, .color = kPaleInk};
constexpr TextStyle kCaptionText{.size = 11.5, .color = kSheetInk};
constexpr TextStyle kNoteText{.size = 11.5, .color = kPaleInk};
constexpr TextStyle kLegendText{.size = 12.0, .color = kSheetInk};

constexpr int kGap = 6;
constexpr int kTitleHeight = 30;
constexpr int kCaptionHeight = 20;
constexpr int kLegendRow = 20;
constexpr int kMargin = 12;  // around what has words; tiles alone have none
constexpr double kSign = 26.0;
constexpr double kBetweenEntries = 18.0;

/// Where everything is.
class Layout {
 public:
  explicit Layout(const ContactSheet& sheet) {
    const int count = static_cast<int>(sheet.tiles.size());
    columns_ = std::clamp(sheet.columns, 1, count);
    rows_ = (count + columns_ - 1) / columns_;
    const bool has_rows_below = !sheet.legend.empty() || !sheet.remarks.empty();
    bool has_words = !sheet.title.empty() || has_rows_below;
    row_tops_.assign(static_cast<std::size_t>(rows_), 0);
    captions_.assign(static_cast<std::size_t>(rows_), 0);
    for (int i = 0; i < count; ++i) {
      const SheetTile& tile = sheet.tiles[static_cast<std::size_t>(i)];
      tile_width_ = std::max(tile_width_, tile.pixels.width);
      tile_height_ = std::max(tile_height_, tile.pixels.height);
      if (tile.caption.empty() && tile.note.empty()) continue;
      captions_[static_cast<std::size_t>(i / columns_)] = kCaptionHeight;
      has_words = true;
    }
    margin_ = has_words ? kMargin : 0;
    double y = margin_ + (sheet.title.empty() ? 0 : kTitleHeight);
    for (std::size_t row = 0; row < row_tops_.size(); ++row) {
      row_tops_[row] = y;
      y += tile_height_ + captions_[row] + kGap;
    }
    legend_top_ = y - kGap + (has_rows_below ? kGap : 0);
    width_ = 2.0 * margin_ + columns_ * (tile_width_ + 1.0 * kGap) - kGap;
  }

  double width() const { return width_; }
  double inner_width() const { return width_ - 2.0 * margin_; }
  int margin() const { return margin_; }
  double legend_top() const { return legend_top_; }
  int tile_width() const { return tile_width_; }
  int tile_height() const { return tile_height_; }
  CanvasPoint corner_of(std::size_t tile) const {
    const auto columns = static_cast<std::size_t>(columns_);
    return {margin_ + static_cast<double>(tile % columns) * (tile_width_ + kGap),
            row_tops_[tile / columns]};
  }
  double height(int legend_rows) const { return legend_top_ + kLegendRow * legend_rows + margin_; }

 private:
  int columns_ = 1, rows_ = 1, margin_ = 0;
  int tile_width_ = 1, tile_height_ = 1;
  std::vector<double> row_tops_;
  std::vector<int> captions_;
  double legend_top_ = 0.0, width_ = 0.0;
};

/// Where each entry of a legend begins, from the legend's upper left corner on.
std::vector<CanvasPoint> places_of(const std::vector<LegendEntry>& legend, double width,
                                   Canvas& ruler) {
  std::vector<CanvasPoint> places;
  CanvasPoint at = {0.0, 0.0};
  for (const LegendEntry& entry : legend) {
    const double room =
        std::min(width, kSign + ruler.width_of(entry.text, kLegendText) + kBetweenEntries);
    if (at[0] > 0.0 && at[0] + room - kBetweenEntries > width) at = {0.0, at[1] + kLegendRow};
    places.push_back(at);
    at[0] += room;
  }
  return places;
}

std::vector<std::string> lines_of(const std::vector<std::string>& remarks, double width,
                                  Canvas& ruler) {
  constexpr int kMostLines = 4;  // of each
  std::vector<std::string> lines;
  for (const std::string& remark : remarks) {
    for (std::string& line : ruler.wrapped(remark, width, kMostLines, kLegendText)) {
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

void draw_sign(const LegendEntry& entry, double x, double y, Canvas& canvas) {
  const double width = kSign - 8.0;
  const LineStyle line{.color = entry.color, .width = 2.0};
  switch (entry.sign) {
    case LegendEntry::Sign::kSwatch:
      canvas.fill({x, y, width, 12.0}, entry.color);
      canvas.outline({x, y, width, 12.0}, {.width = 1.0, .opacity = 0.25});
      break;
    case LegendEntry::Sign::kLine:
      canvas.outline({x, y, width, 12.0}, line);
      break;
    case LegendEntry::Sign::kDot:
    case LegendEntry::Sign::kRing:
      canvas.disc(
          {x + width / 2.0, y + 6.0}, 4.5,
          {.color = entry.color, .width = 2.0, .is_filled = entry.sign == LegendEntry::Sign::kDot});
      break;
    case LegendEntry::Sign::kDepth:
      for (double step = 0.0; step < width; ++step) {
        canvas.fill({x + step, y, 1.0, 12.0}, depth_color(1.0 - step / (width - 1.0)));
      }
      break;
  }
}

void draw_tile(const SheetTile& tile, const CanvasPoint& corner, const Layout& layout,
               Canvas& canvas) {
  canvas.put(tile.pixels, static_cast<int>(corner[0]), static_cast<int>(corner[1]));
  const double base = corner[1] + layout.tile_height() + 14.5;
  const std::string caption = canvas.fitted(tile.caption, layout.tile_width(), kCaptionText);
  canvas.text(caption, {corner[0], base}, kCaptionText);
  const double begin =
      caption.empty() ? 0.0 : canvas.width_of(caption, kCaptionText) + 0.7 * kCaptionText.size;
  const double room = layout.tile_width() - begin;
  if (tile.note.empty() || room < 30.0) return;
  canvas.text(canvas.fitted(tile.note, room, kNoteText), {corner[0] + begin, base}, kNoteText);
}

void draw_title(const ContactSheet& sheet, const Layout& layout, Canvas& canvas) {
  const double base = layout.margin() + 15.0;
  const std::string title = canvas.fitted(sheet.title, layout.inner_width(), kTitleText);
  canvas.text(title, {double(layout.margin()), base}, kTitleText);
  const double begin = canvas.width_of(title, kTitleText) + kTitleText.size;
  const double room = layout.inner_width() - begin;
  if (sheet.subtitle.empty() || room < 30.0) return;
  canvas.text(canvas.fitted(sheet.subtitle, room, kSubtitleText), {layout.margin() + begin, base},
              kSubtitleText);
}

}  // namespace

void SeenLabels::add(const FrameLabels& labels) {
  for (const InstanceLabel& label : labels.instances) {
    keypoints_ = keypoints_ || !label.keypoints.empty();
    if (label.area_px == 0) continue;
    if (label.category == 0) {
      distractors_ = true;
    } else {
      classes_[label.category] = labels.categories.at(static_cast<std::size_t>(label.category) - 1);
    }
  }
}

std::vector<LegendEntry> SeenLabels::legend_for(const std::vector<LayerSet>& tiles) const {
  LayerSet layers;
  for (const LayerSet& tile : tiles) layers = layers.with(tile);
  using Sign = LegendEntry::Sign;
  std::vector<LegendEntry> legend;
  const auto any_of = [&](std::initializer_list<Layer> some) {
    return std::any_of(some.begin(), some.end(), [&](Layer layer) { return layers.has(layer); });
  };
  const bool has_masks = any_of({Layer::kSemantic, Layer::kInstances});
  if (has_masks || any_of({Layer::kBoxes, Layer::kNames, Layer::kAmodal, Layer::kKeypoints})) {
    for (const auto& [category, name] : classes_) {
      legend.push_back({has_masks ? Sign::kSwatch : Sign::kLine, class_color(category), name});
    }
  }
  if (layers.has(Layer::kInstances) && distractors_) {
    legend.push_back({Sign::kSwatch, class_color(0), "without a class"});
  }
  if (layers.has(Layer::kDepth)) legend.push_back({Sign::kDepth, {}, "near to far, in each frame"});
  if (layers.has(Layer::kKeypoints) && keypoints_) {
    legend.push_back({Sign::kDot, kSheetInk, "keypoint that is seen"});
    legend.push_back({Sign::kRing, kSheetInk, "hidden"});
  }
  if (layers.has(Layer::kDisagreement)) {
    legend.push_back({Sign::kSwatch, kInsideColor, "differs from the twin inside of objects"});
    legend.push_back({Sign::kSwatch, kEdgeColor, "at an edge"});
    legend.push_back({Sign::kSwatch, kCoincidentColor, "where surfaces coincide"});
  }
  return legend;
}

int columns_for(int count, int tile_width, int tile_height) {
  constexpr double kScreen = 1.6;     // width over height
  constexpr double kEmptyCell = 0.4;  // as bad as that much in the logarithm of the shape
  int best = 1;
  double least = std::numeric_limits<double>::infinity();
  for (int columns = 1; columns <= count; ++columns) {
    const int rows = (count + columns - 1) / columns;
    const double shape = 1.0 * columns * tile_width / (1.0 * rows * tile_height);
    const double cost = std::abs(std::log(shape / kScreen)) + kEmptyCell * (columns * rows - count);
    if (cost < least) {
      least = cost;
      best = columns;
    }
  }
  return best;
}

Result<Image<std::uint8_t>> draw_sheet(const ContactSheet& sheet) {
  constexpr double kMostSide = 32'767.0;
  if (sheet.tiles.empty()) return fail(ErrorKind::kInput, "there is no frame to show");
  const Layout layout(sheet);
  Canvas ruler(1, 1, kPaper);
  const std::vector<CanvasPoint> places = places_of(sheet.legend, layout.inner_width(), ruler);
  const int legend_rows =
      places.empty() ? 0 : 1 + static_cast<int>(std::lround(places.back()[1] / kLegendRow));
  const std::vector<std::string> remarks = lines_of(sheet.remarks, layout.inner_width(), ruler);
  const double width = layout.width();
  const double height = layout.height(legend_rows + static_cast<int>(remarks.size()));
  if (width > kMostSide || height > kMostSide || width * height > kMostSheetPixels) {
    return fail(
        ErrorKind::kInput,
        "the picture would have {:.0f} × {:.0f} pixels, at most {:.0f} both ways and {:.0f} "
        "million together are drawn: show fewer frames, or smaller ones (--tile-width)",
        width, height, kMostSide, kMostSheetPixels / 1e6);
  }
  Canvas canvas(static_cast<int>(width), static_cast<int>(height), kPaper);
  if (!sheet.title.empty()) draw_title(sheet, layout, canvas);
  for (std::size_t i = 0; i < sheet.tiles.size(); ++i) {
    draw_tile(sheet.tiles[i], layout.corner_of(i), layout, canvas);
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double x = layout.margin() + places[i][0], y = layout.legend_top() + places[i][1];
    draw_sign(sheet.legend[i], x, y + 2.0, canvas);
    canvas.text(canvas.fitted(sheet.legend[i].text, layout.inner_width() - kSign, kLegendText),
                {x + kSign, y + 12.5}, kLegendText);
  }
  double base = layout.legend_top() + kLegendRow * legend_rows + 12.5;
  for (const std::string& line : remarks) {
    canvas.text(line, {double(layout.margin()), base}, kLegendText);
    base += kLegendRow;
  }
  return canvas.image();
}

}  // namespace seedframe
