#include "store/dataset_hash.h"

#include <fmt/format.h>

namespace seedframe {

void DatasetHasher::add(std::int64_t scene, std::int64_t frame, const std::string& frame_id,
                        const std::string& pixel_hash) {
  if (scene_.frames > 0 && scene != scene_.scene) close_scene();
  if (scene_.frames == 0) scene_ = {scene, frame, 0, {}};
  ++scene_.frames;
  scene_complete_ = scene_complete_ && !pixel_hash.empty();
  fmt::format_to(std::back_inserter(scene_lines_), "{} {} {}\n", frame, frame_id, pixel_hash);
}

std::string DatasetHasher::close() {
  if (scene_.frames > 0) close_scene();
  return complete_ ? dataset_.hex() : std::string();
}

void DatasetHasher::close_scene() {
  if (scene_complete_) scene_.hash = sha256_hex(scene_lines_);
  complete_ = complete_ && scene_complete_;
  dataset_.update(fmt::format("{} {}\n", scene_.scene, scene_.hash));
  if (on_scene_) on_scene_(scene_);
  scene_ = {};
  scene_lines_.clear();
  scene_complete_ = true;
}

}  // namespace seedframe
