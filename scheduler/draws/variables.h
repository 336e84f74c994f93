// The variables of a config, in an order in which each comes after those that it refers to.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "draws/draw.h"

namespace seedframe {

/// Storage of variables' values; formulas read from it, so it must outlive them and not move.
class VariableValues {
 public:
  /// Three numbers; a number uses the first.
  double* numbers() { return numbers_.emplace_back().data(); }
  std::string* name() { return &names_.emplace_back(); }

 private:
  std::deque<std::array<double, 3>> numbers_;
  std::deque<std::string> names_;
};

/// What a graph says of one variable, instead of a draw: one value, or one for each copy.
struct GivenValues {
  std::vector<std::array<double, 3>> numbers;
  std::vector<std::string> names;
};

/// A variable as graphs know it.
struct GraphVariable {
  FormulaType type;
  bool per_copy = false;  ///< may have a list with a value for each copy
  GivenValues* given = nullptr;
};

/// By the key that graphs use: "spread", "objects.bolts.spin".
using GraphVariables = std::map<std::string, GraphVariable>;

/// Says so if a new variable cannot have this name: it is built in, or known here already.
void refuse_taken_name(const std::string& name, const Place& place, const CompileScope& scope,
                       Diagnostics& errors);

/// The variables of one level or of one object.
class VariableBlock {
 public:
  /// Adds the variables to the scope. Errors: a name that is taken, an unknown name, and a cycle,
  /// which is spelled out. `prefix` keys the draws: "variables.scene." or
  /// "objects.bolts.variables.".
  static VariableBlock compile(const std::vector<VariableConfig>& variables,
                               const std::string& prefix, Level level, VariableValues& values,
                               CompileScope& scope, Diagnostics& errors);

  /// Writes the value of each variable to its storage: what is given, else a draw.
  void evaluate(EvaluationContext& context) const;

  void add_to(GraphVariables& graph_variables) const;

 private:
  struct Variable {
    std::string graph_key;
    Place place;
    std::variant<NumberDraw, VectorDraw, ColorDraw, NameDraw> source;
    FormulaType type;
    double* numbers = nullptr;
    std::string* name = nullptr;
    std::shared_ptr<GivenValues> given;
  };
  static Variable compile_variable(const VariableConfig& config, const std::string& prefix,
                                   Level level, const CompileScope& scope, Diagnostics& errors);
  static void evaluate(const Variable& variable, EvaluationContext& context);
  static bool take_given(const Variable& variable, EvaluationContext& context);

  bool per_copy_ = false;
  std::vector<Variable> variables_;
};

}  // namespace seedframe
