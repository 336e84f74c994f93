#include "scene/ground.h"

#include <algorithm>
#include <cmath>

#include "base/sha256.h"
#include "mesh/mesh_buffer.h"
#include "mesh/primitives.h"

namespace seedframe {

void GroundMaker::add(const CompiledGround& ground, MaterialPicker& materials, FrameDraft& draft,
                      EvaluationContext& context) {
  const std::array<double, 3> shape = {positive(ground.width_m, "the ground's width_m", context),
                                       positive(ground.depth_m, "the ground's depth_m", context),
                                       ground.curvature_per_m.evaluate(context)};
  const double corner = 0.125 * shape[2] * (shape[0] * shape[0] + shape[1] * shape[1]);
  constexpr double kFarthest = 1e9;  // metres
  if (!(std::max({shape[0], shape[1], std::abs(corner)}) <= kFarthest)) {
    context.report(ground.place, "the ground is too large to compute with");
    return;
  }
  if (shape != shape_) {
    const Mesh mesh = ground_surface(shape[0], shape[1], shape[2]);
    if (const Status seen = check_mesh(mesh, "the ground"); !seen) {
      context.report(ground.place, seen.error().message);
      return;
    }
    buffer_ = std::make_shared<const std::string>(mesh_buffer(mesh));
    sha256_ = sha256_hex(*buffer_);
    shape_ = shape;
  }
  draft.ground_curvature_per_m = shape[2];
  draft.ground_buffer = buffer_;
  PlacedInstance instance;
  instance.spec.name = "ground";
  instance.spec.mesh = sha256_;
  instance.spec.materials = {materials.add(ground.materials, draft.spec, context)};
  draft.placed.push_back(std::move(instance));
}

}  // namespace seedframe
