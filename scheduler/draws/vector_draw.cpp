#include "draws/vector_draw.h"

#include <utility>

namespace seedframe {

VectorDraw VectorDraw::compile_any(const VectorSource& source, const CompileScope& scope,
                                   const std::string& name, Level level, Diagnostics& errors) {
  VectorDraw vector;
  if (source.alike) {
    vector.alike_ = true;
    vector.place_ = source.components[0].place;
    vector.components_[0] =
        NumberDraw::compile_any(source.components[0], scope, name, level, errors);
    vector.dimension_ = vector.components_[0].dimension();
    return vector;
  }
  if (!source.formula) {
    vector.place_ = source.components[0].place;
    for (std::size_t i = 0; i < 3; ++i) {
      vector.components_[i] = NumberDraw::compile_any(
          source.components[i], scope, fmt::format("{}[{}]", name, i), level, errors);
    }
    vector.dimension_ = vector.components_[0].dimension();
    for (const NumberDraw& component : vector.components_) {
      if (component.dimension() == vector.dimension_) continue;
      // A plain number goes with any unit that its key needs; two units do not go together.
      if (vector.dimension_.is_plain()) vector.dimension_ = component.dimension();
      if (component.dimension().is_plain() || component.dimension() == vector.dimension_) continue;
      errors.add(vector.place_, "the components of a vector must have the same unit");
      break;
    }
    return vector;
  }
  vector.place_ = source.formula->place;
  const Formula& formula = std::get<Formula>(source.formula->value);
  Result<CompiledFormula> compiled = CompiledFormula::compile(formula.text, scope.symbols);
  if (!compiled) {
    errors.add(vector.place_, compiled.error().message);
  } else if (compiled->type().type != ValueType::kVector) {
    errors.add(vector.place_, "'" + formula.text + "' is a number; a vector is needed here");
  } else {
    vector.dimension_ = compiled->type().dimension;
    vector.formula_ = std::make_shared<const CompiledFormula>(std::move(*compiled));
  }
  return vector;
}

VectorDraw VectorDraw::compile(const VectorSource& source, const CompileScope& scope,
                               const std::string& name, Level level, Diagnostics& errors) {
  VectorDraw vector = compile_any(source, scope, name, level, errors);
  const Dimension wanted = dimension_of_key(name);
  if (!vector.dimension_.is_plain() && vector.dimension_ != wanted) {
    errors.add(vector.place_, fmt::format("this is in {}, but {} is needed here",
                                          vector.dimension_.text(), wanted.text()));
  }
  return vector;
}

Eigen::Vector3d VectorDraw::evaluate(EvaluationContext& context) const {
  if (alike_) return Eigen::Vector3d::Constant(components_[0].evaluate(context));
  if (!formula_) {
    return {components_[0].evaluate(context), components_[1].evaluate(context),
            components_[2].evaluate(context)};
  }
  Eigen::Vector3d value = formula_->vector(context.values);
  if (value.allFinite()) return value;
  context.report(place_, fmt::format("the value is [{}, {}, {}], but a number must be finite",
                                     value.x(), value.y(), value.z()));
  return Eigen::Vector3d::Zero();
}

}  // namespace seedframe
