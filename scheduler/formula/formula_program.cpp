#include "formula/formula_program.h"

#include <functional>

namespace seedframe {

FormulaValue FormulaProgram::evaluate(std::size_t index, const VariableValues& values) const {
  const Operation& op = operations[index];
  const auto input = [&](std::size_t i) { return evaluate(op.inputs[i], values); };
  const auto text = [&](std::size_t i) -> const std::string& {
    return op.texts[i].slot ? values.texts[*op.texts[i].slot] : op.texts[i].literal;
  };
  const auto each = [&](auto&& compute) {
    const FormulaValue a = input(0);
    const FormulaValue b = input(1);
    return FormulaValue{compute(a[0], b[0]), compute(a[1], b[1]), compute(a[2], b[2])};
  };
  const auto truth = [](bool value) { return FormulaValue{value ? 1.0 : 0.0}; };
  switch (op.code) {
    case Code::kConstant:
      return {op.constant};
    case Code::kNumber:
      return {values.numbers[op.slot]};
    case Code::kVector:
      return {values.numbers[op.slot], values.numbers[op.slot + 1], values.numbers[op.slot + 2]};
    case Code::kMakeVector:
      return {input(0)[0], input(1)[0], input(2)[0]};
    case Code::kComponent:
      return {input(0)[op.component]};
    case Code::kNegate: {
      const FormulaValue a = input(0);
      return {-a[0], -a[1], -a[2]};
    }
    case Code::kNot:
      return truth(input(0)[0] == 0.0);
    case Code::kAdd:
      return each(std::plus<>());
    case Code::kSubtract:
      return each(std::minus<>());
    case Code::kMultiply:
      return each(std::multiplies<>());
    case Code::kScale: {
      const FormulaValue a = input(0);
      const double factor = input(1)[0];
      return {a[0] * factor, a[1] * factor, a[2] * factor};
    }
    case Code::kDivide: {
      const FormulaValue a = input(0);
      const double divisor = input(1)[0];
      return {a[0] / divisor, a[1] / divisor, a[2] / divisor};
    }
    case Code::kLess:
      return truth(input(0)[0] < input(1)[0]);
    case Code::kLessEqual:
      return truth(input(0)[0] <= input(1)[0]);
    case Code::kEqual:
      return truth(input(0)[0] == input(1)[0]);
    case Code::kNotEqual:
      return truth(input(0)[0] != input(1)[0]);
    case Code::kAnd:
      return truth(input(0)[0] != 0.0 && input(1)[0] != 0.0);
    case Code::kOr:
      return truth(input(0)[0] != 0.0 || input(1)[0] != 0.0);
    case Code::kTextEqual:
      return truth(text(0) == text(1));
    case Code::kTextNotEqual:
      return truth(text(0) != text(1));
    case Code::kCondition:
      return input(0)[0] != 0.0 ? input(1) : input(2);
    case Code::kCall: {
      std::array<FormulaValue, kMostFormulaArguments> arguments;
      for (std::size_t i = 0; i < op.arguments.size(); ++i) {
        arguments[i] = evaluate(op.arguments[i], values);
      }
      return op.function->apply({arguments.data(), op.arguments.size()}, op.argument_types);
    }
  }
  return {};
}

}  // namespace seedframe
