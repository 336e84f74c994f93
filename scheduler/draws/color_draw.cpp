#include "draws/color_draw.h"

#include <algorithm>

#include "formula/color.h"

namespace seedframe {

ColorDraw ColorDraw::compile(const ColorSource& source, const CompileScope& scope,
                             const std::string& name, Level level, Diagnostics& errors) {
  ColorDraw color;
  color.model_ = source.model;
  if (source.model == ColorModel::kFormula) {
    VectorSource formula;
    formula.formula = source.components[0];
    color.formula_ = VectorDraw::compile_any(formula, scope, name, level, errors);
    if (!color.formula_->dimension().is_plain()) {
      errors.add(color.formula_->place(), "a colour has no unit");
    }
    return color;
  }
  bool constant = true;
  for (std::size_t i = 0; i < 3; ++i) {
    constant = constant && std::holds_alternative<double>(source.components[i].value);
    color.components_[i] = NumberDraw::compile_any(source.components[i], scope,
                                                   fmt::format("{}[{}]", name, i), level, errors);
    const Dimension& dimension = color.components_[i].dimension();
    const bool fits = dimension.is_plain() ||
                      (i == 0 && source.model == ColorModel::kHsv && dimension == kAngle) ||
                      (i == 0 && source.model == ColorModel::kKelvin && dimension == kTemperature);
    if (!fits) {
      errors.add(color.components_[i].place(), "this unit has no meaning in a colour");
    }
  }
  if (constant) {
    EvaluationContext unplaced;
    color.value_ = color.evaluate(unplaced);
    color.constant_ = !unplaced.error;  // an error is reported when a frame is expanded
  }
  return color;
}

Rgb ColorDraw::evaluate(EvaluationContext& context) const {
  if (constant_) return value_;
  std::array<double, 3> c{};
  if (formula_) {
    const Eigen::Vector3d value = formula_->evaluate(context);
    c = {value.x(), value.y(), value.z()};
  } else {
    for (std::size_t i = 0; i < 3; ++i) c[i] = components_[i].evaluate(context);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const bool may_be_negative = model_ == ColorModel::kHsv && i == 0;
    if (c[i] < 0.0 && !may_be_negative) {
      context.report(formula_ ? formula_->place() : components_[i].place(),
                     fmt::format("a colour must not be negative, found {}", c[i]));
      c[i] = 0.0;
    }
  }
  if (model_ == ColorModel::kKelvin) return linear_from_kelvin(c[0]);
  if (model_ == ColorModel::kHsv) return linear_from_hsv(c[0], std::min(c[1], 1.0), c[2]);
  return c;
}

}  // namespace seedframe
