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

/// The minimum must be named: Cycles' own, chosen by the threshold, means that nothing stops before
/// 80 samples at 0.01.
AdaptiveSampling read_adaptive(SectionReader& render, int samples) {
  AdaptiveSampling adaptive;
  const auto node = render.find("adaptive");
  if (!node) return adaptive;
  SectionReader section(*node, render.errors());
  section.require("threshold");
  section.require("min_samples");
  adaptive.threshold = section.positive("threshold", 1.0);
  adaptive.min_samples = static_cast<int>(section.integer("min_samples", 1, 1, kMostSamples));
  section.refuse_other_keys();
  if (adaptive.min_samples > samples) {
    render.errors().add(node->place(),
                        fmt::format("min_samples of {} are more than render.samples, {}, so no "
                                    "pixel could stop earlier",
                                    adaptive.min_samples, samples));
  }
  return adaptive;
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
  render.filter_width_px = section.positive("filter_width_px", render.filter_width_px);
  render.clamp_indirect = section.constant("clamp_indirect", render.clamp_indirect);
  if (render.clamp_indirect < 0.0) {
    errors.add(node->find("clamp_indirect")->place(), "expected 0 (no limit) or more");
  }
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

}  // namespace seedframe
