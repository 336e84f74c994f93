// Scenes that strain the numbers: far, large, small, narrow, wide, thin, coincident, nested, cut.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "assets/asset_library.h"
#include "mesh/mesh_buffer.h"
#include "spec/frame_spec.h"

namespace seedframe {

struct StabilityCase {
  std::string axis;          ///< what is varied: "field of view"
  std::string name;          ///< a place on it: "5°"
  std::optional<double> at;  ///< the same as a number; none: it has no place in a chart
  std::vector<FrameSpec> frames;
  /// Where Blender's camera and all else stand in Blender's world: not 0 shows what would happen if
  /// the frame were not relative to the camera.
  std::array<double, 3> blender_origin_m{};
};

/// How a case looks at its scene.
struct StabilityView {
  double fov_deg = 50.0;
  double scale = 1.0;     ///< of the whole scene
  double offset_m = 0.0;  ///< of the whole scene, along (1, 1, 1)
  double aspect = 1.0;    ///< focal length along y over that along x
  double shift = 0.0;     ///< of the principal point to the left, in widths of the image
  double clip_start_m = 0.001;
  double clip_end_m = 1000.0;
};

class StabilityScenes {
  using View = StabilityView;

 public:
  /// Those of axes whose name contains `only`.
  StabilityScenes(AssetLibrary library, std::string only);

  const MeshBuffers& buffers() const { return buffers_; }
  const std::vector<StabilityCase>& cases() const { return cases_; }

 private:
  struct Part {
    std::string mesh;
    int slots = 0;
  };
  std::string add_mesh(const Mesh& mesh);
  static InstanceSpec instance(const Part& part, const Affine& camera_from_object);
  void add(const std::string& axis, const std::string& name, std::optional<double> at,
           std::vector<FrameSpec> frames, const std::array<double, 3>& blender_origin_m = {});
  static FrameSpec empty_frame(const View& view);
  static std::vector<FrameSpec> empty_frames(const View& view = {});
  /// Twelve parts in the view, turned and placed at random.
  std::vector<FrameSpec> parts(const View& view) const { return scattered(parts_, view); }
  static std::vector<FrameSpec> scattered(const std::vector<Part>& parts, const View& view);

  // Views of the same parts (views.cpp).
  void add_distances();
  void add_distances_in_object_space();
  void add_scales();
  void add_fields_of_view();
  void add_nested_scales();
  void add_aspects();
  void add_shifts();
  void add_clips();
  // Meshes that are hard in themselves (shapes.cpp).
  void add_grazing();
  void add_slivers();
  void add_gaps();
  void add_many_triangles();
  void add_touching_and_nested();
  void add_tiny();

  std::string only_;
  std::vector<Mesh> part_meshes_;
  std::vector<Part> parts_;
  MeshBuffers buffers_;
  std::vector<StabilityCase> cases_;
};

}  // namespace seedframe
