// The variables of a config, in an order in which each comes after those that it refers to.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "scene/draw.h"

namespace seedframe {

/// Storage of variables' values; formulas read from it, so it must outlive them and not move.
class VariableValues {
 public:
  double* number() { return &numbers_.emplace_back(0.0); }
  std::string* name() { return &names_.emplace_back(); }

 private:
  std::deque<double> numbers_;
  std::deque<std::string> names_;
};

/// The variables of one level or of one object.
class VariableBlock {
 public:
  /// Adds the variables to the scope. Errors: a name that is taken, an unknown name, and a cycle,
  /// which is spelled out. `prefix` keys the draws: "scene." or "objects.bolts.".
  static VariableBlock compile(const std::vector<VariableConfig>& variables,
                               const std::string& prefix, Level level, VariableValues& values,
                               CompileScope& scope, Diagnostics& errors);

  /// Writes the value of each variable to its storage.
  void evaluate(EvaluationContext& context) const;

 private:
  struct Variable {
    std::variant<NumberDraw, NameDraw> source;
    double* number = nullptr;
    std::string* name = nullptr;
  };
  std::vector<Variable> variables_;
};

}  // namespace seedframe
