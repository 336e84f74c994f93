// A formula as operations whose types are checked, ready to be evaluated.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "formula/formula.h"
#include "formula/formula_functions.h"

namespace seedframe {

inline constexpr std::size_t kMostFormulaArguments = 64;

/// A tree of operations; the root is the last.
struct FormulaProgram {
  enum class Code {
    kConstant,
    kNumber,  ///< variable
    kVector,  ///< variable
    kMakeVector,
    kComponent,
    kNegate,
    kNot,
    kAdd,
    kSubtract,
    kMultiply,
    kScale,  ///< vector · number
    kDivide,
    kLess,
    kLessEqual,
    kEqual,
    kNotEqual,
    kAnd,
    kOr,
    kTextEqual,
    kTextNotEqual,
    kCondition,
    kCall,
  };
  /// A variable of texts, or what stands in the formula.
  struct Text {
    std::optional<std::size_t> slot;
    std::string literal;
  };
  struct Operation {
    Code code = Code::kConstant;
    FormulaType type;
    std::array<std::size_t, 3> inputs{};  ///< of kCall: the first of `arguments`
    double constant = 0.0;
    std::size_t component = 0;
    std::size_t slot = 0;  ///< of a variable
    std::array<Text, 2> texts;
    const FormulaFunction* function = nullptr;
    std::vector<std::size_t> arguments;
    std::vector<FormulaType> argument_types;
  };
  std::vector<Operation> operations;

  FormulaValue evaluate(const VariableValues& values) const {
    return evaluate(operations.size() - 1, values);
  }
  const FormulaType& type() const { return operations.back().type; }

 private:
  FormulaValue evaluate(std::size_t index, const VariableValues& values) const;
};

}  // namespace seedframe
