#include "preview/object_sizes.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/message_text.h"

namespace seedframe {

ObjectSizes::ObjectSizes(std::vector<std::string> categories)
    : categories_(std::move(categories)),
      sides_(categories_.size()),
      hidden_(categories_.size(), 0) {}

void ObjectSizes::add(const FrameLabels& labels, double scale) {
  for (const InstanceLabel& label : labels.instances) {
    if (label.category == 0) continue;
    const auto category = static_cast<std::size_t>(label.category) - 1;
    if (label.area_px == 0) {
      ++hidden_[category];
    } else {
      sides_[category].push_back(scale * std::max(label.box.width, label.box.height));
    }
  }
}

std::vector<ClassSizes> ObjectSizes::by_class() const {
  std::vector<ClassSizes> all;
  for (std::size_t category = 0; category < categories_.size(); ++category) {
    ClassSizes& sizes = all.emplace_back();
    sizes.name = categories_[category];
    sizes.hidden = hidden_[category];
    std::vector<double> sides = sides_[category];
    sizes.objects = static_cast<std::int64_t>(sides.size());
    if (sides.empty()) continue;
    std::sort(sides.begin(), sides.end());
    sizes.least_px = sides.front();
    sizes.median_px = sides[sides.size() / 2];
    sizes.most_px = sides.back();
  }
  return all;
}

std::vector<std::string> lines_of(const std::vector<ClassSizes>& sizes, std::int64_t frames) {
  constexpr std::size_t kLongestName = 28;
  std::vector<std::string> lines = {fmt::format("{:<30}{:>8} {:>9} {:>9} {:>9}",
                                                "longer side of boxes, px", "a frame", "least",
                                                "median", "most")};
  for (const ClassSizes& each : sizes) {
    const std::string name = shortened(each.name, kLongestName);
    if (each.objects == 0) {
      lines.push_back(fmt::format("  {:<28}{:>8}", name, "none"));
      continue;
    }
    lines.push_back(fmt::format("  {:<28}{:>8.1f} {:>9.0f} {:>9.0f} {:>9.0f}", name,
                                static_cast<double>(each.objects) / static_cast<double>(frames),
                                each.least_px, each.median_px, each.most_px));
  }
  return lines;
}

}  // namespace seedframe
