// Whether a frame is as its config wants it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mesh/collision.h"
#include "rays/ray_scene.h"
#include "scene/compiled_config.h"
#include "scene/frame_draft.h"

namespace seedframe {

/// How often a constraint was looked at, and how often it held.
struct ConstraintTally {
  std::string name;
  std::int64_t checked = 0;
  std::int64_t met = 0;
};

class ConstraintChecker {
 public:
  explicit ConstraintChecker(const std::vector<CompiledConstraint>& constraints);

  /// The first constraint that the frame does not meet, or none. The draft's spec has its camera,
  /// and its instances are relative to it.
  const CompiledConstraint* first_unmet(const FrameDraft& draft, EvaluationContext& context);

  const std::vector<ConstraintTally>& tallies() const { return tallies_; }

 private:
  bool is_met(const CompiledConstraint& constraint, const FrameDraft& draft,
              EvaluationContext& context);
  bool all_apart(const std::vector<const PlacedInstance*>& instances, double gap_m);
  RayScene& rays(const FrameDraft& draft);
  std::shared_ptr<const RayMesh> ray_mesh(const PlacedInstance& instance);
  std::shared_ptr<const RayMesh> ground_mesh(const FrameDraft& draft, const std::string& sha256);
  const SolidMesh& solid_mesh(const Asset& asset);

  const std::vector<CompiledConstraint>& constraints_;
  std::vector<std::size_t> cheapest_first_;
  std::vector<ConstraintTally> tallies_;
  std::unique_ptr<RayScene> rays_;                                    ///< of the present frame
  std::map<std::string, std::shared_ptr<const RayMesh>> ray_meshes_;  ///< by the mesh's SHA-256
  std::map<std::string, std::unique_ptr<SolidMesh>> solid_meshes_;
  std::string ground_sha256_;  ///< of the last frame's ground, which is often that of the next
  std::shared_ptr<const RayMesh> ground_mesh_;
};

}  // namespace seedframe
