// Formulas of a config: typed arithmetic over numbers with units, vectors and texts.
//
// The grammar, loosest first: a ? b : c, ||, &&, == != < <= > >=, + -, * /, unary - + !, then
// v.x, v[0] and calls. Types and units are checked when a formula is compiled; what is computed
// goes through portable functions, so that the last bit does not depend on the CPU.
#pragma once

#include <Eigen/Core>
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

/// A variable: where its value is read when a formula is evaluated. A number is one double, a
/// vector three.
struct Symbol {
  FormulaType type;
  const double* numbers = nullptr;
  const std::string* text = nullptr;
};
using Scope = std::map<std::string, Symbol>;

Symbol number_symbol(const double* value, Dimension dimension = {});

class CompiledFormula {
 public:
  /// Errors say what is wrong without the place, which the caller knows: syntax, an unknown
  /// variable, function or unit (with "did you mean"), types or units that do not go together.
  static Result<CompiledFormula> compile(const std::string& text, const Scope& scope);
  ~CompiledFormula();
  CompiledFormula(CompiledFormula&&) noexcept;
  CompiledFormula& operator=(CompiledFormula&&) noexcept;

  FormulaType type() const;
  /// In base units (degrees, metres, …). May be NaN or infinite (1/0): the caller checks.
  double number() const;
  Eigen::Vector3d vector() const;

 private:
  struct Program;
  explicit CompiledFormula(std::unique_ptr<Program> program);
  std::unique_ptr<Program> program_;
};

/// Names of variables in a formula, whether or not they exist. Empty when it has no syntax.
std::vector<std::string> variables_in_formula(const std::string& text);

}  // namespace seedframe
