// Thumbnails of consecutive frames in one picture, and their masks in one stack of bytes.
#pragma once

#include <optional>
#include <string>

#include "base/canonical_json.h"
#include "base/error.h"
#include "page/thumbnail.h"

namespace seedframe {

/// How many thumbnails of a size a sheet has, and where.
struct SheetLayout {
  ThumbnailSize cell;
  int columns = 1;
  int rows = 1;

  int cells() const { return columns * rows; }
};
SheetLayout sheet_layout(ThumbnailSize cell);

class SpriteSheet {
 public:
  /// Cells that are never set stay black, and without objects. `cells`: of those of the layout, so
  /// many are used.
  SpriteSheet(const SheetLayout& layout, int cells, bool has_pictures);

  /// From several threads for different cells. Without a picture where the campaign has none.
  void set(int cell, const std::optional<Image<std::uint8_t>>& picture,
           const Image<std::uint8_t>& mask);

  /// {"sprite": base64 of a WebP, or null, "masks": packed}. In `masks` each cell has its
  /// width · height bytes, rows from the second on as the exclusive or with the row above.
  Result<Json> encode() const;

 private:
  SheetLayout layout_;
  std::optional<Image<std::uint8_t>> pictures_;
  std::string masks_;
};

}  // namespace seedframe
