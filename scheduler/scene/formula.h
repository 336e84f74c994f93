// Formulas of a config: arithmetic over variables, evaluated by muParser with portable functions.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

/// The variables that a formula may name, each with the place its value is read from at evaluation.
using Scope = std::map<std::string, const double*>;

class CompiledFormula {
 public:
  /// Errors say what is wrong without the place, which the caller knows: syntax, an unknown
  /// variable or function (with "did you mean"), operators that are not offered (^ and =).
  static Result<CompiledFormula> compile(const std::string& text, const Scope& scope);
  ~CompiledFormula();
  CompiledFormula(CompiledFormula&&) noexcept;
  CompiledFormula& operator=(CompiledFormula&&) noexcept;

  /// May be NaN or infinite (1/0): the caller checks.
  double evaluate() const;

 private:
  struct State;
  explicit CompiledFormula(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Names of variables in a formula, whether or not they exist. Empty when it has no syntax.
std::vector<std::string> variables_in_formula(const std::string& text);

}  // namespace seedframe
