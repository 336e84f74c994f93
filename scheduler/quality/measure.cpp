#include "quality/measure.h"

#include <algorithm>
#include <cassert>

namespace seedframe {

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all = {
      {"rmse8", "RMSE, codes of 8 bits",
       [](const RenderingError& error) { return error.display.rmse(); }},
      {"relmse", "relMSE, scene-linear",
       [](const RenderingError& error) { return error.linear.squared.rel_mse; }},
      {"flip", "FLIP, mean", [](const RenderingError& error) { return error.display.flip; }},
      {"mrse", "MRSE, scene-linear",
       [](const RenderingError& error) { return error.linear.squared.mrse; }},
      {"dissimilarity", "1 − SSIM",
       [](const RenderingError& error) { return 1.0 - error.display.ssim.value_or(1.0); }},
      {"edge_noise", "noise of contrast along edges, codes of 8 bits",
       [](const RenderingError& error) { return error.edges.noise(); }},
  };
  return all;
}

const Measure& measure_named(const std::string& key) {
  const auto found = std::find_if(measures().begin(), measures().end(),
                                  [&](const Measure& measure) { return key == measure.key; });
  assert(found != measures().end());
  return *found;
}

}  // namespace seedframe
