// How large objects of each class are in their images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "annotate/labels.h"

namespace seedframe {

/// The longer side of visible boxes, in pixels of the full image.
struct ClassSizes {
  std::string name;
  std::int64_t objects = 0;  ///< visible ones, over all frames
  double least_px = 0.0, median_px = 0.0, most_px = 0.0;
  std::int64_t hidden = 0;  ///< objects of which nothing is seen
};

class ObjectSizes {
 public:
  explicit ObjectSizes(std::vector<std::string> categories);
  /// `scale`: pixels of the full image for one of the labels'.
  void add(const FrameLabels& labels, double scale);
  /// One for each class, in their order.
  std::vector<ClassSizes> by_class() const;

 private:
  std::vector<std::string> categories_;
  std::vector<std::vector<double>> sides_;
  std::vector<std::int64_t> hidden_;
};

/// A table for a terminal of 80 columns, its heading first.
std::vector<std::string> lines_of(const std::vector<ClassSizes>& sizes, std::int64_t frames);

}  // namespace seedframe
