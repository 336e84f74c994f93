#include "report/scene_survey.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "spec/scaled_view.h"
#include "twin/twin.h"

namespace seedframe {
namespace {

constexpr std::int64_t kMostFrames = 24;
constexpr int kLargestSide = 160;     // pixels
constexpr int kStep = 2;              // of pixels that are asked for coincident faces
constexpr double kSmallPx = 25.0;     // of the whole picture: 5 × 5
constexpr double kFilled = 0.95;      // of the picture, by what the camera is in
constexpr double kOutOfScale = 20.0;  // an object's least side over its distance
constexpr std::int64_t kCoincidentPx = 4;

/// As far apart as can be; and the second one, which should differ from the first.
std::vector<std::int64_t> frames_to_see(std::int64_t count) {
  std::set<std::int64_t> frames = {std::min<std::int64_t>(1, count - 1)};
  const std::int64_t wanted = std::min(count, kMostFrames - 1);
  for (std::int64_t i = 0; i < wanted; ++i) {
    frames.insert(wanted == 1 ? 0 : i * (count - 1) / (wanted - 1));
  }
  return {frames.begin(), frames.end()};
}

/// "1 frame", "24 frames".
std::string counted(std::int64_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// What an instance is a copy of: "row/1/gears/0" is of "row/gears".
std::string section_of(const std::string& instance) {
  std::string section;
  std::size_t begin = 0;
  while (begin <= instance.size()) {
    const std::size_t end = std::min(instance.find('/', begin), instance.size());
    const std::string part = instance.substr(begin, end - begin);
    const bool number = !part.empty() && std::all_of(part.begin(), part.end(), [](unsigned char c) {
      return std::isdigit(c) != 0;
    });
    if (!number) section += (section.empty() ? "" : "/") + part;
    begin = end + 1;
  }
  return section;
}

/// The same view in fewer pixels; returns how many of the whole picture each stands for.
double shrink(FrameSpec& spec) {
  const RenderSettings& render = spec.render;
  const double whole = static_cast<double>(render.width) * render.height;
  spec = scaled_view(std::move(spec), std::min(1.0, static_cast<double>(kLargestSide) /
                                                        std::max(render.width, render.height)));
  return whole / (static_cast<double>(spec.render.width) * spec.render.height);
}

std::string metres(const Eigen::Vector3d& size) {
  return fmt::format("{:.3g} × {:.3g} × {:.3g} m", size.x(), size.y(), size.z());
}

class Surveyor {
 public:
  explicit Surveyor(std::vector<std::string> categories) : categories_(std::move(categories)) {}

  Status look_at(std::int64_t frame, const ExpandedFrame& expanded);
  std::vector<std::string> warnings() const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  struct Section {
    std::int64_t frames = 0;  ///< in which it is
    bool labelled = false;
    double largest_px = 0.0;         ///< of the whole picture, of one copy
    std::int64_t frames_inside = 0;  ///< in which the camera is in a copy
    Eigen::Vector3d size =
        Eigen::Vector3d::Zero();  ///< of a copy that the camera is in or at, metres
    double too_near_m = 0.0;      ///< the distance of a copy that is out of scale; 0: none
    std::map<std::string, std::set<int>> categories_of_assets;
  };

  void look_at_instance(const FrameSpec& spec, std::size_t index, const Twin& twin,
                        std::int64_t pixels, double weight);
  void find_coincident(const FrameSpec& spec, const Twin& twin);
  void warn_of_cameras(std::vector<std::string>& warnings) const;
  void warn_of_sections(std::vector<std::string>& warnings) const;
  std::string category_name(int category) const;

  std::vector<std::string> categories_;
  TwinTracer tracer_;
  int width_ = 0, height_ = 0;
  std::int64_t frames_ = 0;
  std::int64_t frames_below_ = 0;  ///< the ground
  bool any_labelled_px_ = false;
  std::map<std::string, Section> sections_;
  std::map<std::pair<std::string, std::string>, std::int64_t> coincident_px_;
  std::map<std::string, std::int64_t> seen_specs_;  ///< but for the seed of their noise, the frame
  std::pair<std::int64_t, std::int64_t> same_frames_{-1, -1};
};

Status Surveyor::look_at(std::int64_t frame, const ExpandedFrame& expanded) {
  FrameSpec spec = expanded.spec;
  spec.render.seed = 0;
  const auto seen = seen_specs_.try_emplace(canonical_text(spec), frame);
  if (!seen.second && same_frames_.first < 0) same_frames_ = {seen.first->second, frame};
  const double weight = shrink(spec);
  width_ = spec.render.width;
  height_ = spec.render.height;
  const Result<Twin> twin = tracer_.trace(spec, expanded.meshes, TwinTracer::Passes::kIdsOnly);
  if (!twin) return forward_error(twin);
  ++frames_;
  std::map<int, std::int64_t> pixels;
  for (const std::uint16_t id : twin->instance_ids.values) ++pixels[id];
  for (std::size_t i = 0; i < spec.instances.size(); ++i) {
    look_at_instance(spec, i, *twin, pixels[spec.instances[i].id], weight);
  }
  find_coincident(spec, *twin);
  return {};
}

void Surveyor::look_at_instance(const FrameSpec& spec, std::size_t index, const Twin& twin,
                                std::int64_t pixels, double weight) {
  const InstanceSpec& instance = spec.instances[index];
  const BoundingBox& box = twin.object_box(index);
  const Eigen::Vector3d camera = instance.camera_from_object.inverse().translation();
  if (instance.id == 0) {
    if (camera.z() < box.low.z()) ++frames_below_;
    return;
  }
  if (instance.hidden_from.camera) return;  // that it is not seen is meant
  Section& section = sections_[section_of(instance.name)];
  ++section.frames;
  section.labelled = section.labelled || instance.category != 0;
  any_labelled_px_ = any_labelled_px_ || (instance.category != 0 && pixels > 0);
  section.largest_px = std::max(section.largest_px, static_cast<double>(pixels) * weight);
  section.categories_of_assets[instance.asset].insert(instance.category);
  const Eigen::Matrix3d& linear = instance.camera_from_object.linear();
  const Eigen::Vector3d size = box.size().cwiseProduct(linear.colwise().norm().transpose());
  const Eigen::Vector3d nearest = camera.cwiseMax(box.low).cwiseMin(box.high);  // of the box
  const double distance = (linear * (nearest - camera)).norm();
  const bool inside = (camera.array() > box.low.array()).all() &&
                      (camera.array() < box.high.array()).all() &&
                      static_cast<double>(pixels) >=
                          kFilled * static_cast<double>(spec.render.width) * spec.render.height;
  if (inside) {
    ++section.frames_inside;
    section.size = size;
  } else if (instance.category != 0 && size.minCoeff() > kOutOfScale * distance) {
    section.too_near_m = distance;
    section.size = size;
  }
}

void Surveyor::find_coincident(const FrameSpec& spec, const Twin& twin) {
  for (int row = 0; row < spec.render.height; row += kStep) {
    for (int column = 0; column < spec.render.width; column += kStep) {
      const std::vector<int> met = twin.first_hits(row, column);
      if (met.size() < 2) continue;
      std::string first = section_of(spec.instances[static_cast<std::size_t>(met[0])].name);
      std::string second = section_of(spec.instances[static_cast<std::size_t>(met[1])].name);
      if (second < first) first.swap(second);
      ++coincident_px_[{first, second}];
    }
  }
}

std::string Surveyor::category_name(int category) const {
  return category == 0 ? "none" : categories_.at(static_cast<std::size_t>(category) - 1);
}

void Surveyor::warn_of_cameras(std::vector<std::string>& warnings) const {
  if (frames_below_ > 0) {
    warnings.push_back(fmt::format("the camera is under the ground in {} of {}", frames_below_,
                                   counted(frames_, "frame")));
  }
  for (const auto& [name, section] : sections_) {
    if (section.frames_inside > 0) {
      warnings.push_back(fmt::format(
          "the camera is inside of '{}', which is {} large, in {} of {}. If its file is in "
          "millimetres: 'seedframe asset import --unit mm', or scale: 0.001",
          name, metres(section.size), section.frames_inside, counted(frames_, "frame")));
    } else if (section.too_near_m > 0.0) {
      warnings.push_back(
          fmt::format("'{}' is {} large, {:.3g} m before the camera: is its unit right?", name,
                      metres(section.size), section.too_near_m));
    }
  }
}

void Surveyor::warn_of_sections(std::vector<std::string>& warnings) const {
  for (const auto& [name, section] : sections_) {
    if (section.largest_px == 0.0) {
      warnings.push_back(
          fmt::format("'{}' is in {}, and seen in none: it is out of view, "
                      "behind something, or tiny",
                      name, counted(section.frames, "frame")));
    } else if (section.labelled && section.largest_px < kSmallPx) {
      warnings.push_back(fmt::format("'{}' never shows more than about {:.0f} pixels", name,
                                     std::max(1.0, section.largest_px)));
    }
    for (const auto& [asset, categories] : section.categories_of_assets) {
      if (categories.size() < 2) continue;
      warnings.push_back(fmt::format(
          "'{}' shows the asset '{}' as '{}' and as '{}': its asset and its category are drawn "
          "apart. 'category: own' keeps them together, as does a category for each asset",
          name, asset, category_name(*categories.begin()), category_name(*categories.rbegin())));
    }
  }
}

std::vector<std::string> Surveyor::warnings() const {
  std::vector<std::string> warnings;
  if (!any_labelled_px_) {
    warnings.push_back(
        categories_.empty()
            ? std::string("there are no categories, so nothing is labelled")
            : fmt::format("nothing that has a category is seen in {}: there would be "
                          "nothing to learn from",
                          counted(frames_, "frame")));
  }
  if (same_frames_.first >= 0) {
    warnings.push_back(
        fmt::format("frames {} and {} are the same but for their noise: nothing that "
                    "is drawn differs between them",
                    same_frames_.first, same_frames_.second));
  }
  warn_of_cameras(warnings);
  warn_of_sections(warnings);
  for (const auto& [pair, pixels] : coincident_px_) {
    if (pixels < kCoincidentPx) continue;
    const std::string who = pair.first == pair.second
                                ? fmt::format("copies of '{}'", pair.first)
                                : fmt::format("'{}' and '{}'", pair.first, pair.second);
    warnings.push_back(
        fmt::format("{} have faces at one place, seen in about {} pixels of {}: "
                    "either shows there, in speckles. Move one by a tenth of a "
                    "millimetre",
                    who, pixels * kStep * kStep, counted(frames_, "small picture")));
  }
  return warnings;
}

}  // namespace

Result<SceneSurvey> survey_scenes(const SceneExpander& expander,
                                  const std::vector<std::string>& categories) {
  SceneSurvey survey;
  Surveyor surveyor(categories);
  survey.frames = frames_to_see(expander.frame_count());
  for (const std::int64_t frame : survey.frames) {
    const Result<ExpandedFrame> expanded = expander.expand(frame, {.id = false});
    if (!expanded) return forward_error(expanded);
    if (Status looked = surveyor.look_at(frame, *expanded); !looked) return forward_error(looked);
  }
  survey.width = surveyor.width();
  survey.height = surveyor.height();
  survey.warnings = surveyor.warnings();
  return survey;
}

}  // namespace seedframe
