#include "scene/ground.h"

#include <algorithm>
#include <cmath>

#include "base/sha256.h"
#include "mesh/mesh_buffer.h"
#include "mesh/primitives.h"

namespace seedframe {

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
  instance.spec.materials = {materials.add(ground.materials, draft, context)};
  instance.buffer = {made, &made->buffer};
  draft.placed.push_back(std::move(instance));
}

}  // namespace seedframe
