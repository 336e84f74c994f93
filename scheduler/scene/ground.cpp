#include "scene/ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/sha256.h"
#include "mesh/mesh_buffer.h"
#include "mesh/primitives.h"

namespace seedframe {
namespace {

/// How far from the plane z = 0 of the world something is still in it: more for large meshes, whose
/// positions have 16 bits.
double flush_within_m(const PlacedInstance& instance) {
  const double size = (instance.world_from_object.linear() * instance.asset->box.size()).norm();
  return std::clamp(2e-5 * size, 1e-6, kFlushGroundDropM / 2);
}

/// Whether a triangle lies in the plane z = 0 of the world.
bool has_face_at_zero(const PlacedInstance& instance, double within_m) {
  const Mesh& mesh = instance.asset->mesh;
  const auto height = [&](std::uint32_t vertex) {
    const auto& at = mesh.positions[vertex];
    return (instance.world_from_object * Eigen::Vector3d(at[0], at[1], at[2])).z();
  };
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const std::array<std::uint32_t, 3>& corners) {
                       return std::all_of(corners.begin(), corners.end(),
                                          [&](std::uint32_t vertex) {
                                            return std::abs(height(vertex)) <= within_m;
                                          });
                     });
}

/// Whether a face in the plane z = 0 could be seen there: not of something that stands on it.
bool is_flush(const PlacedInstance& instance) {
  const double within = flush_within_m(instance);
  const double low = instance.asset->lowest_z(instance.world_from_object.linear()) +
                     instance.world_from_object.translation().z();
  double high = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& corner : instance.asset->box.corners()) {
    high = std::max(high, (instance.world_from_object * corner).z());
  }
  const bool meets = low <= within && high >= -within;
  const bool stands = low >= -within && high > within;
  return meets && !stands && has_face_at_zero(instance, within);
}

}  // namespace

void lower_flush_ground(FrameDraft& draft) {
  if (draft.ground_curvature_per_m != 0.0) return;
  const auto is_ground = [](const PlacedInstance& instance) { return instance.asset == nullptr; };
  const auto ground = std::find_if(draft.placed.begin(), draft.placed.end(), is_ground);
  if (ground == draft.placed.end()) return;
  const bool flush = std::any_of(
      draft.placed.begin(), draft.placed.end(),
      [&](const PlacedInstance& instance) { return !is_ground(instance) && is_flush(instance); });
  if (flush) ground->world_from_object.translation().z() -= kFlushGroundDropM;
}

void GroundMaker::add(const CompiledGround& ground, const MaterialPicker& materials,
                      FrameDraft& draft, EvaluationContext& context) {
  const Shape shape = {positive(ground.width_m, "the ground's width_m", context),
                       positive(ground.depth_m, "the ground's depth_m", context),
                       ground.curvature_per_m.evaluate(context)};
  const double corner = 0.125 * shape[2] * (shape[0] * shape[0] + shape[1] * shape[1]);
  constexpr double kFarthest = 1e9;  // metres
  if (!(std::max({shape[0], shape[1], std::abs(corner)}) <= kFarthest)) {
    context.report(ground.place, "the ground is too large to compute with");
    return;
  }
  std::shared_ptr<const GroundMesh> made = last_.find(shape);
  if (made == nullptr) {
    const Mesh mesh = ground_surface(shape[0], shape[1], shape[2]);
    if (const Status seen = check_mesh(mesh, "the ground"); !seen) {
      context.report(ground.place, seen.error().message);
      return;
    }
    std::string buffer = mesh_buffer(mesh);
    std::string sha256 = sha256_hex(buffer);
    made = std::make_shared<const GroundMesh>(GroundMesh{std::move(sha256), std::move(buffer)});
    last_.keep(shape, made);
  }
  draft.ground_curvature_per_m = shape[2];
  PlacedInstance instance;
  instance.spec.name = "ground";
  instance.spec.mesh = made->sha256;
  instance.spec.materials = {
      put_on(materials.draw(ground.materials, nullptr, draft.used, context), 1.0, draft)};
  instance.buffer = {made, &made->buffer};
  draft.placed.push_back(std::move(instance));
}

}  // namespace seedframe
