#include "scene/object_placer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/ranges.h>

#include "base/nearest_name.h"
#include "base/portable_math.h"
#include "rays/heap.h"
#include "scene/grid.h"
#include "scene/level_choice.h"

namespace seedframe {
namespace {

constexpr std::uint32_t kPlacementAttempts = 1000;
static_assert(kPlacementAttempts <= kMostAttemptsOfLayout);
constexpr std::uint32_t kMostCopiesInGroup = 1024;

/// Draws a free place for a circle; x and y of `position` become its middle.
void scatter(const CompiledScatter& scatter, double radius,
             const std::vector<Footprint>& footprints, Eigen::Vector3d& position,
             EvaluationContext& context) {
  const double gap = not_negative(scatter.gap_m, "gap_m", context);
  const std::array<double, 2> x = {scatter.x[0].evaluate(context), scatter.x[1].evaluate(context)};
  const std::array<double, 2> y = {scatter.y[0].evaluate(context), scatter.y[1].evaluate(context)};
  if (x[0] > x[1] || y[0] > y[1]) {
    context.report(scatter.place, "x and y want [least, most] with least <= most");
    return;
  }
  const std::uint32_t first = scatter.level == Level::kFrame ? 0 : first_attempt_of(context.layout);
  context.placement_attempt = first;
  auto* const record = std::exchange(context.record, nullptr);  // rejected draws would confuse
  const auto draw = [&] {
    position.x() = x[0] + (x[1] - x[0]) * scatter.x_draw.evaluate(context);
    position.y() = y[0] + (y[1] - y[0]) * scatter.y_draw.evaluate(context);
  };
  bool found = false;
  while (!found && context.placement_attempt - first < kPlacementAttempts) {
    draw();
    found = scatter.pile || is_clear({position.x(), position.y(), radius}, footprints, gap);
    if (!found) ++context.placement_attempt;
  }
  context.record = record;
  if (found && record != nullptr) draw();
  context.placement_attempt = 0;
  if (!found) {
    if (!context.error) context.crowded = scatter.level;
    context.report(scatter.place,
                   fmt::format("no free place was found in {} attempts, nor with all places drawn "
                               "anew: enlarge x and y, or lower count, scale or gap_m",
                               kPlacementAttempts));
  }
}

/// The number of a copy for its draws: unlike that of any other copy in the frame.
std::uint32_t copy_for_draws(std::uint32_t parent, std::uint32_t copy, const Place& place,
                             EvaluationContext& context) {
  if (parent == kNoIndex) return copy;
  if (parent >= kNoIndex / kMostCopiesInGroup || copy >= kMostCopiesInGroup) {
    context.report(place, fmt::format("a group may hold {} copies of an object, and groups in "
                                      "groups fewer than {} in all",
                                      kMostCopiesInGroup, kNoIndex / kMostCopiesInGroup));
    return 0;
  }
  return parent * kMostCopiesInGroup + copy;
}

Eigen::Matrix3d rotation_of(const CompiledObject& object, EvaluationContext& context) {
  if (object.random_rotation) {
    const auto& uniform = *object.random_rotation;
    return rotation_of_quaternion(
        random_quaternion({uniform[0].evaluate(context), uniform[1].evaluate(context),
                           uniform[2].evaluate(context)}));
  }
  if (!object.quaternion) {
    return rotation_and_scale(object.rotation_deg.evaluate(context), Eigen::Vector3d::Ones());
  }
  std::array<double, 4> wxyz{};
  double length = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    wxyz[i] = (*object.quaternion)[i].evaluate(context);
    length = std::hypot(length, wxyz[i]);
  }
  constexpr double kLeast = 1e-6, kMost = 1e6;
  if (!(length >= kLeast && length <= kMost)) {
    context.report(object.place, fmt::format("a quaternion needs a length above 0, found [{}]",
                                             fmt::join(wxyz, ", ")));
    return Eigen::Matrix3d::Identity();
  }
  return rotation_of_quaternion(wxyz);
}

/// Empty: none.
std::string category_of(const CompiledObject& object, const Asset& asset,
                        EvaluationContext& context) {
  if (object.category) return object.category->evaluate(context);
  if (object.category_of_asset.empty()) return asset.category;
  const auto found = object.category_of_asset.find(asset.name);
  if (found != object.category_of_asset.end()) return found->second.name;
  context.report(object.place, "category says nothing of the asset '" + asset.name + "'");
  return {};
}

/// Numbers within which neither a pose nor its inverse leaves what doubles can hold, squared.
bool is_computable(const Affine& pose) {
  constexpr double kLargest = 1e12;          // metres
  constexpr double kSmallestVolume = 1e-36;  // m³ of a cubic metre
  return pose.matrix().cwiseAbs().maxCoeff() <= kLargest &&
         std::abs(pose.linear().determinant()) >= kSmallestVolume;
}

}  // namespace

void ObjectPlacer::check_names(const CompiledObject& object, Diagnostics& errors) const {
  for (const CompiledObject& child : object.objects) check_names(child, errors);
  if (!object.asset) return;
  const auto names = object.asset->possible_values();
  std::vector<std::string> slots;
  for (const std::string& name : names.value_or(std::vector<std::string>())) {
    const auto asset = assets_.load(name);
    if (!asset) {
      errors.add(object.asset->place(), asset.error().message);
    } else {
      slots.insert(slots.end(), (*asset)->mesh.slot_names.begin(), (*asset)->mesh.slot_names.end());
    }
  }
  for (const auto& entry : object.slots) {
    if (!names || std::find(slots.begin(), slots.end(), entry.first) != slots.end()) continue;
    errors.add(entry.second.place, "no asset of '" + object.name + "' has a material slot '" +
                                       entry.first + "'" + did_you_mean(entry.first, slots));
  }
  check_categories(object, names, errors);
}

void ObjectPlacer::check_categories(const CompiledObject& object,
                                    const std::optional<std::vector<std::string>>& assets,
                                    Diagnostics& errors) const {
  const auto check = [&](const std::string& name, const Place& place) {
    const bool known = name == "none" ||
                       std::find(categories_.begin(), categories_.end(), name) != categories_.end();
    if (known) return;
    errors.add(place, "'" + name + "' is not among the campaign's categories" +
                          did_you_mean(name, categories_));
  };
  if (object.category) {
    for (const std::string& name :
         object.category->possible_values().value_or(std::vector<std::string>())) {
      check(name, object.category->place());
    }
  }
  for (const auto& [asset, category] : object.category_of_asset) {
    check(category.name, category.place);
    if (assets && std::find(assets->begin(), assets->end(), asset) == assets->end()) {
      errors.add(category.place,
                 "the object's asset is never '" + asset + "'" + did_you_mean(asset, *assets));
    }
  }
  if (object.category_of_asset.empty() || !assets) return;
  for (const std::string& asset : *assets) {
    if (object.category_of_asset.contains(asset)) continue;
    errors.add(object.place, "category says nothing of the asset '" + asset + "'");
  }
}

void ObjectPlacer::place_all(const CompiledConfig& config, const MaterialPicker& materials,
                             FrameDraft& draft, EvaluationContext& context) const {
  draft.sections.assign(config.sections, {});
  Pass pass{config.built_in, materials, draft, context};
  Parent world;
  for (const CompiledObject& object : config.objects) {
    place(object, world, pass);
    if (context.error) break;
  }
  context.copy = kNoIndex;
  if (!pass.falling.empty() && !context.error) pile(pass);
}

void ObjectPlacer::pile(Pass& pass) {
  std::vector<Heaped> heap;
  for (const PlacedInstance& each : pass.draft.placed) {
    const auto& asset = each.asset;  // none: the ground, which everything rests on already
    heap.push_back({asset ? &asset->mesh : nullptr, each.world_from_object, {}, asset});
  }
  for (const Falling& each : pass.falling) heap[each.placed].falls = each.order;
  const std::vector<double> raised = heaped_up(heap);
  for (const Falling& each : pass.falling) {
    PlacedInstance& instance = pass.draft.placed[each.placed];
    instance.world_from_object.translation().z() += raised[each.placed];
    instance.centre.z() += raised[each.placed];
    if (!each.is_first) continue;
    pass.draft.sections[instance.section].world_from_first.translation().z() += raised[each.placed];
  }
}

void ObjectPlacer::place(const CompiledObject& object, Parent& parent, Pass& pass) const {
  EvaluationContext& context = pass.context;
  context.copy = parent.copy;
  const auto most = static_cast<std::uint32_t>(kLargestInstanceId);
  const Grid grid = object.grid ? evaluate_grid(*object.grid, most, context) : Grid();
  const std::uint32_t copies = object.grid ? grid.size() : copies_of(object.count, most, context);
  // Of a copy of a group, for what comes after this object in it.
  std::vector<double>& values = context.values.numbers;
  const double copies_of_parent = values[pass.built_in.copies];
  const double index_of_parent = values[pass.built_in.copy_index];
  for (std::uint32_t copy = 0; copy < copies && !context.error; ++copy) {
    context.copy = copy_for_draws(parent.copy, copy, object.place, context);
    context.ordinal = pass.draft.sections[object.section].copies;
    values[pass.built_in.copies] = copies;
    values[pass.built_in.copy_index] = copy;
    place_copy(object, grid.offset(copy), fmt::format("{}{}/{}", parent.name, object.name, copy),
               parent, pass);
  }
  values[pass.built_in.copies] = copies_of_parent;
  values[pass.built_in.copy_index] = index_of_parent;
}

void ObjectPlacer::place_copy(const CompiledObject& object, const Eigen::Vector3d& offset,
                              const std::string& name, Parent& parent, Pass& pass) const {
  EvaluationContext& context = pass.context;
  object.variables.evaluate(context);
  std::shared_ptr<const Asset> asset;
  if (object.asset) {
    asset = load_asset(object.asset->evaluate(context), object.asset->place(), pass);
    if (!asset) return;
  }
  Eigen::Matrix3d rotation = rotation_of(object, context);
  const Eigen::Vector3d scale = object.scale.evaluate(context);
  if (scale.minCoeff() <= 0.0) {
    context.report(object.scale.place(),
                   fmt::format("scale must be above 0, found {}", scale.minCoeff()));
    return;
  }
  if (object.stable_face) rotation *= stand(object, *asset, scale, context);
  const Eigen::Matrix3d linear = rotation * scale.asDiagonal();
  Eigen::Vector3d position = object.position.evaluate(context) + offset;
  const double radius = asset ? footprint_radius(asset->box.low, asset->box.high, linear) : 0.0;
  if (object.scatter) scatter(*object.scatter, radius, parent.footprints, position, context);
  if (asset) parent.footprints.push_back({position.x(), position.y(), radius});
  Affine parent_from_object = Affine::Identity();
  parent_from_object.linear() = linear;
  parent_from_object.translation() = position;
  Affine parent_from_unscaled = parent_from_object;
  parent_from_unscaled.linear() = rotation;
  if (object.rest_on_ground) {
    const double lowest = asset ? asset->lowest_z(linear) : 0.0;
    const double curvature = parent.copy == kNoIndex ? pass.draft.ground_curvature_per_m : 0.0;
    parent_from_object = resting(parent_from_object, lowest, curvature);
    parent_from_unscaled = resting(parent_from_unscaled, lowest, curvature);
  }
  const Affine world_from_object = parent.world_from_parent * parent_from_object;

  FrameDraft::Section& section = pass.draft.sections[object.section];
  if (section.copies++ == 0) {
    section.world_from_first = parent.world_from_parent * parent_from_unscaled;
  }
  if (object.scatter && object.scatter->pile) {
    const double order = object.scatter->falls.evaluate(context);
    pass.falling.push_back({pass.draft.placed.size(), order, section.copies == 1});
  }
  std::optional<DrawnMaterial> material;
  if (object.material_of_parent) material = parent.material;
  if (asset) place_instance(object, asset, {name, world_from_object}, material, pass);
  if (object.objects.empty()) return;
  if (!material && object.material_for_objects) {
    material = pass.materials.draw(object.materials, nullptr, pass.draft.used, context);
  }
  Parent group{world_from_object, context.copy, name + "/", std::move(material), {}};
  for (const CompiledObject& child : object.objects) {
    if (!context.error) place(child, group, pass);
  }
}

Eigen::Matrix3d ObjectPlacer::stand(const CompiledObject& object, const Asset& asset,
                                    const Eigen::Vector3d& scale,
                                    EvaluationContext& context) const {
  const double drawn = object.stable_face->evaluate(context);
  const auto faces = stable_poses_->of(asset, scale);
  if (!faces) {
    context.report(object.place, faces.error().message);
    return Eigen::Matrix3d::Identity();
  }
  double sum = 0.0;
  for (const StableFace& face : **faces) {
    sum += face.probability;
    if (drawn < sum) return standing_on(face);
  }
  return standing_on((*faces)->back());
}

void ObjectPlacer::place_instance(const CompiledObject& object,
                                  const std::shared_ptr<const Asset>& asset,
                                  const Placement& placement,
                                  std::optional<DrawnMaterial>& material, Pass& pass) const {
  PlacedInstance instance;
  instance.spec.name = placement.name;
  instance.spec.id = ++pass.draft.objects;
  if (instance.spec.id > kLargestInstanceId) {
    pass.context.report(object.place,
                        fmt::format("a frame can hold at most {} objects", kLargestInstanceId));
  }
  instance.spec.category = category_index(object, *asset, pass.context);
  instance.spec.asset = asset->name;
  instance.spec.keypoints = asset->keypoints.points;
  instance.spec.mesh = asset->buffer_sha256;
  // A mean of the three axes of a copy that is scaled along each; as a float, so that copies which
  // are only turned do not differ by rounding, and share their materials.
  const double volume = std::abs(placement.world_from_object.linear().determinant());
  const double scale = static_cast<float>(portable::pow(volume, 1.0 / 3.0));
  instance.spec.materials =
      slot_materials(object, *asset, asset->metres_per_uv * scale, material, pass);
  instance.spec.hidden_from = object.hidden_from;
  if (!is_computable(placement.world_from_object)) {
    pass.context.report(object.place,
                        fmt::format("'{}' is too large, too small or too far away to compute with",
                                    placement.name));
  }
  instance.world_from_object = placement.world_from_object;
  instance.centre = placement.world_from_object * asset->box.centre();
  instance.section = object.section;
  instance.asset = asset;
  instance.buffer = {asset, &asset->buffer};  // shares the asset's bytes instead of copying them
  instance.auto_detail = object.auto_detail;
  pass.draft.placed.push_back(std::move(instance));
}

void ObjectPlacer::choose_levels(FrameDraft& draft, EvaluationContext& context) const {
  for (PlacedInstance& instance : draft.placed) {
    if (!instance.auto_detail || instance.asset->levels.size() < 2) continue;
    const Asset& asset = *instance.asset;
    const std::size_t level =
        level_of_detail(asset, instance.spec.camera_from_object, draft.spec.camera);
    if (level == 0) continue;
    const auto mesh = assets_.load_level(asset.name, level);
    if (!mesh) {
      context.report(Place{}, mesh.error().message);
      return;
    }
    instance.spec.mesh = (*mesh)->buffer_sha256;
    instance.buffer = {*mesh, &(*mesh)->buffer};
  }
}

std::vector<int> ObjectPlacer::slot_materials(const CompiledObject& object, const Asset& asset,
                                              double metres_per_uv,
                                              std::optional<DrawnMaterial>& common, Pass& pass) {
  std::vector<int> materials;
  auto* const record = pass.context.record;
  for (const std::string& slot : asset.mesh.slot_names) {
    const AssetSlot of_asset{asset, slot};
    const auto special = object.slots.find(slot);
    if (special != object.slots.end()) {
      materials.push_back(
          put_on(pass.materials.draw(special->second, &of_asset, pass.draft.used, pass.context),
                 metres_per_uv, pass.draft));
      continue;
    }
    // The same draw for all slots; if it says that they have their own, each has another.
    if (!common || object.materials.can_be_own) {
      if (common) pass.context.record = nullptr;
      common = pass.materials.draw(object.materials, &of_asset, pass.draft.used, pass.context);
      pass.context.record = record;
    }
    materials.push_back(put_on(*common, metres_per_uv, pass.draft));
  }
  return materials;
}

int ObjectPlacer::category_index(const CompiledObject& object, const Asset& asset,
                                 EvaluationContext& context) const {
  const std::string name = category_of(object, asset, context);
  if (name.empty() || name == "none") return 0;
  const auto found = std::find(categories_.begin(), categories_.end(), name);
  if (found == categories_.end()) {
    context.report(object.category ? object.category->place() : object.place,
                   fmt::format("the category '{}' of asset '{}' is not among the campaign's "
                               "categories; add it there, or set category: none",
                               name, asset.name));
    return 0;
  }
  return static_cast<int>(found - categories_.begin()) + 1;
}

std::shared_ptr<const Asset> ObjectPlacer::load_asset(const std::string& name, const Place& place,
                                                      Pass& pass) const {
  auto& used = pass.draft.used.assets;
  const auto known = used.find(name);
  if (known != used.end()) return known->second;
  auto asset = assets_.load(name);
  if (!asset) {
    pass.context.report(place, asset.error().message);
    return nullptr;
  }
  return used.emplace(name, std::move(*asset)).first->second;
}

}  // namespace seedframe
