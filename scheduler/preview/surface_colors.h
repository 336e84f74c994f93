// Of which colour surfaces are, where a ray meets them.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "base/error.h"
#include "mesh/mesh_buffer_view.h"
#include "preview/shading_images.h"
#include "rays/ray_scene.h"
#include "scene/expanded_frame.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// How a camera ray meets a surface.
struct Glance {
  float pixel_width_m = 0.0F;  ///< across the ray, where it arrives
  float cosine = 1.0F;         ///< between ray and normal
};

/// Base colours of a frame's materials, with their textures, by the meshes' UVs.
class SurfaceColors {
 public:
  /// `spec` is a view of the frame; both must outlive it, as `images` need not. Errors: of reading
  /// textures (kInput, kEnvironment).
  static Result<SurfaceColors> make(const FrameSpec& spec, const ExpandedFrame& frame,
                                    ShadingImages& images);

  SurfaceColors(SurfaceColors&&) = default;
  SurfaceColors& operator=(SurfaceColors&&) = default;

  /// Linear RGB.
  Eigen::Vector3f color(std::size_t instance, const SurfacePoint& point,
                        const Glance& glance) const;
  /// Of all of the triangle's material.
  const Eigen::Vector3f& mean_color(std::size_t instance, std::uint32_t triangle) const;
  /// Of the triangle itself, in the camera's frame, of unit length; 0 if it has no area.
  Eigen::Vector3f normal(std::size_t instance, std::uint32_t triangle) const;

 private:
  struct Material {
    Eigen::Vector3f base_color, mean_color;
    std::shared_ptr<const Texture> texture;
    double repeat = 1.0;
  };
  struct Surface {
    MeshBufferView mesh;
    std::vector<const Material*> slots;
    Eigen::Matrix3f camera_from_object, camera_from_normal;
    float scale = 1.0F;  ///< metres of a metre of the mesh, of the three axes' the middle one
  };
  SurfaceColors() = default;

  const Material& material(const Surface& surface, std::uint32_t triangle) const;

  std::vector<Material> materials_;
  std::vector<Surface> surfaces_;
};

}  // namespace seedframe
