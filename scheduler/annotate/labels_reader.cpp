// labels.json in (docs/formats/labels.md).
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <unordered_set>

#include "annotate/labels.h"
#include "annotate/rle.h"

namespace seedframe {
namespace {

constexpr int kLargestCanvas = 3 * (1 << 20);

/// The integer in [least, most] that a value is, if it is one.
std::optional<std::int64_t> integer_between(const Json& value, std::int64_t least,
                                            std::int64_t most) {
  const auto number = integer_in<std::int64_t>(value);
  return number && *number >= least && *number <= most ? number : std::nullopt;
}

Result<std::int64_t> integer_field(const Json& object, const char* key, std::int64_t least,
                                   std::int64_t most, const std::string& what) {
  const auto found = object.find(key);
  if (found == object.end()) {
    return fail(ErrorKind::kCorrupt, "{}: key '{}' is missing", what, key);
  }
  const auto number = integer_between(*found, least, most);
  if (!number) {
    return fail(ErrorKind::kCorrupt, "{}: key '{}' must be an integer in {}..{}, found {}", what,
                key, least, most, found->dump());
  }
  return *number;
}

Result<PixelRect> box_field(const Json& object, const std::string& what) {
  const auto found = object.find("box");
  PixelRect box;
  const std::array<int*, 4> numbers = {&box.x, &box.y, &box.width, &box.height};
  bool valid = found != object.end() && found->is_array() && found->size() == numbers.size();
  for (std::size_t i = 0; valid && i < numbers.size(); ++i) {
    const auto number = integer_between((*found)[i], 0, std::numeric_limits<int>::max());
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
  const PixelRect& box = label.box;
  if (label.area_px == 0) {
    if (box == PixelRect{}) return {};
    return fail(ErrorKind::kCorrupt, "{}: no visible pixels, but a box that is not all 0", what);
  }
  // Subtractions, since a sum of two arbitrary integers may overflow.
  if (box.width < 1 || box.height < 1 || box.width > frame.width - box.x ||
      box.height > frame.height - box.y) {
    return fail(ErrorKind::kCorrupt, "{}: the box [{}, {}, {}, {}] is not inside the {}x{} image",
                what, box.x, box.y, box.width, box.height, frame.width, frame.height);
  }
  if (label.area_px > box.area()) {
    return fail(ErrorKind::kCorrupt, "{}: {} visible pixels do not fit into a box of {}x{}", what,
                label.area_px, box.width, box.height);
  }
  return {};
}

bool is_list_of(const Json& json, std::size_t numbers) {
  return json.is_array() && json.size() == numbers &&
         std::all_of(json.begin(), json.end(), [](const Json& each) { return each.is_number(); });
}

/// Throws Json::exception for what is not there or of another type.
Pose pose_from_json(const Json& json) {
  Pose pose;
  for (Eigen::Index i = 0; i < 9; ++i) {
    pose.rotation(i / 3, i % 3) = json.at("rotation").at(static_cast<std::size_t>(i)).get<double>();
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    pose.translation_m(i) = json.at("translation_m").at(at).get<double>();
    pose.scale(i) = json.at("scale").at(at).get<double>();
  }
  return pose;
}

/// The same.
void read_boxes(const Json& json, AmodalLabel& amodal) {
  const Json& object_box = json.at("object_box_m");
  for (Eigen::Index i = 0; i < 3; ++i) {
    amodal.object_box.low(i) = object_box.at(0).at(static_cast<std::size_t>(i)).get<double>();
    amodal.object_box.high(i) = object_box.at(1).at(static_cast<std::size_t>(i)).get<double>();
  }
  const Json& corners = json.at("box_corners_px");
  for (std::size_t i = 0; i < amodal.box_corners_px.size(); ++i) {
    const Json& corner = corners.at(i);
    if (corner.is_null()) continue;
    amodal.box_corners_px[i] = {corner.at(0).get<double>(), corner.at(1).get<double>()};
  }
}

/// Areas, box and mask must be possible together, and hold what is visible.
Status check_amodal(const AmodalLabel& amodal, const InstanceLabel& label,
                    const std::string& what) {
  const std::optional<Rle> rle = rle_from_string(amodal.rle, amodal.box.width, amodal.box.height);
  if (!rle || rle_area(*rle) != amodal.area_px) {
    return fail(ErrorKind::kCorrupt, "{}: the run lengths 'rle' do not give {} pixels in {}x{}",
                what, amodal.area_px, amodal.box.width, amodal.box.height);
  }
  if (amodal.in_image_px > amodal.area_px || label.area_px > amodal.in_image_px) {
    return fail(ErrorKind::kCorrupt,
                "{}: {} pixels are visible, {} are in the image and {} in all: each must hold the "
                "one before",
                what, label.area_px, amodal.in_image_px, amodal.area_px);
  }
  return {};
}

Result<AmodalLabel> amodal_from_json(const Json& json, const InstanceLabel& label,
                                     const std::string& what) {
  constexpr std::int64_t kMostPixels = std::numeric_limits<std::int64_t>::max();
  AmodalLabel amodal;
  const auto area = integer_field(json, "area_px", 0, kMostPixels, what);
  if (!area) return forward_error(area);
  const auto in_image = integer_field(json, "in_image_px", 0, kMostPixels, what);
  if (!in_image) return forward_error(in_image);
  amodal.area_px = *area;
  amodal.in_image_px = *in_image;
  const Json box = json.value("box", Json());
  if (!is_list_of(box, 4)) {
    return fail(ErrorKind::kCorrupt,
                "{}: key 'box' must be four numbers of pixels, [x, y, width, height]", what);
  }
  std::array<std::optional<std::int64_t>, 4> numbers;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = integer_between(box[i], i < 2 ? -kLargestCanvas : 0, kLargestCanvas);
    if (!numbers[i]) {
      return fail(ErrorKind::kCorrupt, "{}: key 'box' has the number {}", what, box[i].dump());
    }
  }
  amodal.box = {static_cast<int>(*numbers[0]), static_cast<int>(*numbers[1]),
                static_cast<int>(*numbers[2]), static_cast<int>(*numbers[3])};
  try {
    json.at("complete").get_to(amodal.complete);
    json.at("rle").get_to(amodal.rle);
    amodal.pose = pose_from_json(json.at("pose"));
    read_boxes(json, amodal);
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: {}", what, error.what());
  }
  if (Status possible = check_amodal(amodal, label, what); !possible) {
    return forward_error(possible);
  }
  return amodal;
}

Result<std::vector<KeypointLabel>> keypoints_from_json(const Json& json, const std::string& what) {
  std::vector<KeypointLabel> keypoints;
  try {
    for (const Json& item : json) {
      const int visibility = integer_of<int>(item.at("visibility"));
      if (visibility < 0 || visibility > 2) {
        return fail(ErrorKind::kCorrupt, "{}: a visibility must be 0, 1 or 2, found {}", what,
                    visibility);
      }
      keypoints.push_back({item.at("name").get<std::string>(),
                           item.at("px").get<std::array<double, 2>>(),
                           static_cast<Visibility>(visibility)});
    }
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: {}", what, error.what());
  }
  return keypoints;
}

Result<InstanceLabel> instance_from_json(const Json& json, const FrameLabels& frame,
                                         const std::string& what) {
  if (!json.is_object()) {
    return fail(ErrorKind::kCorrupt, "{} must be an object, found {}", what, json.type_name());
  }
  const auto id = integer_field(json, "id", 1, kLargestImageId, what);
  if (!id) return forward_error(id);
  const auto category = integer_field(json, "category", 0, std::numeric_limits<int>::max(), what);
  if (!category) return forward_error(category);
  const auto area =
      integer_field(json, "area_px", 0, std::numeric_limits<std::int64_t>::max(), what);
  if (!area) return forward_error(area);
  const auto name = json_field<std::string>(json, "name", what);
  if (!name) return forward_error(name);
  const auto asset = json_field<std::string>(json, "asset", what);
  if (!asset) return forward_error(asset);
  const auto box = box_field(json, what);
  if (!box) return forward_error(box);
  if (*category > static_cast<std::int64_t>(frame.categories.size())) {
    return fail(ErrorKind::kCorrupt, "{}: category {} of {}", what, *category,
                frame.categories.size());
  }
  InstanceLabel label{.id = static_cast<int>(*id),
                      .category = static_cast<int>(*category),
                      .name = *name,
                      .asset = *asset,
                      .area_px = *area,
                      .box = *box,
                      .amodal = {},
                      .keypoints = {}};
  if (Status possible = check_extent(label, frame, what); !possible) return forward_error(possible);
  const auto amodal = json.find("amodal");
  if (amodal != json.end()) {
    auto read = amodal_from_json(*amodal, label, what + ": amodal");
    if (!read) return forward_error(read);
    label.amodal = std::move(*read);
  }
  if (const auto keypoints = json.find("keypoints"); keypoints != json.end()) {
    auto read = keypoints_from_json(*keypoints, what + ": keypoints");
    if (!read) return forward_error(read);
    label.keypoints = std::move(*read);
  }
  return label;
}

Status check_version(const Json& json, const std::string& what) {
  const auto version = integer_field(json, "version", 1, std::numeric_limits<int>::max(), what);
  if (!version) return forward_error(version);
  if (*version != kLabelsVersion) {
    return fail(ErrorKind::kCorrupt,
                "{} holds labels of version {}; this program reads version {}: use the Seedframe "
                "that wrote it, or a newer one",
                what, *version, kLabelsVersion);
  }
  return {};
}

}  // namespace

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
  const auto twin_exact = json_field<bool>(json, "twin_exact", what);
  if (!twin_exact) return forward_error(twin_exact);
  FrameLabels labels{.width = static_cast<int>(*width),
                     .height = static_cast<int>(*height),
                     .categories = {},
                     .focal_px = {},
                     .center_px = {},
                     .twin_exact = *twin_exact,
                     .target = 0,
                     .instances = {}};
  try {
    json.at("categories").get_to(labels.categories);
    json.at("camera").at("focal_px").get_to(labels.focal_px);
    json.at("camera").at("center_px").get_to(labels.center_px);
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: {}", what, error.what());
  }
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
  if (json.contains("target")) {
    const auto target = integer_field(json, "target", 1, kLargestImageId, what);
    if (!target) return forward_error(target);
    labels.target = static_cast<int>(*target);
    if (!ids.contains(labels.target)) {
      return fail(ErrorKind::kCorrupt, "{}: no instance has the id of the target, {}", what,
                  labels.target);
    }
  }
  return labels;
}

}  // namespace seedframe
