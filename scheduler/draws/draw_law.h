// What a draw was drawn from, with the parameters of that one draw: what people compare it with.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/campaign_config.h"

namespace seedframe {

struct DrawLaw {
  Level level = Level::kFrame;  ///< how often it is drawn
  DistributionKind kind = DistributionKind::kUniform;
  std::array<double, 4> parameters{};  ///< in the order of DistributionKind, base units
  /// kChoice only: the names or the numbers, and as many weights (>= 0, their sum is positive). No
  /// numbers where what is chosen is drawn itself: then no law in closed form is known.
  std::vector<std::string> names;
  std::vector<double> numbers;
  std::vector<double> weights;
  std::shared_ptr<const std::vector<double>> samples;  ///< kEmpirical only, sorted
};

/// "uniform", "normal", …: as configs call it.
const char* name_of(DistributionKind kind);

/// Whether values are whole numbers, or some numbers or names.
bool is_discrete(const DrawLaw& law);

/// P(X <= x); for discrete numbers too. None where it is not known, and for names.
std::optional<double> share_up_to(const DrawLaw& law, double x);

}  // namespace seedframe
