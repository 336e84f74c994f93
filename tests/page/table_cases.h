// Tables of frames and objects, made by hand.
#pragma once

#include <vector>

#include "page/frame_table.h"

namespace seedframe {

struct TableObject {
  int category = 1;
  int x = 0;
  int y = 0;
  int width = 20;
  int height = 20;
  int visible_permille = 1000;
};

/// A frame that is done and shows these; frames of a scene are three.
inline void add_frame(FrameTable& table, const std::vector<TableObject>& objects,
                      ShownState state = ShownState::kDone, int luma = 100) {
  FrameColumns& frames = table.frames;
  const auto index = static_cast<std::uint32_t>(frames.size());
  frames.index.push_back(index);
  frames.scene.push_back(index / 3);
  frames.state.push_back(static_cast<std::uint8_t>(state));
  frames.attempts.push_back(1);
  frames.worker.push_back(0);
  for (auto* column : {&frames.build_s, &frames.render_s, &frames.finish_s}) column->push_back(1);
  frames.luma.push_back(static_cast<std::uint8_t>(luma));
  if (frames.first_object.empty()) frames.first_object.push_back(0);
  for (const TableObject& object : objects) {
    ObjectColumns& columns = table.objects;
    columns.id.push_back(static_cast<std::uint16_t>(columns.size() + 1));
    columns.category.push_back(static_cast<std::uint16_t>(object.category));
    columns.asset.push_back(0);
    columns.name.push_back(0);
    columns.x.push_back(static_cast<std::uint16_t>(object.x));
    columns.y.push_back(static_cast<std::uint16_t>(object.y));
    columns.width.push_back(static_cast<std::uint16_t>(object.width));
    columns.height.push_back(static_cast<std::uint16_t>(object.height));
    columns.area_px.push_back(static_cast<std::uint32_t>(object.width * object.height));
    columns.visible_permille.push_back(static_cast<std::uint16_t>(object.visible_permille));
    columns.truncation_permille.push_back(0);
    columns.distance_m.push_back(1.0F);
  }
  frames.first_object.push_back(static_cast<std::uint32_t>(table.objects.size()));
}

}  // namespace seedframe
