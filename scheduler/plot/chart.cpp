#include "plot/chart.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace seedframe {
namespace {

struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
};

Extent extent_of(const std::vector<double>& values, bool logarithmic) {
  Extent extent;
  for (const double value : values) {
    if (!std::isfinite(value) || (logarithmic && value <= 0.0)) continue;
    extent.least = std::min(extent.least, value);
    extent.most = std::max(extent.most, value);
  }
  if (extent.least > extent.most) return logarithmic ? Extent{0.1, 10.0} : Extent{0.0, 1.0};
  return extent;
}

/// 1, 2 or 5 times a power of ten: the least that is not below.
double round_step(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least * (1.0 - 1e-9)) return factor * decade;
  }
  return 10.0 * decade;
}

Ticks linear_ticks(Extent extent) {
  constexpr double kSteps = 6.0;
  if (extent.least == extent.most) {
    const double half = extent.least == 0.0 ? 1.0 : std::abs(extent.least) / 2.0;
    extent = {extent.least - half, extent.most + half};
  }
  const double step = round_step((extent.most - extent.least) / kSteps);
  Ticks ticks;
  const auto first = static_cast<std::int64_t>(std::floor(extent.least / step + 1e-9));
  const auto last = static_cast<std::int64_t>(std::ceil(extent.most / step - 1e-9));
  for (std::int64_t i = first; i <= last; ++i) {
    ticks.at.push_back(static_cast<double>(i) * step);
    ticks.text.push_back(tick_text(ticks.at.back()));
  }
  ticks.from = ticks.at.front();
  ticks.to = ticks.at.back();
  return ticks;
}

Ticks logarithmic_ticks(const Extent& extent) {
  constexpr int kFewDecades = 3;  // of so many, numbers between the powers have room
  Ticks ticks;
  const auto decade_below = static_cast<int>(std::floor(std::log10(extent.least) + 1e-9));
  const auto decade_above = static_cast<int>(std::ceil(std::log10(extent.most) - 1e-9));
  const bool few = decade_above - decade_below <= kFewDecades;
  std::vector<double> all;
  std::vector<std::string> texts;
  for (int decade = decade_below; decade <= std::max(decade_above, decade_below + 1); ++decade) {
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = digit * std::pow(10.0, decade);
      const bool told = digit == 1 || (few && (digit == 2 || digit == 5));
      all.push_back(value);
      texts.push_back(told ? tick_text(value) : std::string());
    }
  }
  // From the last step that is not above all values to the first that is not below.
  const auto not_above = std::upper_bound(all.begin(), all.end(), extent.least * (1.0 + 1e-9));
  const auto first =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, not_above - all.begin() - 1));
  const auto not_below = std::lower_bound(all.begin(), all.end(), extent.most * (1.0 - 1e-9));
  auto last = static_cast<std::size_t>(not_below - all.begin());
  last = std::min(std::max(last, first + 1), all.size() - 1);
  ticks.at.assign(all.begin() + static_cast<std::ptrdiff_t>(first),
                  all.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  ticks.text.assign(texts.begin() + static_cast<std::ptrdiff_t>(first),
                    texts.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  ticks.from = ticks.at.front();
  ticks.to = ticks.at.back();
  return ticks;
}

}  // namespace

ChartColor chart_color(std::size_t i) {
  // Okabe and Ito's eight ("Color Universal Design", 2008) without yellow, and three more.
  static constexpr std::array<ChartColor, 10> kColors = {{{0.00, 0.45, 0.70},
                                                          {0.84, 0.37, 0.00},
                                                          {0.00, 0.62, 0.45},
                                                          {0.80, 0.47, 0.65},
                                                          {0.90, 0.62, 0.00},
                                                          {0.34, 0.71, 0.91},
                                                          {0.20, 0.20, 0.20},
                                                          {0.50, 0.30, 0.75},
                                                          {0.60, 0.45, 0.25},
                                                          {0.55, 0.55, 0.55}}};
  return kColors[i % kColors.size()];
}

Ticks ticks_for(const std::vector<double>& values, bool logarithmic) {
  const Extent extent = extent_of(values, logarithmic);
  return logarithmic ? logarithmic_ticks(extent) : linear_ticks(extent);
}

std::string tick_text(double value) {
  constexpr double kLeastPlain = 1e-3;
  constexpr double kMostPlain = 1e5;
  const double size = std::abs(value);
  if (size < 1e-300) return "0";
  if (size >= kLeastPlain && size < kMostPlain) return fmt::format("{:.6g}", value);
  return fmt::format("{:.3g}", value);
}

}  // namespace seedframe
