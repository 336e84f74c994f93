#include "mesh_files/color_slots.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/portable_math.h"

namespace seedframe {
namespace {

constexpr ColorCode kWhite = 0xffffff;

/// IEC 61966-2-1.
double linear_of(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : portable::pow((srgb + 0.055) / 1.055, 2.4);
}

double srgb_of(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * portable::pow(linear, 1.0 / 2.4) - 0.055;
}

/// Channel 0 is red.
double channel_of(ColorCode code, unsigned channel) {
  return static_cast<double>((code >> (16 - 8 * channel)) & 0xffU) / 255.0;
}

FileMaterial colored(FileMaterial material, ColorCode color) {
  for (unsigned i = 0; i < 3; ++i) material.base_color[i] *= linear_of(channel_of(color, i));
  return material;
}

}  // namespace

ColorCode code_of_srgb(const std::array<double, 3>& srgb) {
  ColorCode code = 0;
  for (const double value : srgb) {
    if (std::isnan(value)) return kNoColor;
    code = code << 8 | static_cast<ColorCode>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
  }
  return code;
}

ColorCode code_of_linear(const std::array<double, 3>& linear) {
  std::array<double, 3> srgb{};
  std::transform(linear.begin(), linear.end(), srgb.begin(), srgb_of);
  return code_of_srgb(srgb);
}

ColorCode color_of_triangle(const std::array<ColorCode, 3>& corners) {
  return corners[1] == corners[2] ? corners[1] : corners[0];
}

bool give_colors_slots(const std::vector<ColorCode>& colors, FileMesh& file) {
  std::set<ColorCode> distinct(colors.begin(), colors.end());
  distinct.erase(kNoColor);
  if (distinct.size() > kMostColorSlots) return false;
  Mesh& mesh = file.mesh;
  std::map<std::pair<std::uint32_t, ColorCode>, std::uint32_t> slots;
  for (std::size_t t = 0; t < colors.size(); ++t) {
    const ColorCode color = colors[t];
    std::uint32_t& slot = mesh.triangle_slots[t];
    const std::string name = mesh.slot_names[slot];
    const auto material = file.materials.find(name);
    const bool has_material = material != file.materials.end();
    if (color == kNoColor || (color == kWhite && has_material)) continue;
    const auto [known, is_new] =
        slots.try_emplace({slot, color}, static_cast<std::uint32_t>(mesh.slot_names.size()));
    if (is_new) {
      mesh.slot_names.push_back(name == "default" ? fmt::format("{:06x}", color)
                                                  : fmt::format("{}_{:06x}", name, color));
      FileMaterial plain;
      plain.base_color = {1.0, 1.0, 1.0};
      file.materials.insert_or_assign(mesh.slot_names.back(),
                                      colored(has_material ? material->second : plain, color));
    }
    slot = known->second;
  }
  return true;
}

}  // namespace seedframe
