#include "page/frame_table.h"

#include "page/packed.h"

namespace seedframe {

std::uint32_t TextTable::place_of(const std::string& text) {
  const auto [found, is_new] = places_.try_emplace(text, static_cast<std::uint32_t>(texts_.size()));
  if (is_new) texts_.push_back(text);
  return found->second;
}

Json to_json(const FrameColumns& frames) {
  return {{"count", frames.size()},
          {"index", column_of(frames.index)},
          {"scene", column_of(frames.scene)},
          {"state", column_of(frames.state)},
          {"attempts", column_of(frames.attempts)},
          {"worker", column_of(frames.worker)},
          {"build_s", column_of(frames.build_s)},
          {"render_s", column_of(frames.render_s)},
          {"finish_s", column_of(frames.finish_s)},
          {"luma", column_of(frames.luma)},
          {"first_object", column_of(frames.first_object)}};
}

Json to_json(const ObjectColumns& objects) {
  return {{"count", objects.size()},
          {"id", column_of(objects.id)},
          {"category", column_of(objects.category)},
          {"asset", column_of(objects.asset)},
          {"name", column_of(objects.name)},
          {"x", column_of(objects.x)},
          {"y", column_of(objects.y)},
          {"width", column_of(objects.width)},
          {"height", column_of(objects.height)},
          {"area_px", column_of(objects.area_px)},
          {"visible_permille", column_of(objects.visible_permille)},
          {"truncation_permille", column_of(objects.truncation_permille)},
          {"distance_m", column_of(objects.distance_m)}};
}

}  // namespace seedframe
