#include "quality/variation.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

namespace seedframe {
namespace {

constexpr int kLeverSamples = 16;   // of variations whose lever is not about samples
constexpr int kAdaptiveMost = 512;  // samples that an adaptive pixel gets at most

Override set_to(std::string path, const std::string& value) { return {std::move(path), value}; }

Variation with(Variation variation, Lever lever, const std::string& name,
               const std::vector<Override>& more) {
  variation.name = name;
  variation.lever = lever;
  variation.set.insert(variation.set.end(), more.begin(), more.end());
  return variation;
}

/// A lever at a number of samples at which much noise is left and a picture is to be recognised.
Variation lever(Lever lever, const std::string& what, const std::vector<Override>& set) {
  return with(plain_samples(kLeverSamples), lever,
              fmt::format("{} samples, {}", kLeverSamples, what), set);
}

Variation adaptive(double threshold, int least, bool denoised) {
  Variation variation = with(
      plain_samples(kAdaptiveMost), denoised ? Lever::kAdaptiveDenoise : Lever::kAdaptive,
      fmt::format("adaptive {}, at least {}{}", threshold, least, denoised ? ", oidn_fast" : ""),
      {set_to("render.adaptive",
              fmt::format("{{threshold: {}, min_samples: {}}}", threshold, least))});
  if (denoised) variation.set.push_back(set_to("render.denoise", "oidn_fast"));
  return variation;
}

void add_bounces(std::vector<Variation>& grid) {
  for (const int most : {0, 1, 2, 3}) {
    grid.push_back(lever(Lever::kBounces, fmt::format("max_bounces {}", most),
                         {set_to("render.max_bounces", std::to_string(most))}));
  }
  for (const char* kind : {"diffuse", "glossy", "transmission", "transparent"}) {
    for (const int most : {0, 1}) {
      grid.push_back(lever(Lever::kBounces, fmt::format("{} bounces {}", kind, most),
                           {set_to(fmt::format("render.bounces.{}", kind), std::to_string(most))}));
    }
  }
}

void add_light_levers(std::vector<Variation>& grid) {
  for (const char* value : {"0.001", "0.01", "0.1"}) {
    grid.push_back(lever(Lever::kLightThreshold, fmt::format("light_threshold {}", value),
                         {set_to("render.light_threshold", value)}));
  }
  for (const char* key : {"clamp_indirect", "clamp_direct"}) {
    for (const char* value : {"0", "1", "3", "10"}) {
      grid.push_back(lever(Lever::kClamp, fmt::format("{} {}", key, value),
                           {set_to(fmt::format("render.{}", key), value)}));
    }
  }
  for (const char* value : {"0.5", "1"}) {
    grid.push_back(lever(Lever::kFilterGlossy, fmt::format("filter_glossy {}", value),
                         {set_to("render.filter_glossy", value)}));
  }
}

/// Sections of the config that objects come from, groups aside: "name/copy".
std::set<std::string> object_sections(const std::vector<ExpandedFrame>& pilots) {
  std::set<std::string> sections;
  for (const ExpandedFrame& frame : pilots) {
    for (const InstanceSpec& instance : frame.spec.instances) {
      if (std::count(instance.name.begin(), instance.name.end(), '/') == 1) {
        sections.insert(instance.name.substr(0, instance.name.find('/')));
      }
    }
  }
  return sections;
}

void add_scene_levers(const std::vector<ExpandedFrame>& pilots, std::vector<Variation>& grid) {
  const auto any = [&](const auto& has) { return std::any_of(pilots.begin(), pilots.end(), has); };
  if (any([](const ExpandedFrame& frame) { return !frame.spec.world.hdri.empty(); })) {
    for (const char* px : {"128", "256", "512", "1024", "2048"}) {
      grid.push_back(lever(Lever::kImportanceMap, fmt::format("importance_map_px {}", px),
                           {set_to("world.importance_map_px", px)}));
    }
  }
  if (any([](const ExpandedFrame& frame) { return !frame.used.images.empty(); })) {
    for (const char* px : {"256", "512", "1024"}) {
      grid.push_back(lever(Lever::kTextures, fmt::format("texture_limit_px {}", px),
                           {set_to("render.texture_limit_px", px)}));
    }
  }
  std::vector<Override> detail;
  for (const std::string& section : object_sections(pilots)) {
    detail.push_back(set_to(fmt::format("objects.{}.detail", section), "auto"));
  }
  if (!detail.empty()) grid.push_back(lever(Lever::kDetail, "detail auto", detail));
}

}  // namespace

const char* name_of(Lever lever) {
  constexpr std::array<const char*, 12> kNames = {
      "samples",        "denoising",       "adaptive", "adaptive, denoised",
      "bounces",        "light threshold", "clamps",   "filter glossy",
      "importance map", "texture size",    "detail",   "path guiding"};
  return kNames[static_cast<std::size_t>(lever)];
}

Variation plain_samples(int samples) {
  return {fmt::format("{} sample{}", samples, samples == 1 ? "" : "s"),
          Lever::kSamples,
          samples,
          {set_to("render.samples", std::to_string(samples)), set_to("render.adaptive", "null"),
           set_to("render.denoise", "off"), set_to("quality", "null"),
           set_to("render.light_threshold", "0"), set_to("render.filter_glossy", "0"),
           set_to("render.texture_limit_px", "0")}};
}

Variation reference_variation(int samples) {
  return with(plain_samples(samples), Lever::kSamples, "reference",
              {set_to("render.clamp_indirect", "0"), set_to("render.clamp_direct", "0")});
}

std::vector<Variation> variation_grid(const std::vector<ExpandedFrame>& pilots, int most_samples) {
  constexpr int kEarly = 64;  // more samples than these are dear, and tell least
  std::vector<Variation> grid;
  for (int samples = 1; samples <= std::min(kEarly, most_samples); samples *= 2) {
    grid.push_back(plain_samples(samples));
  }
  for (const int samples : {1, 2, 4, 8, 16, 32}) {
    for (const char* denoiser : {"oidn_fast", "oidn"}) {
      grid.push_back(with(plain_samples(samples), Lever::kDenoise,
                          fmt::format("{}, {}", plain_samples(samples).name, denoiser),
                          {set_to("render.denoise", denoiser)}));
    }
  }
  for (const double threshold : {0.4, 0.2, 0.1, 0.05, 0.02}) {
    for (const int least : {4, 16}) grid.push_back(adaptive(threshold, least, false));
    grid.push_back(adaptive(threshold, 4, true));
  }
  add_light_levers(grid);
  add_bounces(grid);
  add_scene_levers(pilots, grid);
  // It promises nothing, so the promise is given up.
  grid.push_back(lever(Lever::kGuiding, "path guiding",
                       {set_to("render.path_guiding", "true"), set_to("determinism", "none")}));
  for (int samples = 2 * kEarly; samples <= most_samples; samples *= 2) {
    grid.push_back(plain_samples(samples));
  }
  return grid;
}

}  // namespace seedframe
