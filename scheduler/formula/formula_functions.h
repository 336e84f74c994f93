// The functions that a formula may call.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "formula/formula.h"

namespace seedframe {

/// A number in the first component, or a vector.
using FormulaValue = std::array<double, 3>;

struct FormulaFunction {
  std::string_view name;
  std::size_t least_arguments = 1;
  std::size_t most_arguments = 1;
  /// The type of the result; an error says which types are wanted.
  Result<FormulaType> (*result)(std::span<const FormulaType> arguments) = nullptr;
  /// `types` are those of the arguments.
  FormulaValue (*apply)(std::span<const FormulaValue> arguments,
                        std::span<const FormulaType> types) = nullptr;
};

/// None for an unknown name.
const FormulaFunction* find_formula_function(std::string_view name);
std::vector<std::string> formula_function_names();

}  // namespace seedframe
