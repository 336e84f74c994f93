// Whether a frame meets the constraints of its config.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/last_made.h"
#include "mesh/collision.h"
#include "rays/ray_scene.h"
#include "scene/compiled_config.h"
#include "scene/expanded_frame.h"
#include "scene/frame_draft.h"

namespace seedframe {

/// Safe to use from several threads.
class ConstraintChecker {
 public:
  explicit ConstraintChecker(const std::vector<CompiledConstraint>& constraints);

  /// The first constraint that the frame does not meet, or none. The draft's spec has its camera,
  /// and its instances are relative to it. `tallies` has an entry for each constraint.
  const CompiledConstraint* first_unmet(const FrameDraft& draft, EvaluationContext& context,
                                        std::vector<ConstraintTally>& tallies);

  /// Indices of the placed instances with a category that show at least this share of their
  /// silhouette inside the image.
  std::vector<std::size_t> seen(const FrameDraft& draft, double least_share);

 private:
  /// A draft's rays, made when the first constraint asks for them.
  using DraftRays = std::unique_ptr<RayScene>;

  bool is_met(const CompiledConstraint& constraint, const FrameDraft& draft, DraftRays& rays,
              EvaluationContext& context);
  bool all_apart(const std::vector<const PlacedInstance*>& instances, double gap_m);
  const RayScene& rays_of(const FrameDraft& draft, DraftRays& rays);
  std::shared_ptr<const RayMesh> ray_mesh(const PlacedInstance& instance);
  std::shared_ptr<const RayMesh> ground_mesh(const PlacedInstance& ground);
  const SolidMesh& solid_mesh(const Asset& asset);

  const std::vector<CompiledConstraint>& constraints_;
  std::vector<std::size_t> cheapest_first_;
  LastMade<std::string, RayMesh> ground_mesh_;  ///< by SHA-256
  std::mutex mutex_;                            ///< guards what follows, and its making
  std::map<std::string, std::shared_ptr<const RayMesh>> ray_meshes_;  ///< by the mesh's SHA-256
  std::map<std::string, std::unique_ptr<const SolidMesh>> solid_meshes_;
};

}  // namespace seedframe
