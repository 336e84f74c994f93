#include "assets/keypoints.h"

#include <set>

#include "base/message_text.h"

namespace seedframe {
namespace {

constexpr std::size_t kMostKeypoints = 1000;

Json pairs_json(const std::vector<std::array<std::string, 2>>& pairs) {
  Json list = Json::array();
  for (const auto& pair : pairs) list.push_back(pair);
  return list;
}

Status check_pairs(const std::vector<std::array<std::string, 2>>& pairs,
                   const std::set<std::string>& names, const std::string& what) {
  for (const auto& pair : pairs) {
    for (const std::string& name : pair) {
      if (names.count(name) == 0) {
        return fail(ErrorKind::kInput, "{}: '{}-{}' joins the keypoint '{}', which does not exist",
                    what, pair[0], pair[1], name);
      }
    }
    if (pair[0] == pair[1]) {
      return fail(ErrorKind::kInput, "{}: the keypoint '{}' is joined to itself", what, pair[0]);
    }
  }
  return {};
}

}  // namespace

Status check_keypoints(const KeypointSet& keypoints, const std::string& what) {
  if (keypoints.points.size() > kMostKeypoints) {
    return fail(ErrorKind::kInput, "{}: at most {} keypoints are possible, found {}", what,
                kMostKeypoints, keypoints.points.size());
  }
  std::set<std::string> names;
  for (const Keypoint& point : keypoints.points) {
    if (!is_one_line_name(point.name)) {
      return fail(ErrorKind::kInput,
                  "{}: a keypoint needs a name, of one line and at most 200 bytes, found '{}'",
                  what, shortened(point.name, 200));
    }
    if (!names.insert(point.name).second) {
      return fail(ErrorKind::kInput, "{}: two keypoints are named '{}'", what, point.name);
    }
    if (!point.point_m.allFinite()) {
      return fail(ErrorKind::kInput, "{}: the keypoint '{}' needs three finite coordinates", what,
                  point.name);
    }
  }
  if (Status joined = check_pairs(keypoints.skeleton, names, what); !joined) return joined;
  return check_pairs(keypoints.mirrored, names, what);
}

Json to_json(const KeypointSet& keypoints) {
  Json points = Json::array();
  for (const Keypoint& point : keypoints.points) {
    const Eigen::Vector3d& at = point.point_m;
    points.push_back(
        {{"name", point.name}, {"point_m", {at.x(), at.y(), at.z()}}, {"inside", point.inside}});
  }
  return {{"points", std::move(points)},
          {"skeleton", pairs_json(keypoints.skeleton)},
          {"mirrored", pairs_json(keypoints.mirrored)}};
}

Result<KeypointSet> keypoints_from_json(const Json& json, const std::string& what) {
  KeypointSet keypoints;
  try {
    for (const Json& item : json.at("points")) {
      Keypoint point;
      item.at("name").get_to(point.name);
      item.at("inside").get_to(point.inside);
      const auto at = item.at("point_m").get<std::array<double, 3>>();
      point.point_m = Eigen::Vector3d(at[0], at[1], at[2]);
      keypoints.points.push_back(std::move(point));
    }
    json.at("skeleton").get_to(keypoints.skeleton);
    json.at("mirrored").get_to(keypoints.mirrored);
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: {}", what, error.what());
  }
  if (Status possible = check_keypoints(keypoints, what); !possible) {
    return fail(ErrorKind::kCorrupt, "{}", possible.error().message);
  }
  return keypoints;
}

}  // namespace seedframe
