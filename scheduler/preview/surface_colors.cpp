#include "preview/surface_colors.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace seedframe {
namespace {

using Eigen::Vector3f;

Vector3f vector_of(const Rgb& color) {
  return Eigen::Vector3d(color[0], color[1], color[2]).cast<float>();
}

struct Edges {
  Vector3f first, second;
};

/// From a triangle's first corner to the others, in object space.
Edges edges_of(const MeshBufferView& mesh, std::uint32_t triangle) {
  const auto corners = mesh.triangle(triangle);
  const auto at = [&](std::size_t corner) -> Vector3f {
    return Eigen::Map<const Vector3f>(mesh.position(corners[corner]).data());
  };
  const Vector3f origin = at(0);
  return {at(1) - origin, at(2) - origin};
}

}  // namespace

Result<SurfaceColors> SurfaceColors::make(const FrameSpec& spec, const ExpandedFrame& frame,
                                          ShadingImages& images) {
  SurfaceColors colors;
  colors.materials_.reserve(spec.materials.size());
  for (const MaterialSpec& source : spec.materials) {
    Material& material = colors.materials_.emplace_back();
    material.base_color = material.mean_color = vector_of(source.base_color);
    material.repeat = source.texture_repeat;
    const auto texture = source.textures.find("color");
    if (texture == source.textures.end()) continue;
    auto read = images.texture(*frame.used.images.at(texture->second));
    if (!read) return forward_error(read);
    material.texture = std::move(*read);
    material.mean_color = material.base_color.cwiseProduct(material.texture->mean());
  }
  colors.surfaces_.reserve(spec.instances.size());
  for (const InstanceSpec& instance : spec.instances) {
    Surface& surface = colors.surfaces_.emplace_back();
    surface.mesh = MeshBufferView(*frame.meshes.at(instance.mesh));
    for (const int index : instance.materials) {
      surface.slots.push_back(&colors.materials_[static_cast<std::size_t>(index)]);
    }
    const Eigen::Matrix3d linear = instance.camera_from_object.linear();
    surface.camera_from_object = linear.cast<float>();
    surface.camera_from_normal = linear.inverse().transpose().cast<float>();
    surface.scale = static_cast<float>(std::cbrt(std::abs(linear.determinant())));
  }
  return colors;
}

const SurfaceColors::Material& SurfaceColors::material(const Surface& surface,
                                                       std::uint32_t triangle) const {
  if (surface.slots.size() == 1) return *surface.slots.front();
  return *surface.slots[surface.mesh.slot(triangle)];
}

Vector3f SurfaceColors::color(std::size_t instance, const SurfacePoint& point,
                              const Glance& glance) const {
  const Surface& surface = surfaces_[instance];
  const Material& own = material(surface, point.triangle);
  if (own.texture == nullptr) return own.base_color;
  const auto uvs = surface.mesh.uvs(point.triangle);
  const std::array<double, 2> u = {double{uvs[1][0]} - uvs[0][0], double{uvs[2][0]} - uvs[0][0]};
  const std::array<double, 2> v = {double{uvs[1][1]} - uvs[0][1], double{uvs[2][1]} - uvs[0][1]};
  // Of the pixel's footprint, which is longer the flatter the ray comes, the root of the area.
  const Edges edges = edges_of(surface.mesh, point.triangle);
  const double area = edges.first.cross(edges.second).norm() * surface.scale * surface.scale;
  const double uv_area = std::abs(u[0] * v[1] - u[1] * v[0]);
  const double width =
      glance.pixel_width_m / std::sqrt(std::max(glance.cosine, 1e-3F)) * std::sqrt(uv_area / area);
  return own.base_color.cwiseProduct(own.texture->color(
      own.repeat * (uvs[0][0] + point.u * u[0] + point.v * u[1]),
      own.repeat * (uvs[0][1] + point.u * v[0] + point.v * v[1]), own.repeat * width));
}

const Vector3f& SurfaceColors::mean_color(std::size_t instance, std::uint32_t triangle) const {
  return material(surfaces_[instance], triangle).mean_color;
}

Vector3f SurfaceColors::normal(std::size_t instance, std::uint32_t triangle) const {
  const Surface& surface = surfaces_[instance];
  const Edges edges = edges_of(surface.mesh, triangle);
  const Vector3f normal = surface.camera_from_normal * edges.first.cross(edges.second);
  const float length = normal.norm();
  return length > 0.0F ? Vector3f(normal / length) : Vector3f::Zero();
}

}  // namespace seedframe
