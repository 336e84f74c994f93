#include "cli/asset_keypoints.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "assets/asset_files.h"
#include "assets/asset_library.h"
#include "base/nearest_name.h"
#include "console/exit_code.h"

namespace seedframe {
namespace {

Result<Keypoint> parse_point(const std::string& text) {
  const std::size_t equals = text.find('=');
  Keypoint point;
  point.name = text.substr(0, equals);
  const char* next = equals == std::string::npos ? "" : text.c_str() + equals + 1;
  bool whole = is_asset_name(point.name);
  for (int axis = 0; whole && axis < 3; ++axis) {
    char* end = nullptr;
    point.point_m(axis) = std::strtod(next, &end);
    whole = end != next && *end == (axis < 2 ? ',' : '\0');
    next = end + 1;
  }
  if (!whole) {
    return fail(ErrorKind::kInput,
                "'{}' is not a keypoint: expected NAME=X,Y,Z in metres, such as tip=0,0,-0.02, the "
                "name of letters, digits and '_'",
                text);
  }
  return point;
}

Result<std::array<std::string, 2>> parse_pair(const std::string& text) {
  const std::size_t dash = text.find('-');
  if (dash != std::string::npos) return std::array{text.substr(0, dash), text.substr(dash + 1)};
  return fail(ErrorKind::kInput, "'{}' is not a pair: expected two keypoints, such as head-tip",
              text);
}

Result<KeypointSet> parse(const KeypointArguments& arguments) {
  KeypointSet keypoints;
  std::vector<std::string> names;
  for (const std::string& text : arguments.points) {
    auto point = parse_point(text);
    if (!point) return forward_error(point);
    names.push_back(point->name);
    keypoints.points.push_back(std::move(*point));
  }
  for (const std::string& name : arguments.inside) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      return fail(ErrorKind::kInput, "--inside {}: there is no such keypoint{}", name,
                  did_you_mean(name, names));
    }
    keypoints.points[static_cast<std::size_t>(found - names.begin())].inside = true;
  }
  for (const std::string& text : arguments.lines) {
    auto pair = parse_pair(text);
    if (!pair) return forward_error(pair);
    keypoints.skeleton.push_back(std::move(*pair));
  }
  for (const std::string& text : arguments.mirrored) {
    auto pair = parse_pair(text);
    if (!pair) return forward_error(pair);
    keypoints.mirrored.push_back(std::move(*pair));
  }
  return keypoints;
}

void print(const Asset& asset) {
  say("{}: {} keypoints\n", asset.name, asset.keypoints.points.size());
  for (const Keypoint& point : asset.keypoints.points) {
    const Eigen::Vector3d& at = point.point_m;
    say("  {} at {:.6g} {:.6g} {:.6g} m{}\n", point.name, at.x(), at.y(), at.z(),
        point.inside ? ", inside" : "");
  }
  for (const auto& [from, to] : asset.keypoints.skeleton) say("  line {}-{}\n", from, to);
  for (const auto& [left, right] : asset.keypoints.mirrored) {
    say("  mirror {}-{}\n", left, right);
  }
}

}  // namespace

int asset_keypoints(const std::filesystem::path& library_root, const KeypointArguments& arguments) {
  const auto library = AssetLibrary::open({library_root});
  if (!library) return report(library.error());
  const auto folder = library->folder(arguments.asset);
  if (!folder) return report(folder.error());
  const auto keypoints = parse(arguments);
  if (!keypoints) return report(keypoints.error());
  if (arguments.clear || !keypoints->points.empty()) {
    if (Status set = set_keypoints(*folder, *keypoints); !set) return report(set.error());
  } else if (!keypoints->skeleton.empty() || !keypoints->mirrored.empty()) {
    return report({ErrorKind::kInput,
                   "--line and --mirror join keypoints: give all of them again, "
                   "as NAME=X,Y,Z"});
  }
  const auto asset = read_asset(*folder);
  if (!asset) return report(asset.error());
  print(*asset);
  return kExitOk;
}

}  // namespace seedframe
