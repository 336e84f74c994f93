#include "formula/dimension.h"

#include <algorithm>
#include <cstdlib>

#include "base/portable_math.h"

namespace seedframe {
namespace {

constexpr std::array<const char*, 5> kBaseUnits = {"deg", "m", "W", "lm", "K"};

const std::array<Unit, 9>& units() {
  static const std::array<Unit, 9> list = {{{"deg", 1.0, kAngle},
                                            {"rad", 180.0 / portable::kPi, kAngle},
                                            {"m", 1.0, kLength},
                                            {"cm", 0.01, kLength},
                                            {"mm", 0.001, kLength},
                                            {"km", 1000.0, kLength},
                                            {"W", 1.0, kRadiantFlux},
                                            {"lm", 1.0, kLuminousFlux},
                                            {"K", 1.0, kTemperature}}};
  return list;
}

/// Stays at the ends of its range: coming round to 0 would make a plain number of a power of
/// metres.
std::int8_t exponent(int value) { return static_cast<std::int8_t>(std::clamp(value, -127, 127)); }

}  // namespace

Dimension Dimension::operator*(const Dimension& other) const {
  Dimension result;
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    result.exponents[i] = exponent(exponents[i] + other.exponents[i]);
  }
  return result;
}

Dimension Dimension::operator/(const Dimension& other) const {
  Dimension result;
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    result.exponents[i] = exponent(exponents[i] - other.exponents[i]);
  }
  return result;
}

std::string Dimension::text() const {
  if (is_plain()) return "a plain number";
  std::string above;
  std::string below;
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    if (exponents[i] == 0) continue;
    std::string& side = exponents[i] > 0 ? above : below;
    if (!side.empty()) side += "·";
    side += kBaseUnits[i];
    const int power = std::abs(exponents[i]);
    if (power > 1) side += "^" + std::to_string(power);
  }
  if (below.empty()) return above;
  return (above.empty() ? "1" : above) + "/" + below;
}

std::optional<Unit> find_unit(std::string_view name) {
  for (const Unit& unit : units()) {
    if (unit.name == name) return unit;
  }
  return std::nullopt;
}

Dimension dimension_of_key(std::string_view key) {
  const std::string_view name = key.substr(0, key.find('['));
  const std::string_view last = name.substr(name.rfind('.') + 1);
  if (last.ends_with("_deg")) return kAngle;
  if (last.ends_with("_per_m")) return Dimension{} / kLength;
  if (last.ends_with("_m")) return kLength;
  if (last == "position" || last == "target" || last == "x" || last == "y") return kLength;
  if (last == "power") return kRadiantFlux;
  if (last == "lumens") return kLuminousFlux;
  return {};
}

}  // namespace seedframe
