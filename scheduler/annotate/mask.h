// The binary mask of one instance: a view onto the instance-id image, cropped to the instance's
// box.
#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

#include "annotate/labels.h"
#include "image/image.h"

namespace seedframe {

/// Keeps a pointer to the id image, which must outlive it. Rows and columns are the image's.
class Mask {
 public:
  Mask(const Image<std::uint16_t>& instance_ids, int id, const PixelRect& box);

  int image_width() const { return ids_->width; }
  int image_height() const { return ids_->height; }
  const PixelRect& box() const { return box_; }

  /// Whether the pixel belongs to the instance; false outside the box, and so outside the image.
  bool at(int row, int column) const {
    return box_.contains(column, row) && ids_->at(row, column) == id_;
  }

  std::int64_t area_px() const;

  /// Calls visit(column, row) wherever a pixel is of the mask and the one above it is not, or the
  /// other way round, by columns and then rows; the row below a column's last pixel counts, even
  /// below the image.
  template <class Visit>
  void for_each_change(Visit visit) const {
    std::vector<Change> changes;
    changes_by_column(changes);
    for (const Change& change : changes) visit(change.column, change.row);
  }

 private:
  struct Change {
    std::int32_t column = 0;
    std::int32_t row = 0;
  };
  void changes_by_column(std::vector<Change>& changes) const;

  const Image<std::uint16_t>* ids_;
  std::uint16_t id_;
  PixelRect box_;
};

}  // namespace seedframe
