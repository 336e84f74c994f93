#include "twin/twin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <unordered_map>

#include "image/crop.h"
#include "mesh/mesh_buffer.h"

namespace seedframe {
namespace {

/// Of all kept meshes; about 150 bytes each.
constexpr std::size_t kMostTriangles = 20'000'000;

/// Where vertices are far from their mesh's origin, nearly all bits of a float32 would tell how
/// far: there the middle of the mesh, elsewhere 0. Such vertices minus their middle are float32
/// numbers without rounding (Sterbenz, "Floating-point computation", 1974). The worker does the
/// same.
Eigen::Vector3d far_middle(const BoundingBox& box) {
  constexpr double kFar = 8.0;  // as a multiple of the mesh's size
  const double far = kFar * box.size().maxCoeff();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<float>(box.centre()[axis]);
    if (std::abs(at) > far) middle[axis] = at;
  }
  return middle;
}

void move(Mesh& mesh, const Eigen::Vector3d& by) {
  for (auto& position : mesh.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis] += static_cast<float>(by[static_cast<Eigen::Index>(axis)]);
    }
  }
}

Image<float> depth_image(const RayImage& traced) {
  Image<float> depth(traced.width, traced.height);
  depth.values = traced.depth;
  return depth;
}

Image<float> normal_image(const RayImage& traced) {
  Image<float> normal(traced.width, traced.height, 3);
  auto out = normal.values.begin();
  for (const auto& each : traced.normals) out = std::copy(each.begin(), each.end(), out);
  return normal;
}

}  // namespace

PixelCamera pixel_camera(const FrameSpec& spec) {
  return {spec.render.width,     spec.render.height,       spec.camera.focal_px,
          spec.camera.center_px, spec.camera.clip_start_m, spec.camera.clip_end_m};
}

Twin::Twin(RayScene scene, RayImage image, Names names)
    : instance_ids(image.width, image.height),
      scene_(std::move(scene)),
      image_(std::move(image)),
      ids_(std::move(names.ids)),
      object_boxes_(std::move(names.object_boxes)) {
  std::transform(
      image_.instance.begin(), image_.instance.end(), instance_ids.values.begin(),
      [&](std::int32_t hit) {
        return static_cast<std::uint16_t>(hit < 0 ? 0 : ids_[static_cast<std::size_t>(hit)]);
      });
}

bool Twin::grazes(int row, int column, std::uint16_t id) const {
  constexpr double kFar = 0.01;
  constexpr double kDiagonal = 0.007;
  constexpr std::array<std::array<double, 2>, 8> kOffsets = {{{kFar, 0},
                                                              {-kFar, 0},
                                                              {0, kFar},
                                                              {0, -kFar},
                                                              {kDiagonal, kDiagonal},
                                                              {kDiagonal, -kDiagonal},
                                                              {-kDiagonal, kDiagonal},
                                                              {-kDiagonal, -kDiagonal}}};
  return std::any_of(kOffsets.begin(), kOffsets.end(), [&](const std::array<double, 2>& offset) {
    const int hit = scene_.first_hit(column, row, offset);
    return (hit < 0 ? 0 : ids_[static_cast<std::size_t>(hit)]) == static_cast<int>(id);
  });
}

bool Twin::coincides(int row, int column, std::uint16_t id) const {
  const std::vector<int> met = scene_.first_hits(column, row);
  return std::any_of(met.begin(), met.end(), [&](int instance) {
    return ids_[static_cast<std::size_t>(instance)] == static_cast<int>(id);
  });
}

std::vector<Silhouette> Twin::silhouettes(const Image<std::uint16_t>& visible_ids) const {
  std::vector<Silhouette> silhouettes(ids_.size());
  if (visible_ids.values == instance_ids.values) {
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      if (ids_[i] != 0) silhouettes[i] = scene_.silhouette(i, image_);
    }
    return silhouettes;
  }
  std::unordered_map<int, std::int32_t> index_of_id;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (ids_[i] != 0) index_of_id[ids_[i]] = static_cast<std::int32_t>(i);
  }
  RayImage visible{visible_ids.width, visible_ids.height, {}, image_.depth, {}, {}};
  std::vector<PixelRect> extents(ids_.size());
  visible.instance.reserve(visible_ids.values.size());
  for (int y = 0; y < visible_ids.height; ++y) {
    for (int x = 0; x < visible_ids.width; ++x) {
      const auto found = index_of_id.find(visible_ids.at(y, x));
      visible.instance.push_back(found == index_of_id.end() ? -1 : found->second);
      if (found == index_of_id.end()) continue;
      PixelRect& extent = extents[static_cast<std::size_t>(found->second)];
      extent = union_of(extent, {x, y, 1, 1});
    }
  }
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (ids_[i] != 0) silhouettes[i] = scene_.silhouette(i, visible, extents[i]);
  }
  return silhouettes;
}

void Twin::keep_only(const PixelRect& region) {
  fill_outside(instance_ids, region, std::uint16_t{0});
  if (depth) fill_outside(*depth, region, kNoDepth);
  if (normal) fill_outside(*normal, region, 0.0F);
}

Result<Twin> TwinTracer::trace(const FrameSpec& spec, const MeshBuffers& buffers, Passes passes) {
  try {
    std::vector<RayInstance> instances;
    Twin::Names names;
    instances.reserve(spec.instances.size());
    for (const InstanceSpec& instance : spec.instances) {
      auto found = mesh(instance.mesh, buffers);
      if (!found) return forward_error(found);
      const auto& [mesh, origin] = *found;
      Eigen::Affine3d camera_from_mesh(instance.camera_from_object.matrix());
      camera_from_mesh.translate(origin);
      instances.push_back(
          {mesh, camera_from_mesh, !instance.hidden_from.camera, !instance.hidden_from.shadow});
      names.ids.push_back(instance.id);
      names.object_boxes.push_back({mesh->box().low + origin, mesh->box().high + origin});
    }
    trim();
    RayScene scene(pixel_camera(spec), std::move(instances));
    const bool surfaces = passes == Passes::kSurfaces;
    const bool depth = passes == Passes::kAsked && spec.render.depth;
    const bool normal = passes == Passes::kAsked && spec.render.normal;
    RayImage image = scene.trace({.depth = true,
                                  .portable_depth = depth || surfaces,
                                  .normals = normal || surfaces,
                                  .points = surfaces,
                                  .threads = threads_});
    Twin twin(std::move(scene), std::move(image), std::move(names));
    if (depth) twin.depth = depth_image(twin.image_);
    if (normal) twin.normal = normal_image(twin.image_);
    if (spec.render.region) twin.keep_only(*spec.render.region);
    return twin;
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::kExhausted,
                "there is not enough memory to trace a frame of {} instances, {}x{} pixels",
                spec.instances.size(), spec.render.width, spec.render.height);
  }
}

Result<TwinTracer::MovedMesh> TwinTracer::mesh(const std::string& sha256,
                                               const MeshBuffers& buffers) {
  const std::lock_guard lock(mutex_);
  Entry& entry = meshes_[sha256];
  if (!entry.moved.mesh) {
    const auto buffer = buffers.find(sha256);
    auto read =
        buffer == buffers.end()
            ? Result<Mesh>(fail(ErrorKind::kInput, "mesh {} is in the frame spec, but not given",
                                sha256.substr(0, 12)))
            : mesh_from_buffer(*buffer->second, "mesh " + sha256.substr(0, 12));
    if (!read) {
      meshes_.erase(sha256);
      return forward_error(read);
    }
    entry.moved.origin = far_middle(bounding_box(*read));
    move(*read, -entry.moved.origin);
    entry.moved.mesh = std::make_shared<const RayMesh>(*read);
    triangles_ += entry.moved.mesh->triangle_count();
  }
  entry.last_used = ++uses_;
  return entry.moved;
}

void TwinTracer::trim() {
  const std::lock_guard lock(mutex_);
  while (triangles_ > kMostTriangles && meshes_.size() > 1) {
    const auto oldest = std::min_element(
        meshes_.begin(), meshes_.end(),
        [](const auto& a, const auto& b) { return a.second.last_used < b.second.last_used; });
    if (const auto& mesh = oldest->second.moved.mesh) triangles_ -= mesh->triangle_count();
    meshes_.erase(oldest);
  }
}

}  // namespace seedframe
