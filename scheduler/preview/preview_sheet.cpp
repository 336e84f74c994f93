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
    const ClassSizes& each = sizes[i];
    sheet.legend.push_back({LegendEntry::Sign::kLine, class_color(static_cast<int>(i) + 1),
                            each.objects == 0 ? each.name + ": none is seen"
                                              : fmt::format("{}: {:.0f} to {:.0f} px", each.name,
                                                            each.least_px, each.most_px)});
  }
  if (!sheet.tiles.empty()) {
    const Image<std::uint8_t>& tile = sheet.tiles.front().pixels;
    sheet.columns = columns_for(static_cast<int>(sheet.tiles.size()), tile.width, tile.height);
  }
  return sheet;
}

}  // namespace seedframe
