// The contact sheet of a preview.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "picture/contact_sheet.h"
#include "preview/object_sizes.h"
#include "preview/previewed_frame.h"

namespace seedframe {

struct PreviewText {
  std::string title;
  std::string subtitle;              ///< how the pictures were made
  std::vector<std::string> remarks;  ///< below the legend: warnings, costs
};

/// Boxes and class names over each frame; the legend says how large objects of each class are.
ContactSheet preview_sheet(const std::vector<PreviewedFrame>& frames,
                           const std::vector<ClassSizes>& sizes, const PreviewText& text);

}  // namespace seedframe
