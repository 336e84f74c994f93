// A tree of hashes over a dataset, so that two are compared quickly: frames, scenes, all
// (docs/formats/job-store.md).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/sha256.h"

namespace seedframe {

struct SceneHash {
  std::int64_t scene = 0;
  std::int64_t first_frame = 0;
  std::int64_t frames = 0;
  std::string hash;  ///< empty when a frame of it is not done
};

class DatasetHasher {
 public:
  using OnScene = std::function<void(const SceneHash&)>;

  /// `on_scene` is called for each scene, once all its frames are in.
  explicit DatasetHasher(OnScene on_scene = {}) : on_scene_(std::move(on_scene)) {}

  /// Frames in order, scene by scene. `pixel_hash` is empty for a frame that is not done.
  void add(std::int64_t scene, std::int64_t frame, const std::string& frame_id,
           const std::string& pixel_hash);

  /// The hash of the dataset, over its scenes'; empty when a frame is not done. The object must not
  /// be used afterwards.
  std::string close();

 private:
  void close_scene();

  OnScene on_scene_;
  Sha256 dataset_;
  bool complete_ = true;
  SceneHash scene_;
  std::string scene_lines_;
  bool scene_complete_ = true;
};

}  // namespace seedframe
