// The binary mask of one instance: a view onto the instance-id image, cropped to the instance's
// box.
#pragma once

#include <cassert>
#include <cstdint>

#include "annotate/labels.h"
#include "image/image.h"

namespace seedframe {

/// Keeps a pointer to the id image, which must outlive it. Rows and columns are the image's.
class Mask {
 public:
  Mask(const Image<std::uint16_t>& instance_ids, int id, const PixelBox& box);

  int image_width() const { return ids_->width; }
  int image_height() const { return ids_->height; }
  const PixelBox& box() const { return box_; }

  /// Whether the pixel belongs to the instance; false outside the box, and so outside the image.
  bool at(int row, int column) const {
    return row >= box_.y && row < box_.y + box_.height && column >= box_.x &&
           column < box_.x + box_.width && ids_->at(row, column) == id_;
  }

  std::int64_t area_px() const;

 private:
  const Image<std::uint16_t>* ids_;
  std::uint16_t id_;
  PixelBox box_;
};

}  // namespace seedframe
