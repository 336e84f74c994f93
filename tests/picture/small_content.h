// A frame of 8 × 6 pixels with two gears, a bolt and a distractor.
#pragma once

#include <array>
#include <string>

#include "annotate/rle.h"
#include "picture/frame_content.h"

namespace seedframe {

using Pixel = std::array<std::uint8_t, 3>;

inline Pixel pixel_at(const Image<std::uint8_t>& image, int row, int column) {
  return {image.at(row, column, 0), image.at(row, column, 1), image.at(row, column, 2)};
}

inline InstanceLabel instance_at(int id, int category, const PixelRect& box) {
  InstanceLabel label;
  label.id = id;
  label.category = category;
  label.name = "object/" + std::to_string(id);
  label.box = box;
  label.area_px = box.area();
  return label;
}

/// Its image is 200, 150, 100 all over. Gears: ids 1 and 2; the bolt: 3, also behind a gear and
/// beyond the image; the distractor: 4.
inline FrameContent small_content() {
  FrameContent content;
  content.labels.width = 8;
  content.labels.height = 6;
  content.labels.categories = {"gear", "bolt"};
  content.labels.instances = {instance_at(1, 1, {0, 0, 2, 2}), instance_at(2, 1, {3, 0, 2, 2}),
                              instance_at(3, 2, {0, 3, 3, 2}), instance_at(4, 0, {6, 4, 2, 2})};
  content.instance_ids = Image<std::uint16_t>(8, 6);
  for (const InstanceLabel& label : content.labels.instances) {
    for (int row = label.box.y; row < label.box.end_y(); ++row) {
      for (int column = label.box.x; column < label.box.end_x(); ++column) {
        content.instance_ids.at(row, column) = static_cast<std::uint16_t>(label.id);
      }
    }
  }
  AmodalLabel& amodal = content.labels.instances[2].amodal.emplace();
  amodal.box = {-2, 3, 7, 2};
  amodal.area_px = amodal.box.area();
  amodal.rle = rle_string({2, 7, {0, 14}});
  content.image.emplace(8, 6, 3);
  for (std::size_t i = 0; i < content.image->values.size(); ++i) {
    content.image->values[i] = static_cast<std::uint8_t>(200 - 50 * static_cast<int>(i % 3));
  }
  return content;
}

}  // namespace seedframe
