#include "preview/preview_sheet.h"

#include <algorithm>

#include <fmt/format.h>

#include "picture/frame_picture.h"

namespace seedframe {
namespace {

constexpr int kTileWidth = 320;
constexpr int kLeastTileWidth = 160;

std::string note_of(const FrameContent& content) {
  const auto& instances = content.labels.instances;
  const auto objects = std::count_if(
      instances.begin(), instances.end(),
      [](const InstanceLabel& label) { return label.category > 0 && label.area_px > 0; });
  return fmt::format("{} object{}", objects, objects == 1 ? "" : "s");
}

/// "12 to 40 px".
std::string range_of(const ClassSizes& sizes) {
  if (sizes.objects == 0) return "none is seen";
  const std::string least = fmt::format("{:.0f}", sizes.least_px);
  const std::string most = fmt::format("{:.0f} px", sizes.most_px);
  return most.starts_with(least + " ") ? most : least + " to " + most;
}

}  // namespace

ContactSheet preview_sheet(const std::vector<PreviewedFrame>& frames,
                           const std::vector<ClassSizes>& sizes, const PreviewText& text) {
  ContactSheet sheet;
  sheet.title = text.title;
  sheet.subtitle = text.subtitle;
  sheet.remarks = text.remarks;
  for (const PreviewedFrame& frame : frames) {
    const Image<std::uint16_t>& ids = frame.content.instance_ids;
    FramePicture picture =
        draw_frame(frame.content, {Layer::kImage, Layer::kBoxes, Layer::kNames},
                   tile_size(ids.width, ids.height, kTileWidth, kLeastTileWidth));
    sheet.tiles.push_back(
        {std::move(picture.pixels), fmt::format("frame {}", frame.index), note_of(frame.content)});
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    sheet.legend.push_back({LegendEntry::Sign::kLine, class_color(static_cast<int>(i) + 1),
                            sizes[i].name + ": " + range_of(sizes[i])});
  }
  if (!sheet.tiles.empty()) {
    const Image<std::uint8_t>& tile = sheet.tiles.front().pixels;
    sheet.columns = columns_for(static_cast<int>(sheet.tiles.size()), tile.width, tile.height);
  }
  return sheet;
}

}  // namespace seedframe
