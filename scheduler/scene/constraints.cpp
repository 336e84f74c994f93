#include "scene/constraints.h"

#include <algorithm>
#include <numeric>

#include "mesh/mesh_buffer.h"
#include "scene/view_window.h"

namespace seedframe {
namespace {

constexpr std::size_t kRaysForShares = 4096;

int price(ConstraintKind kind) {
  switch (kind) {
    case ConstraintKind::kDistance:
      return 0;
    case ConstraintKind::kInView:
      return 1;
    case ConstraintKind::kVisible:
      return 2;
    case ConstraintKind::kPixels:
      return 3;
    case ConstraintKind::kApart:
      return 4;
  }
  return 5;
}

std::vector<std::size_t> selected(const CompiledConstraint& constraint, const FrameDraft& draft) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < draft.placed.size(); ++i) {
    const PlacedInstance& instance = draft.placed[i];
    const bool wanted = constraint.sections.empty() ||
                        std::binary_search(constraint.sections.begin(), constraint.sections.end(),
                                           instance.section);
    if (instance.spec.id != 0 && wanted) indices.push_back(i);
  }
  return indices;
}

bool all_distant(const std::vector<const PlacedInstance*>& instances, double least_m) {
  for (std::size_t i = 0; i < instances.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((instances[i]->centre - instances[j]->centre).norm() < least_m) return false;
    }
  }
  return true;
}

}  // namespace

ConstraintChecker::ConstraintChecker(const std::vector<CompiledConstraint>& constraints)
    : constraints_(constraints), cheapest_first_(constraints.size()) {
  std::iota(cheapest_first_.begin(), cheapest_first_.end(), std::size_t{0});
  std::stable_sort(cheapest_first_.begin(), cheapest_first_.end(),
                   [&](std::size_t a, std::size_t b) {
                     return price(constraints[a].kind) < price(constraints[b].kind);
                   });
}

const CompiledConstraint* ConstraintChecker::first_unmet(const FrameDraft& draft,
                                                         EvaluationContext& context,
                                                         std::vector<ConstraintTally>& tallies) {
  DraftRays rays;
  for (const std::size_t i : cheapest_first_) {
    ++tallies[i].checked;
    if (!is_met(constraints_[i], draft, rays, context)) return &constraints_[i];
    ++tallies[i].met;
  }
  return nullptr;
}

std::vector<std::size_t> ConstraintChecker::seen(const FrameDraft& draft, double least_share) {
  DraftRays rays;
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < draft.placed.size(); ++i) {
    if (draft.placed[i].spec.category == 0) continue;
    const PixelCounts counts = rays_of(draft, rays).count(i, kRaysForShares);
    if (counts.visible > 0.0 && counts.visible >= least_share * counts.whole) seen.push_back(i);
  }
  return seen;
}

bool ConstraintChecker::is_met(const CompiledConstraint& constraint, const FrameDraft& draft,
                               DraftRays& rays, EvaluationContext& context) {
  const double least = constraint.at_least.evaluate(context);
  const std::vector<std::size_t> indices = selected(constraint, draft);
  std::vector<const PlacedInstance*> instances;
  instances.reserve(indices.size());
  for (const std::size_t i : indices) instances.push_back(&draft.placed[i]);
  switch (constraint.kind) {
    case ConstraintKind::kDistance:
      return all_distant(instances, least);
    case ConstraintKind::kApart:
      return all_apart(instances, least);
    case ConstraintKind::kPixels: {
      const auto pixels = static_cast<std::size_t>(draft.spec.render.width) *
                          static_cast<std::size_t>(draft.spec.render.height);
      return std::all_of(indices.begin(), indices.end(), [&](std::size_t i) {
        return rays_of(draft, rays).count(i, 9 * pixels).visible >= least;
      });
    }
    case ConstraintKind::kVisible:
    case ConstraintKind::kInView:
      return std::all_of(indices.begin(), indices.end(), [&](std::size_t i) {
        const PixelCounts counts = rays_of(draft, rays).count(i, kRaysForShares);
        const bool view = constraint.kind == ConstraintKind::kInView;
        const double part = view ? counts.in_image : counts.visible;
        const double whole = view ? counts.whole : counts.in_image;
        return whole > 0.0 ? part >= least * whole : least <= 0.0;
      });
  }
  return true;
}

bool ConstraintChecker::all_apart(const std::vector<const PlacedInstance*>& instances,
                                  double gap_m) {
  std::vector<SolidInstance> solids;
  solids.reserve(instances.size());
  for (const PlacedInstance* instance : instances) {
    solids.push_back(
        {&solid_mesh(*instance->asset), instance->asset->box, instance->world_from_object});
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (nearer_than(solids[i], solids[j], gap_m)) return false;
    }
  }
  return true;
}

const RayScene& ConstraintChecker::rays_of(const FrameDraft& draft, DraftRays& rays) {
  if (rays) return *rays;
  std::vector<RayInstance> instances;
  for (const PlacedInstance& placed : draft.placed) {
    RayInstance instance;
    instance.mesh = placed.asset ? ray_mesh(placed) : ground_mesh(placed);
    instance.camera_from_object = placed.spec.camera_from_object;
    instance.seen = !placed.spec.hidden_from.camera;
    instances.push_back(std::move(instance));
  }
  rays = std::make_unique<RayScene>(pixel_camera_of(draft), std::move(instances));
  return *rays;
}

std::shared_ptr<const RayMesh> ConstraintChecker::ray_mesh(const PlacedInstance& instance) {
  const std::lock_guard lock(mutex_);
  auto& mesh = ray_meshes_[instance.spec.mesh];
  if (!mesh) mesh = std::make_shared<const RayMesh>(instance.asset->mesh);
  return mesh;
}

std::shared_ptr<const RayMesh> ConstraintChecker::ground_mesh(const PlacedInstance& ground) {
  std::shared_ptr<const RayMesh> made = ground_mesh_.find(ground.spec.mesh);
  if (made != nullptr) return made;
  const Result<Mesh> mesh = mesh_from_buffer(*ground.buffer, "ground");
  made = std::make_shared<const RayMesh>(mesh.value_or(Mesh{}));
  ground_mesh_.keep(ground.spec.mesh, made);
  return made;
}

const SolidMesh& ConstraintChecker::solid_mesh(const Asset& asset) {
  const std::lock_guard lock(mutex_);
  auto& mesh = solid_meshes_[asset.buffer_sha256];
  if (!mesh) mesh = std::make_unique<const SolidMesh>(asset.mesh);
  return *mesh;
}

}  // namespace seedframe
