#include "annotate/labels.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "annotate/extents.h"

namespace seedframe {
namespace {

constexpr int kVersion = 1;
constexpr int kLargestId = std::numeric_limits<std::uint16_t>::max();

/// The integer in [least, most] that a value is, if it is one. A boolean or a fraction is none.
std::optional<std::int64_t> integer_in(const Json& value, std::int64_t least, std::int64_t most) {
  if (!value.is_number_integer()) return std::nullopt;
  if (value.is_number_unsigned() &&
      value.get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()}) {
    return std::nullopt;
  }
  const auto number = value.get<std::int64_t>();
  if (number < least || number > most) return std::nullopt;
  return number;
}

Result<std::int64_t> integer_field(const Json& object, const char* key, std::int64_t least,
                                   std::int64_t most, const std::string& what) {
  const auto found = object.find(key);
  if (found == object.end()) {
    return fail(ErrorKind::kCorrupt, "{}: key '{}' is missing", what, key);
  }
  const auto number = integer_in(*found, least, most);
  if (!number) {
    return fail(ErrorKind::kCorrupt, "{}: key '{}' must be an integer in {}..{}, found {}", what,
                key, least, most, found->dump());
  }
  return *number;
}

Result<PixelBox> box_field(const Json& object, const std::string& what) {
  const auto found = object.find("box");
  PixelBox box;
  const std::array<int*, 4> numbers = {&box.x, &box.y, &box.width, &box.height};
  bool valid = found != object.end() && found->is_array() && found->size() == numbers.size();
  for (std::size_t i = 0; valid && i < numbers.size(); ++i) {
    const auto number = integer_in((*found)[i], 0, std::numeric_limits<int>::max());
    valid = number.has_value();
    if (valid) *numbers[i] = static_cast<int>(*number);
  }
  if (!valid) {
    return fail(ErrorKind::kCorrupt,
                "{}: key 'box' must be four numbers of pixels, [x, y, width, height]", what);
  }
  return box;
}

/// The area and the box of one instance must be possible together, and inside the image.
Status check_extent(const InstanceLabel& label, const FrameLabels& frame, const std::string& what) {
  const PixelBox& box = label.box;
  if (label.area_px == 0) {
    if (box == PixelBox{}) return {};
    return fail(ErrorKind::kCorrupt, "{}: no visible pixels, but a box that is not all 0", what);
  }
  // Subtractions, since a sum of two arbitrary integers may overflow.
  if (box.width < 1 || box.height < 1 || box.width > frame.width - box.x ||
      box.height > frame.height - box.y) {
    return fail(ErrorKind::kCorrupt, "{}: the box [{}, {}, {}, {}] is not inside the {}x{} image",
                what, box.x, box.y, box.width, box.height, frame.width, frame.height);
  }
  if (label.area_px > std::int64_t{box.width} * box.height) {
    return fail(ErrorKind::kCorrupt, "{}: {} visible pixels do not fit into a box of {}x{}", what,
                label.area_px, box.width, box.height);
  }
  return {};
}

Result<InstanceLabel> instance_from_json(const Json& json, const FrameLabels& frame,
                                         const std::string& what) {
  if (!json.is_object()) {
    return fail(ErrorKind::kCorrupt, "{} must be an object, found {}", what, json.type_name());
  }
  const auto id = integer_field(json, "id", 1, kLargestId, what);
  if (!id) return forward_error(id);
  const auto category = integer_field(json, "category", 0, std::numeric_limits<int>::max(), what);
  if (!category) return forward_error(category);
  const auto area =
      integer_field(json, "area_px", 0, std::numeric_limits<std::int64_t>::max(), what);
  if (!area) return forward_error(area);
  const auto name = json_field<std::string>(json, "name", what);
  if (!name) return forward_error(name);
  const auto box = box_field(json, what);
  if (!box) return forward_error(box);
  InstanceLabel label{.id = static_cast<int>(*id),
                      .category = static_cast<int>(*category),
                      .name = *name,
                      .area_px = *area,
                      .box = *box};
  if (Status possible = check_extent(label, frame, what); !possible) return forward_error(possible);
  return label;
}

Status check_version(const Json& json, const std::string& what) {
  const auto version = integer_field(json, "version", 1, std::numeric_limits<int>::max(), what);
  if (!version) return forward_error(version);
  if (*version != kVersion) {
    return fail(ErrorKind::kCorrupt,
                "{} holds labels of version {}; this program reads version {}: use the Seedframe "
                "that wrote it, or a newer one",
                what, *version, kVersion);
  }
  return {};
}

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

Result<FrameLabels> make_labels(const FrameSpec& spec, const Image<std::uint16_t>& instance_ids) {
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
  FrameLabels labels{.width = instance_ids.width, .height = instance_ids.height, .instances = {}};
  for (std::size_t i = 0; i < spec.instances.size(); ++i) {
    const InstanceSpec& instance = spec.instances[i];
    if (instance.id == 0) continue;
    InstanceLabel label{
        .id = instance.id, .category = instance.category, .name = instance.name, .box = {}};
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
  std::vector<std::uint8_t> category_of_id(kLargestId + std::size_t{1}, 0);
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

Json to_json(const FrameLabels& labels) {
  Json instances = Json::array();
  for (const InstanceLabel& label : labels.instances) {
    const PixelBox& box = label.box;
    instances.push_back({{"id", label.id},
                         {"category", label.category},
                         {"name", label.name},
                         {"area_px", label.area_px},
                         {"box", {box.x, box.y, box.width, box.height}}});
  }
  return {{"version", kVersion},
          {"width", labels.width},
          {"height", labels.height},
          {"instances", std::move(instances)}};
}

Result<FrameLabels> labels_from_json(const Json& json, const std::string& what) {
  if (!json.is_object()) {
    return fail(ErrorKind::kCorrupt, "{} must hold an object, found {}", what, json.type_name());
  }
  if (Status known = check_version(json, what); !known) return forward_error(known);
  constexpr int kLargestSide = 1 << 20;
  const auto width = integer_field(json, "width", 1, kLargestSide, what);
  if (!width) return forward_error(width);
  const auto height = integer_field(json, "height", 1, kLargestSide, what);
  if (!height) return forward_error(height);
  const auto instances = json.find("instances");
  if (instances == json.end() || !instances->is_array()) {
    return fail(ErrorKind::kCorrupt, "{}: key 'instances' must be an array", what);
  }
  FrameLabels labels{
      .width = static_cast<int>(*width), .height = static_cast<int>(*height), .instances = {}};
  std::unordered_set<int> ids;
  for (const Json& item : *instances) {
    const std::string where = fmt::format("{}: instances[{}]", what, labels.instances.size());
    auto label = instance_from_json(item, labels, where);
    if (!label) return forward_error(label);
    if (!ids.insert(label->id).second) {
      return fail(ErrorKind::kCorrupt, "{}: the id {} appears twice", where, label->id);
    }
    labels.instances.push_back(std::move(*label));
  }
  return labels;
}

}  // namespace seedframe
