#include "config/render_section.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/nearest_name.h"

namespace seedframe {
namespace {

constexpr long long kLargestSide = 16384;  // of an image, pixels
constexpr long long kMostSamples = 1 << 20;

// Blender takes numbers beyond these limits of its own and renders with the limit, without a word.
constexpr long long kMostMinSamples = 4096;
constexpr double kLeastFilterPx = 0.01, kMostFilterPx = 10.0;
constexpr double kMostThreshold = 1.0;  // of adaptive sampling, and of lights
constexpr double kMostClamp = 1e8;
constexpr double kMostFilterGlossy = 10.0;

double read_within(SectionReader& section, const char* key, double fallback, double least,
                   double most) {
  const std::size_t errors_before = section.errors().size();
  const double value = section.positive(key, fallback);
  if (section.errors().size() > errors_before || (value >= least && value <= most)) return value;
  section.errors().add(
      section.node().find(key)->place(),
      fmt::format("expected a number from {} to {}, found {}", least, most, value));
  return fallback;
}

/// The minimum must be named: Cycles' own, chosen by the threshold, means that nothing stops before
/// 80 samples at 0.01.
AdaptiveSampling read_adaptive(SectionReader& render, int samples) {
  AdaptiveSampling adaptive;
  const auto node = render.find("adaptive");
  if (!node || node->is_null()) return adaptive;
  SectionReader section(*node, render.errors());
  section.require("threshold");
  section.require("min_samples");
  adaptive.threshold = read_within(section, "threshold", 1.0, 0.0, kMostThreshold);
  adaptive.min_samples = static_cast<int>(section.integer("min_samples", 1, 1, kMostMinSamples));
  section.refuse_other_keys();
  if (adaptive.min_samples > samples) {
    render.errors().add(node->place(),
                        fmt::format("min_samples of {} are more than render.samples, {}, so no "
                                    "pixel could stop earlier",
                                    adaptive.min_samples, samples));
  }
  return adaptive;
}

BounceLimits read_bounces(SectionReader& render, int most) {
  BounceLimits bounces;
  const auto node = render.find("bounces");
  if (!node) return bounces;
  SectionReader section(*node, render.errors());
  for (const auto& [limit, kind] :
       {std::pair(&bounces.diffuse, "diffuse"), std::pair(&bounces.glossy, "glossy"),
        std::pair(&bounces.transmission, "transmission"),
        std::pair(&bounces.transparent, "transparent")}) {
    if (section.find(kind)) *limit = static_cast<int>(section.integer(kind, most, 0, most));
  }
  section.refuse_other_keys();
  return bounces;
}

double read_limit(SectionReader& render, const char* key, double fallback, double most) {
  const double limit = render.constant(key, fallback);
  if (limit >= 0.0 && limit <= most) return limit;
  render.errors().add(render.node().find(key)->place(),
                      fmt::format("expected 0 (off) to {:g}, found {:g}", most, limit));
  return fallback;
}

/// The sizes that Cycles knows, which are powers of two.
int read_texture_limit(SectionReader& render) {
  constexpr int kLeast = 128;
  constexpr int kMost = 8192;
  const auto px = static_cast<int>(render.integer("texture_limit_px", 0, 0, kMost));
  if (px == 0 || (px >= kLeast && (px & (px - 1)) == 0)) return px;
  render.errors().add(render.node().find("texture_limit_px")->place(),
                      fmt::format("expected 0 (no limit) or a power of two from {} to {}, found {}",
                                  kLeast, kMost, px));
  return 0;
}

RenderLevers read_levers(SectionReader& render, int max_bounces) {
  RenderLevers levers;
  levers.bounces = read_bounces(render, max_bounces);
  levers.light_threshold = read_limit(render, "light_threshold", 0.0, kMostThreshold);
  levers.clamp_direct = read_limit(render, "clamp_direct", 0.0, kMostClamp);
  levers.filter_glossy = read_limit(render, "filter_glossy", 0.0, kMostFilterGlossy);
  levers.texture_limit_px = read_texture_limit(render);
  levers.path_guiding = render.flag("path_guiding", false);
  return levers;
}

/// Around all objects, or a rectangle inside the image.
RegionConfig read_region(SectionReader& render, int width, int height) {
  RegionConfig region;
  const auto node = render.find("region");
  if (!node || node->is_null()) return region;
  const auto read_around = [&](const ConfigNode& around) {
    region.of_objects = around.is_scalar() && around.text() == "objects";
    if (region.of_objects) return;
    render.errors().add(around.place(),
                        "expected 'objects', or a rectangle by x, y, width and height, found " +
                            around.description());
  };
  if (node->is_scalar()) {
    read_around(*node);
    return region;
  }
  SectionReader section(*node, render.errors());
  if (const auto around = section.find("around")) {
    read_around(*around);
  } else {
    PixelRect box;
    box.x = static_cast<int>(section.integer("x", 0, 0, width - 1));
    box.y = static_cast<int>(section.integer("y", 0, 0, height - 1));
    box.width = static_cast<int>(section.integer("width", width - box.x, 1, width - box.x));
    box.height = static_cast<int>(section.integer("height", height - box.y, 1, height - box.y));
    region.box = box;
  }
  section.refuse_other_keys();
  return region;
}

/// One of `names`, which are those of an enum in its order; absent: the first.
template <class Enum, std::size_t N>
Enum read_enum(SectionReader& render, const char* key, const std::array<const char*, N>& names) {
  const std::string name = render.text(key, names[0]);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<Enum>(found - names.begin());
  render.errors().add(render.node().find(key)->place(),
                      fmt::format("expected one of {}, found '{}'{}", fmt::join(names, ", "), name,
                                  did_you_mean(name, {names.begin(), names.end()})));
  return Enum{};
}

}  // namespace

RenderConfig read_render(SectionReader& campaign, Diagnostics& errors) {
  RenderConfig render;
  const auto node = campaign.find("render");
  if (!node) return render;
  render.place = node->place();
  SectionReader section(*node, errors);
  render.width = static_cast<int>(section.integer("width", render.width, 1, kLargestSide));
  render.height = static_cast<int>(section.integer("height", render.height, 1, kLargestSide));
  render.samples = static_cast<int>(section.integer("samples", render.samples, 1, kMostSamples));
  render.max_bounces =
      static_cast<int>(section.integer("max_bounces", render.max_bounces, 0, 1024));
  render.filter_width_px = read_within(section, "filter_width_px", render.filter_width_px,
                                       kLeastFilterPx, kMostFilterPx);
  render.clamp_indirect = read_limit(section, "clamp_indirect", render.clamp_indirect, kMostClamp);
  render.levers = read_levers(section, render.max_bounces);
  render.region = read_region(section, render.width, render.height);
  for (const std::string& pass : section.texts("passes")) {
    if (pass == "depth") {
      render.depth = true;
    } else if (pass == "normal") {
      render.normal = true;
    } else {
      errors.add(node->find("passes")->place(),
                 "unknown pass '" + pass + "'" + did_you_mean(pass, {"depth", "normal"}));
    }
  }
  render.adaptive = read_adaptive(section, render.samples);
  render.denoise = read_enum<Denoise>(section, "denoise", kDenoiseNames);
  render.device = read_enum<RenderDevice>(section, "device", kRenderDeviceNames);
  if (const auto kept = section.find("persistent_data")) render.place = kept->place();
  render.persistent_data = section.flag("persistent_data", render.persistent_data);
  section.refuse_other_keys();
  return render;
}

std::optional<PatchConfig> read_patches(SectionReader& campaign, const RenderConfig& render) {
  constexpr long long kLargestPatch = 4096;
  const auto node = campaign.find("patches");
  if (!node || node->is_null()) return std::nullopt;
  SectionReader section(*node, campaign.errors());
  PatchConfig patches;
  patches.place = node->place();
  patches.size = static_cast<int>(section.integer("size", patches.size, 1, kLargestPatch));
  patches.least_visible = section.constant("least_visible", patches.least_visible);
  if (!(patches.least_visible > 0.0 && patches.least_visible <= 1.0)) {
    campaign.errors().add(
        section.node().find("least_visible")->place(),
        fmt::format("expected a share above 0 and up to 1, found {}", patches.least_visible));
  }
  patches.keep_shape = section.flag("keep_shape", patches.keep_shape);
  section.refuse_other_keys();
  if (render.region.of_objects || render.region.box) {
    campaign.errors().add(node->place(),
                          "a patch is a part of the image already: leave render.region out");
  }
  return patches;
}

}  // namespace seedframe
