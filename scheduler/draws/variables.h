// The variables of a config, in an order in which each comes after those that it refers to.
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "draws/color_draw.h"
#include "draws/name_draw.h"

namespace seedframe {

/// A variable as graphs know it.
struct GraphVariable {
  FormulaType type;
  bool per_copy = false;  ///< may have a list with a value for each copy
  std::size_t index = 0;  ///< in EvaluationContext::given
};

/// By the key that graphs use: "spread", "objects.bolts.spin".
using GraphVariables = std::map<std::string, GraphVariable>;

/// Where each variable of a config has its value, and what graphs call it.
struct VariableTable {
  std::size_t numbers = 0;  ///< size of VariableValues::numbers
  std::size_t texts = 0;    ///< of VariableValues::texts
  GraphVariables graph_variables;

  /// A new slot, with room for a vector.
  std::size_t add_numbers() { return std::exchange(numbers, numbers + 3); }
  std::size_t add_text() { return texts++; }
  /// With a place for each value.
  VariableValues blank_values() const {
    return {std::vector<double>(numbers), std::vector<std::string>(texts)};
  }
};

/// Says so if a new variable cannot have this name: it is built in, or known here already.
void refuse_taken_name(const std::string& name, const Place& place, const CompileScope& scope,
                       Diagnostics& errors);

/// The variables of one level or of one object.
class VariableBlock {
 public:
  /// Adds the variables to the table and the scope. Errors: a name that is taken, an unknown name,
  /// and a cycle, which is spelled out. `prefix` keys the draws: "variables.scene." or
  /// "objects.bolts.variables.".
  static VariableBlock compile(const std::vector<VariableConfig>& variables,
                               const std::string& prefix, Level level, VariableTable& table,
                               CompileScope& scope, Diagnostics& errors);

  /// Sets the value of each variable in the context: what is given, else a draw.
  void evaluate(EvaluationContext& context) const;

 private:
  struct Variable {
    std::string graph_key;
    Place place;
    std::variant<NumberDraw, VectorDraw, ColorDraw, NameDraw> source;
    FormulaType type;
    std::size_t slot = 0;
    std::size_t graph_index = 0;
  };
  static Variable compile_variable(const VariableConfig& config, const std::string& prefix,
                                   Level level, const CompileScope& scope, Diagnostics& errors);
  static void evaluate(const Variable& variable, EvaluationContext& context);
  static bool take_given(const Variable& variable, EvaluationContext& context);

  bool per_copy_ = false;
  std::vector<Variable> variables_;
};

}  // namespace seedframe
