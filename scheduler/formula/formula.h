// Formulas of a config: typed arithmetic over numbers with units, vectors and texts.
//
// The grammar, loosest first: a ? b : c, ||, &&, == != < <= > >=, + -, * /, unary - + !, then
// v.x, v[0] and calls. Types and units are checked when a formula is compiled; what is computed
// goes through portable functions, so that the last bit does not depend on the CPU.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "formula/dimension.h"

namespace seedframe {

enum class ValueType { kNumber, kVector, kText };

struct FormulaType {
  ValueType type = ValueType::kNumber;
  Dimension dimension;  ///< of a number, or of each component of a vector

  bool operator==(const FormulaType&) const = default;
};

/// What variables are at one place of a campaign. Formulas only know where in here each one is, so
/// that one formula can be evaluated with different values at the same time.
struct VariableValues {
  std::vector<double> numbers;  ///< a vector is three in a row
  std::vector<std::string> texts;
};

/// A variable: its type, and the index of its value (a vector's first) in `numbers` or `texts`.
struct Symbol {
  FormulaType type;
  std::size_t slot = 0;
};
using Scope = std::map<std::string, Symbol>;

Symbol number_symbol(std::size_t slot, Dimension dimension = {});

struct FormulaProgram;

class CompiledFormula {
 public:
  /// Errors say what is wrong without the place, which the caller knows: syntax, an unknown
  /// variable, function or unit (with "did you mean"), types or units that do not go together.
  static Result<CompiledFormula> compile(const std::string& text, const Scope& scope);
  ~CompiledFormula();
  CompiledFormula(CompiledFormula&&) noexcept;
  CompiledFormula& operator=(CompiledFormula&&) noexcept;

  FormulaType type() const;
  /// In base units (degrees, metres, …). May be NaN or infinite (1/0): the caller checks. `values`
  /// has an entry for each slot of the scope.
  double number(const VariableValues& values) const;
  Eigen::Vector3d vector(const VariableValues& values) const;

 private:
  explicit CompiledFormula(std::unique_ptr<FormulaProgram> program);
  std::unique_ptr<FormulaProgram> program_;
};

/// Names of variables in a formula, whether or not they exist. Empty when it has no syntax.
std::vector<std::string> variables_in_formula(const std::string& text);

}  // namespace seedframe
