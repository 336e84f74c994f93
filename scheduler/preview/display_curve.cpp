#include "preview/display_curve.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

namespace seedframe {
namespace {

/// Exponents of Filmic's looks, fitted to their tables between -6 and 2 stops around 0.18.
struct Contrast {
  std::string_view look;
  double exponent;
};
constexpr std::array<Contrast, 6> kContrasts = {{{"Very High Contrast", 1.20},
                                                 {"High Contrast", 1.02},
                                                 {"Medium High Contrast", 0.89},
                                                 {"Medium Low Contrast", 0.69},
                                                 {"Low Contrast", 0.62},
                                                 {"Very Low Contrast", 0.55}}};
constexpr double kNoLook = 0.77;  // the same as "Medium Contrast"

double contrast_of(const std::string& look) {
  const auto* found = std::find_if(kContrasts.begin(), kContrasts.end(),
                                   [&](const Contrast& each) { return each.look == look; });
  return found == kContrasts.end() ? kNoLook : found->exponent;
}

double displayed(const ImageSettings& settings, double light) {
  if (settings.view == "Raw") return light;
  if (settings.view == "Standard") {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
  }
  constexpr double kMiddleGrey = 0.18;
  const double raised = std::pow(light / kMiddleGrey, contrast_of(settings.look));
  return raised / (raised + 1.0);
}

// Steps of light: 256 for each doubling, of positive floats from 2^-24 to 2^16.
constexpr int kDroppedBits = 15;
constexpr std::uint32_t step_of(float light) {
  return std::bit_cast<std::uint32_t>(light) >> kDroppedBits;
}
constexpr float kLeast = 0x1p-24F, kMost = 0x1p16F;

}  // namespace

DisplayCurve::DisplayCurve(const ImageSettings& settings, double exposure)
    : exposure_(static_cast<float>(exposure)) {
  codes_.reserve(step_of(kMost) - step_of(kLeast) + 1);
  for (std::uint32_t step = step_of(kLeast); step <= step_of(kMost); ++step) {
    const std::uint32_t middle = (step << kDroppedBits) + (1U << (kDroppedBits - 1U));
    const double share = displayed(settings, double{std::bit_cast<float>(middle)});
    const double corrected = std::pow(std::clamp(share, 0.0, 1.0), 1.0 / settings.gamma);
    codes_.push_back(static_cast<std::uint8_t>(std::lround(255.0 * corrected)));
  }
}

std::uint8_t DisplayCurve::code(float light) const {
  const float exposed = exposure_ * light;
  if (!(exposed >= kLeast)) return 0;
  return codes_[step_of(std::min(exposed, kMost)) - step_of(kLeast)];
}

Image<std::uint8_t> DisplayCurve::display(const Image<float>& light) const {
  Image<std::uint8_t> codes(light.width, light.height, light.channels);
  std::transform(light.values.begin(), light.values.end(), codes.values.begin(),
                 [this](float value) { return code(value); });
  return codes;
}

}  // namespace seedframe
