// Physical dimensions of numbers in formulas: 30deg + 2m is a mistake that can be named.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace seedframe {

/// Exponents of the base units. A number without a unit has none of them.
struct Dimension {
  /// In the order: angle (degree), length (metre), radiant flux (watt), luminous flux (lumen),
  /// temperature (kelvin).
  std::array<std::int8_t, 5> exponents{};

  bool operator==(const Dimension&) const = default;
  bool is_plain() const { return *this == Dimension{}; }
  Dimension operator*(const Dimension& other) const;
  Dimension operator/(const Dimension& other) const;
  /// "m", "lm/W", "a plain number": for messages.
  std::string text() const;
};

inline constexpr Dimension kAngle{{1, 0, 0, 0, 0}};
inline constexpr Dimension kLength{{0, 1, 0, 0, 0}};
inline constexpr Dimension kRadiantFlux{{0, 0, 1, 0, 0}};
inline constexpr Dimension kLuminousFlux{{0, 0, 0, 1, 0}};
inline constexpr Dimension kTemperature{{0, 0, 0, 0, 1}};

/// A unit that may stand behind a number: how many base units it is, and of what.
struct Unit {
  std::string_view name;
  double base_units = 1.0;
  Dimension dimension;
};

/// deg, rad, m, cm, mm, km, W, lm, K; none for another name.
std::optional<Unit> find_unit(std::string_view name);

/// What a config key stands for, by the ending of its name: objects.x.rotation_deg[2] is an angle,
/// camera.distance_m a length, lights.x.lumens a luminous flux.
Dimension dimension_of_key(std::string_view key);

}  // namespace seedframe
