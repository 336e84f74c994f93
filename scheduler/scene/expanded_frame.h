// One frame, ready to be rendered: its spec, and the files that it needs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "assets/used_files.h"
#include "base/canonical_json.h"
#include "draws/draw_record.h"
#include "mesh/mesh_buffer.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// How often a constraint was looked at, and how often it held.
struct ConstraintTally {
  std::int64_t checked = 0;
  std::int64_t met = 0;
};

struct ExpandedFrame {
  FrameSpec spec;
  std::string id;          ///< frame_id(spec), when asked for
  std::int64_t scene = 0;  ///< index of the scene
  std::int64_t view = 0;   ///< index of the frame within its scene
  Affine world_from_camera = Affine::Identity();
  std::uint32_t attempts = 1;  ///< to meet the constraints
  std::vector<Draw> draws;     ///< when asked for
  Json graph;                  ///< the values of all variables, when asked for
  MeshBuffers meshes;          ///< of its instances, the ground included
  /// What it was drawn from; the images that its spec names are among `images`.
  UsedFiles used;
  std::vector<ConstraintTally> constraints;  ///< in the order of the config, over its attempts
};

/// What expanding a frame should tell beside its spec.
struct ExpansionWishes {
  bool id = true;
  bool draws = false;
  bool graph = false;
};

}  // namespace seedframe
