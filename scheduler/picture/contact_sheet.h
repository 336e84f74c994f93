// Tiles in rows, with captions, a title and a legend: a page of pictures.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "annotate/labels.h"
#include "base/error.h"
#include "image/image.h"
#include "picture/label_colors.h"
#include "picture/layers.h"

namespace seedframe {

struct SheetTile {
  Image<std::uint8_t> pixels;  ///< RGB
  std::string caption;         ///< below it; empty: none
  std::string note;            ///< behind the caption, paler
};

struct LegendEntry {
  enum class Sign { kSwatch, kLine, kDot, kRing, kDepth };
  Sign sign = Sign::kSwatch;
  DisplayColor color{};
  std::string text;
};

struct ContactSheet {
  std::string title;     ///< empty: none
  std::string subtitle;  ///< behind the title, paler
  int columns = 1;
  std::vector<SheetTile> tiles;  ///< row by row
  std::vector<LegendEntry> legend;
  std::vector<std::string> remarks;  ///< below all, each as many lines as it needs
};

/// What legends must explain, of all labels of a sheet.
class SeenLabels {
 public:
  void add(const FrameLabels& labels);
  /// Of classes by their number, then of signs, in the order of the layers.
  std::vector<LegendEntry> legend_for(const std::vector<LayerSet>& tiles) const;

 private:
  std::map<int, std::string> classes_;
  bool distractors_ = false;
  bool keypoints_ = false;
};

/// Columns for `count` tiles, so that a sheet is about as wide as a screen and its last row full.
int columns_for(int count, int tile_width, int tile_height);

inline constexpr double kMostSheetPixels = 2.5e8;

/// RGB. kInput error: no tiles, or more pixels than a picture may have
/// (kMostSheetPixels, and 32,767 both ways).
Result<Image<std::uint8_t>> draw_sheet(const ContactSheet& sheet);

}  // namespace seedframe
