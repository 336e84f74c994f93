// Scenes that strain the numbers: far, large, small, narrow, wide, thin, coincident, nested, cut.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "assets/asset_library.h"
#include "mesh/mesh_buffer.h"
#include "spec/frame_spec.h"

namespace seedframe {

struct StabilityCase {
  std::string group;  ///< "distance", "scale", …
  std::string name;   ///< within its group
  std::vector<FrameSpec> frames;
  /// Where Blender's camera and all else stand in Blender's world: not 0 shows what would happen if
  /// the frame were not relative to the camera.
  std::array<double, 3> blender_origin_m{};
};

class StabilityScenes {
 public:
  explicit StabilityScenes(AssetLibrary library);

  const MeshBuffers& buffers() const { return buffers_; }
  const std::vector<StabilityCase>& cases() const { return cases_; }

 private:
  std::string add_mesh(const Mesh& mesh);
  InstanceSpec instance(const std::string& mesh, int slots, const Affine& camera_from_object);
  void add(const std::string& group, const std::string& name, std::vector<FrameSpec> frames);

  struct View {
    double fov_deg = 50.0;
    double scale = 1.0;     ///< of the whole scene
    double offset_m = 0.0;  ///< of the whole scene, along (1, 1, 1)
    double clip_start_m = 0.001;
  };
  /// Twelve parts in the view, turned and placed at random.
  std::vector<FrameSpec> parts(const View& view);
  FrameSpec empty_frame(const View& view) const;

  void add_distances();
  void add_scales();
  void add_fields_of_view();
  void add_thin_and_coincident();
  void add_touching_and_nested();
  void add_tiny_and_cut();

  std::vector<std::pair<std::string, int>> parts_;  ///< mesh and its number of slots
  MeshBuffers buffers_;
  std::vector<StabilityCase> cases_;
};

}  // namespace seedframe
