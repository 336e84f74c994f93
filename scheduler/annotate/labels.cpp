#include "annotate/labels.h"

#include <algorithm>
#include <cassert>
#include <unordered_map>

#include "annotate/extents.h"

namespace seedframe {
namespace {

/// Position in spec.instances by id, or the error that two instances share one.
Result<std::unordered_map<int, std::size_t>> positions_by_id(const FrameSpec& spec) {
  std::unordered_map<int, std::size_t> positions;
  for (std::size_t i = 0; i < spec.instances.size(); ++i) {
    const InstanceSpec& instance = spec.instances[i];
    if (instance.id == 0) continue;
    const auto [entry, added] = positions.emplace(instance.id, i);
    if (!added) {
      return fail(ErrorKind::kCorrupt,
                  "the frame spec gives the id {} to both '{}' and '{}'; ids must be unique",
                  instance.id, spec.instances[entry->second].name, instance.name);
    }
  }
  return positions;
}

}  // namespace

Result<FrameLabels> make_labels(const FrameSpec& spec, const std::vector<std::string>& categories,
                                const Image<std::uint16_t>& instance_ids) {
  if (instance_ids.width != spec.render.width || instance_ids.height != spec.render.height) {
    return fail(ErrorKind::kRender, "the index pass is {}x{} pixels, the frame spec asks for {}x{}",
                instance_ids.width, instance_ids.height, spec.render.width, spec.render.height);
  }
  const auto positions = positions_by_id(spec);
  if (!positions) return forward_error(positions);
  std::vector<const InstanceExtent*> extents(spec.instances.size(), nullptr);
  const std::vector<InstanceExtent> measured = measure_extents(instance_ids);
  for (const InstanceExtent& extent : measured) {
    const auto position = positions->find(extent.id);
    if (position == positions->end()) {
      return fail(ErrorKind::kRender,
                  "the index pass holds the id {}, first at row {}, column {}, but the frame spec "
                  "has no such instance",
                  extent.id, extent.first_row, extent.first_column);
    }
    extents[position->second] = &extent;
  }
  FrameLabels labels{.width = instance_ids.width,
                     .height = instance_ids.height,
                     .categories = categories,
                     .focal_px = spec.camera.focal_px,
                     .center_px = spec.camera.center_px,
                     .twin_exact = spec.labels.twin_exact,
                     .target = spec.labels.target,
                     .instances = {}};
  for (std::size_t i = 0; i < spec.instances.size(); ++i) {
    const InstanceSpec& instance = spec.instances[i];
    if (instance.id == 0) continue;
    InstanceLabel label;
    label.id = instance.id;
    label.category = instance.category;
    label.name = instance.name;
    label.asset = instance.asset;
    if (extents[i] != nullptr) {
      label.area_px = extents[i]->area_px;
      label.box = extents[i]->box;
    }
    labels.instances.push_back(std::move(label));
  }
  return labels;
}

Image<std::uint8_t> semantic_image(const FrameSpec& spec,
                                   const Image<std::uint16_t>& instance_ids) {
  std::vector<std::uint8_t> category_of_id(kLargestImageId + std::size_t{1}, 0);
  for (const InstanceSpec& instance : spec.instances) {
    if (instance.id == 0) continue;
    assert(instance.category >= 0 && instance.category <= 255);
    category_of_id[static_cast<std::size_t>(instance.id)] =
        static_cast<std::uint8_t>(instance.category);
  }
  Image<std::uint8_t> semantic(instance_ids.width, instance_ids.height);
  std::transform(instance_ids.values.begin(), instance_ids.values.end(), semantic.values.begin(),
                 [&category_of_id](std::uint16_t id) { return category_of_id[id]; });
  return semantic;
}

double InstanceLabel::visible_fraction() const {
  if (!amodal || amodal->area_px == 0) return 0.0;
  return static_cast<double>(area_px) / static_cast<double>(amodal->area_px);
}

double InstanceLabel::truncation() const {
  if (!amodal || amodal->area_px == 0) return 0.0;
  return 1.0 - static_cast<double>(amodal->in_image_px) / static_cast<double>(amodal->area_px);
}

}  // namespace seedframe
