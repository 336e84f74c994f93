// The cases that look at the same parts in other ways.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tests/mesh/example_meshes.h"
#include "tests/stability/cases.h"
#include "tests/stability/draws.h"

namespace seedframe {

void StabilityScenes::add_distances() {
  for (const double metres : {0.0, 1e2, 1e4, 1e6, 1e7}) {
    add("distance from the world's origin", fmt::format("{:g} m", metres), metres,
        parts({.offset_m = metres}));
  }
  for (const double metres : {1.0, 1e2, 1e4, 1e6}) {
    const double each = metres / std::sqrt(3.0);
    add("distance, not relative to the camera", fmt::format("{:g} m", metres), metres, parts({}),
        {each, each, each});
  }
}

void StabilityScenes::add_distances_in_object_space() {
  for (const double metres : {1.0, 1e1, 1e2, 1e3, 1e4, 1e5}) {
    std::vector<Part> moved;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      Mesh mesh = part_meshes_[i];
      for (auto& position : mesh.positions) position[0] += static_cast<float>(metres);
      // The rounded coordinates are the mesh; here and there a triangle has no area any more.
      if (check_mesh(mesh, "moved")) moved.push_back({add_mesh(mesh), parts_[i].slots});
    }
    std::vector<FrameSpec> frames = scattered(moved, {});
    for (FrameSpec& frame : frames) {
      for (InstanceSpec& part : frame.instances) {
        part.camera_from_object.translate(Eigen::Vector3d(-metres, 0, 0));
      }
    }
    add("vertices far from their mesh's origin", fmt::format("{:g} m", metres), metres,
        std::move(frames));
  }
}

void StabilityScenes::add_scales() {
  for (const double scale : {1e-4, 1e-3, 1e-2, 1.0, 1e2, 1e4, 1e5}) {
    add("size of the scene", fmt::format("parts of {:g} m", 0.1 * scale), 0.1 * scale,
        parts({.scale = scale, .clip_start_m = std::max(1e-3, 1e-6 / scale)}));
  }
}

void StabilityScenes::add_fields_of_view() {
  for (const double degrees : {0.01, 0.1, 0.5, 1.0, 5.0, 20.0, 50.0, 90.0, 120.0, 150.0, 170.0}) {
    add("field of view", fmt::format("{:g}°", degrees), degrees,
        parts({.fov_deg = degrees, .clip_end_m = 1e5}));
  }
}

void StabilityScenes::add_nested_scales() {
  const Part room = {add_mesh(example_cube()), 2};
  for (const double scale : {1.0, 1e-1, 1e-2, 1e-3, 1e-4}) {
    // Parts of 0.1 · scale in a room of 2 / scale, whose middle is not the camera's place.
    std::vector<FrameSpec> frames = parts({.scale = scale,
                                           .clip_start_m = std::max(1e-3, 1e-6 / scale),
                                           .clip_end_m = 10.0 / (scale * scale)});
    Draws draw("rooms");
    for (FrameSpec& frame : frames) {
      const Eigen::Vector3d middle(draw(-0.5, 0.5), draw(-0.5, 0.5), draw(-0.5, 0.5));
      frame.instances.push_back(
          instance(room, placed(middle / scale, 1.0 / scale, draw.rotation())));
    }
    const double ratio = 2.0 / (0.1 * scale * scale);
    add("small things in large ones", fmt::format("1 : {:g}", ratio), ratio, std::move(frames));
  }
}

void StabilityScenes::add_aspects() {
  for (const double aspect : {0.005, 0.01, 0.1, 1.0, 10.0, 100.0, 200.0}) {
    add("aspect of the pixels", fmt::format("fy = {:g} fx", aspect), aspect,
        parts({.aspect = aspect}));
  }
}

void StabilityScenes::add_shifts() {
  for (const double widths : {0.0, 0.5, 1.0, 2.0, 5.0, 20.0}) {
    add("shift of the lens", fmt::format("{:g} widths", widths), widths, parts({.shift = widths}));
  }
}

void StabilityScenes::add_clips() {
  struct Clip {
    double start_m, end_m;
  };
  const std::string axis = "clip planes";
  for (const auto& [start_m, end_m] :
       {Clip{1e-3, 1e3}, Clip{1e-6, 1e3}, Clip{1e-6, 1e9}, Clip{1e-6, 1e30}}) {
    add(axis, fmt::format("{:g} m to {:g} m", start_m, end_m), std::nullopt,
        parts({.clip_start_m = start_m, .clip_end_m = end_m}));
  }
  // The parts are at 0.43 m, ± 0.1 m and their own size.
  for (const double metres : {0.35, 0.43, 0.5}) {
    add(axis, fmt::format("from {:g} m, through the parts", metres), std::nullopt,
        parts({.clip_start_m = metres}));
    add(axis, fmt::format("to {:g} m, through the parts", metres), std::nullopt,
        parts({.clip_end_m = metres}));
  }
}

}  // namespace seedframe
