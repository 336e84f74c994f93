#include "formula/formula_functions.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "formula/color.h"

namespace seedframe {
namespace {

using Types = std::span<const FormulaType>;
using Values = std::span<const FormulaValue>;

constexpr std::size_t kMany = 64;
constexpr FormulaType kPlainNumber{ValueType::kNumber, {}};
constexpr FormulaType kPlainVector{ValueType::kVector, {}};

bool is_number(const FormulaType& type) { return type.type == ValueType::kNumber; }
bool is_number_of(const FormulaType& type, const Dimension& dimension) {
  return is_number(type) && (type.dimension.is_plain() || type.dimension == dimension);
}

Result<FormulaType> needs(const char* what) { return fail(ErrorKind::kInput, "needs {}", what); }

Result<FormulaType> plain_numbers(Types types) {
  const bool fits = std::all_of(types.begin(), types.end(),
                                [](const FormulaType& type) { return type == kPlainNumber; });
  return fits ? Result<FormulaType>(kPlainNumber) : needs("plain numbers, without a unit");
}

Result<FormulaType> numbers_alike(Types types) {
  const bool fits = std::all_of(types.begin(), types.end(), [&](const FormulaType& type) {
    return is_number(type) && type == types[0];
  });
  return fits ? Result<FormulaType>(types[0]) : needs("numbers of one unit");
}

Result<FormulaType> ratio_of_numbers(Types types) {
  const Result<FormulaType> alike = numbers_alike(types);
  return alike ? Result<FormulaType>(kPlainNumber) : alike;
}

Result<FormulaType> one_angle(Types types) {
  return is_number_of(types[0], kAngle) ? Result<FormulaType>(kPlainNumber)
                                        : needs("an angle: with a unit, or plain");
}

Result<FormulaType> root(Types types) {
  FormulaType result = types[0];
  for (std::int8_t& exponent : result.dimension.exponents) {
    if (!is_number(result) || exponent % 2 != 0) return needs("a number whose unit is a square");
    exponent = static_cast<std::int8_t>(exponent / 2);
  }
  return result;
}

Result<FormulaType> vector_to_number(Types types) {
  if (types[0].type != ValueType::kVector) return needs("a vector");
  return FormulaType{ValueType::kNumber, types[0].dimension};
}

Result<FormulaType> vector_to_direction(Types types) {
  return types[0].type == ValueType::kVector ? Result<FormulaType>(kPlainVector)
                                             : needs("a vector");
}

Result<FormulaType> product_of_vectors(Types types, ValueType result) {
  if (types[0].type != ValueType::kVector || types[1].type != ValueType::kVector) {
    return needs("two vectors");
  }
  return FormulaType{result, types[0].dimension * types[1].dimension};
}

Result<FormulaType> turned_vector(Types types) {
  if (types[0].type != ValueType::kVector || !is_number_of(types[1], kAngle)) {
    return needs("a vector and an angle (plain: radians)");
  }
  return types[0];
}

Result<FormulaType> hsv_color(Types types) {
  const bool fits =
      is_number_of(types[0], kAngle) && types[1] == kPlainNumber && types[2] == kPlainNumber;
  return fits ? Result<FormulaType>(kPlainVector) : needs("hue, saturation and value");
}

Result<FormulaType> temperature_color(Types types) {
  return is_number_of(types[0], kTemperature) ? Result<FormulaType>(kPlainVector)
                                              : needs("a temperature in kelvin");
}

Result<FormulaType> rgb_color(Types types) {
  const Result<FormulaType> plain = plain_numbers(types);
  return plain ? Result<FormulaType>(kPlainVector) : plain;
}

/// Plain angles are radians in trigonometry, as everywhere in mathematics.
double radians_of(const FormulaValue& value, const FormulaType& type) {
  return type.dimension.is_plain() ? value[0] : portable::radians(value[0]);
}

template <double (*F)(double)>
FormulaValue unary(Values a, Types) {
  return {F(a[0][0])};
}
template <double (*F)(double)>
FormulaValue of_angle(Values a, Types types) {
  return {F(radians_of(a[0], types[0]))};
}
template <double (*F)(double, double)>
FormulaValue binary(Values a, Types) {
  return {F(a[0][0], a[1][0])};
}

double absolute(double x) { return std::fabs(x); }
double ceil_of(double x) { return std::ceil(x); }
double floor_of(double x) { return std::floor(x); }
double round_half_up(double x) { return std::floor(x + 0.5); }
double log10_of(double x) { return portable::log(x) / portable::log(10.0); }
double degrees(double radians) { return radians * (180.0 / portable::kPi); }
double modulo(double a, double b) { return a - b * std::floor(a / b); }

FormulaValue clamp(Values a, Types) {
  const double x = a[0][0];
  return {x < a[1][0] ? a[1][0] : (x > a[2][0] ? a[2][0] : x)};
}
FormulaValue least(Values a, Types) {
  double result = a[0][0];
  for (const FormulaValue& value : a) result = value[0] < result ? value[0] : result;
  return {result};
}
FormulaValue most(Values a, Types) {
  double result = a[0][0];
  for (const FormulaValue& value : a) result = value[0] > result ? value[0] : result;
  return {result};
}
FormulaValue to_degrees(Values a, Types types) {
  return {types[0].dimension.is_plain() ? degrees(a[0][0]) : a[0][0]};
}

double dot(const FormulaValue& a, const FormulaValue& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
FormulaValue dot_of(Values a, Types) { return {dot(a[0], a[1])}; }
FormulaValue cross_of(Values a, Types) {
  const FormulaValue& u = a[0];
  const FormulaValue& v = a[1];
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}
FormulaValue length_of(Values a, Types) { return {std::sqrt(dot(a[0], a[0]))}; }
FormulaValue normalized(Values a, Types) {
  const double length = std::sqrt(dot(a[0], a[0]));
  return {a[0][0] / length, a[0][1] / length, a[0][2] / length};
}

/// Right-handed, about the axis.
template <std::size_t Axis>
FormulaValue rotated(Values a, Types types) {
  const double angle = radians_of(a[1], types[1]);
  const double c = portable::cos(angle);
  const double s = portable::sin(angle);
  constexpr std::size_t kU = (Axis + 1) % 3;
  constexpr std::size_t kV = (Axis + 2) % 3;
  FormulaValue result = a[0];
  result[kU] = c * a[0][kU] - s * a[0][kV];
  result[kV] = s * a[0][kU] + c * a[0][kV];
  return result;
}

FormulaValue hsv(Values a, Types) {
  return linear_from_hsv(a[0][0], std::min(a[1][0], 1.0), a[2][0]);
}
FormulaValue blackbody(Values a, Types) { return linear_from_kelvin(a[0][0]); }
FormulaValue rgb(Values a, Types) { return {a[0][0], a[1][0], a[2][0]}; }

const std::vector<FormulaFunction>& functions() {
  static const std::vector<FormulaFunction> list = {
      {"abs", 1, 1, numbers_alike, unary<absolute>},
      {"acos", 1, 1, plain_numbers, unary<portable::acos>},
      {"asin", 1, 1, plain_numbers, unary<portable::asin>},
      {"atan", 1, 1, plain_numbers, unary<portable::atan>},
      {"atan2", 2, 2, ratio_of_numbers, binary<portable::atan2>},
      {"blackbody", 1, 1, temperature_color, blackbody},
      {"ceil", 1, 1, numbers_alike, unary<ceil_of>},
      {"clamp", 3, 3, numbers_alike, clamp},
      {"cos", 1, 1, one_angle, of_angle<portable::cos>},
      {"cross", 2, 2, [](Types types) { return product_of_vectors(types, ValueType::kVector); },
       cross_of},
      {"deg", 1, 1, one_angle, to_degrees},
      {"dot", 2, 2, [](Types types) { return product_of_vectors(types, ValueType::kNumber); },
       dot_of},
      {"exp", 1, 1, plain_numbers, unary<portable::exp>},
      {"floor", 1, 1, numbers_alike, unary<floor_of>},
      {"hsv", 3, 3, hsv_color, hsv},
      {"length", 1, 1, vector_to_number, length_of},
      {"ln", 1, 1, plain_numbers, unary<portable::log>},
      {"log10", 1, 1, plain_numbers, unary<log10_of>},
      {"max", 1, kMany, numbers_alike, most},
      {"min", 1, kMany, numbers_alike, least},
      {"mod", 2, 2, numbers_alike, binary<modulo>},
      {"normalize", 1, 1, vector_to_direction, normalized},
      {"pow", 2, 2, plain_numbers, binary<portable::pow>},
      {"rad", 1, 1, one_angle, unary<portable::radians>},
      {"rgb", 3, 3, rgb_color, rgb},
      {"rotate_x", 2, 2, turned_vector, rotated<0>},
      {"rotate_y", 2, 2, turned_vector, rotated<1>},
      {"rotate_z", 2, 2, turned_vector, rotated<2>},
      {"round", 1, 1, numbers_alike, unary<round_half_up>},
      {"sin", 1, 1, one_angle, of_angle<portable::sin>},
      {"sqrt", 1, 1, root, unary<portable::sqrt>},
      {"tan", 1, 1, one_angle, of_angle<portable::tan>}};
  return list;
}

}  // namespace

const FormulaFunction* find_formula_function(std::string_view name) {
  for (const FormulaFunction& function : functions()) {
    if (function.name == name) return &function;
  }
  return nullptr;
}

std::vector<std::string> formula_function_names() {
  std::vector<std::string> names;
  for (const FormulaFunction& function : functions()) names.emplace_back(function.name);
  return names;
}

}  // namespace seedframe
