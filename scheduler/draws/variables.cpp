#include "draws/variables.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

namespace seedframe {
namespace {

void collect_references(const NumberSource& source, std::vector<std::string>& names) {
  if (const Formula* formula = std::get_if<Formula>(&source.value)) {
    for (std::string& name : variables_in_formula(formula->text)) names.push_back(std::move(name));
  } else if (const auto* distribution =
                 std::get_if<std::shared_ptr<const Distribution>>(&source.value)) {
    for (const NumberSource& part : (*distribution)->parameters) collect_references(part, names);
    for (const NumberSource& part : (*distribution)->weights) collect_references(part, names);
  }
}

std::vector<std::string> references(const VariableConfig& variable) {
  std::vector<std::string> names;
  if (const NumberSource* number = std::get_if<NumberSource>(&variable.source)) {
    collect_references(*number, names);
    return names;
  }
  if (const VectorSource* vector = std::get_if<VectorSource>(&variable.source)) {
    for (const NumberSource& component : vector->components) collect_references(component, names);
    if (vector->formula) collect_references(*vector->formula, names);
    return names;
  }
  if (const ColorSource* color = std::get_if<ColorSource>(&variable.source)) {
    for (const NumberSource& component : color->components) collect_references(component, names);
    return names;
  }
  for (const NameSource::Option& option : std::get<NameSource>(variable.source).options) {
    collect_references(option.weight, names);
    for (std::size_t open = option.text.find("${"); open != std::string::npos;
         open = option.text.find("${", open + 2)) {
      const std::size_t close = option.text.find('}', open);
      if (close == std::string::npos) break;
      names.push_back(option.text.substr(open + 2, close - open - 2));
    }
  }
  return names;
}

/// Depth-first order over the variables of one block.
class Order {
 public:
  Order(const std::vector<VariableConfig>& variables, Diagnostics& errors)
      : variables_(variables), errors_(errors), states_(variables.size(), State::kNew) {
    for (std::size_t i = 0; i < variables.size(); ++i) indices_[variables[i].name] = i;
    for (std::size_t i = 0; i < variables.size(); ++i) visit(i);
  }
  const std::vector<std::size_t>& sorted() const { return sorted_; }

 private:
  enum class State { kNew, kOpen, kDone };
  struct Step {
    std::size_t index = 0;
    std::vector<std::string> references;
    std::size_t next = 0;  ///< of its references
  };

  /// No recursion: a chain of references may be as long as the list of variables.
  void visit(std::size_t first) {
    enter(first);
    while (!trail_.empty()) {
      Step& step = trail_.back();
      if (step.next < step.references.size()) {
        const auto found = indices_.find(step.references[step.next++]);
        if (found != indices_.end()) enter(found->second);
        continue;
      }
      states_[step.index] = State::kDone;
      sorted_.push_back(step.index);
      trail_.pop_back();
    }
  }

  void enter(std::size_t index) {
    if (states_[index] == State::kDone) return;
    if (states_[index] == State::kOpen) {
      report_cycle(index);
      return;
    }
    states_[index] = State::kOpen;
    trail_.push_back({index, references(variables_[index])});
  }

  void report_cycle(std::size_t index) {
    auto step = std::find_if(trail_.begin(), trail_.end(),
                             [&](const Step& each) { return each.index == index; });
    std::string cycle;
    for (; step != trail_.end(); ++step) cycle += variables_[step->index].name + " → ";
    errors_.add(variables_[index].place, "these variables refer to each other in a circle: " +
                                             cycle + variables_[index].name);
  }

  const std::vector<VariableConfig>& variables_;
  Diagnostics& errors_;
  std::vector<State> states_;
  std::map<std::string, std::size_t> indices_;
  std::vector<Step> trail_;
  std::vector<std::size_t> sorted_;
};

/// "objects.bolts.variables.spin" is "objects.bolts.spin" in a graph, and "variables.scene.spread"
/// is "spread".
std::string graph_key(const std::string& prefix, const std::string& name) {
  const std::string word = "variables.";
  const std::size_t at = prefix.rfind(word);
  return at == 0 ? name : prefix.substr(0, at) + name;
}

bool is_vector_formula(const NumberSource& source, const CompileScope& scope) {
  const Formula* formula = std::get_if<Formula>(&source.value);
  if (formula == nullptr) return false;
  const Result<CompiledFormula> compiled = CompiledFormula::compile(formula->text, scope.symbols);
  return compiled && compiled->type().type == ValueType::kVector;
}

}  // namespace

void refuse_taken_name(const std::string& name, const Place& place, const CompileScope& scope,
                       Diagnostics& errors) {
  static const std::array<std::string_view, 5> built_in = {"pi", "scene_index", "frame_index",
                                                           "copy_index", "copies"};
  if (std::find(built_in.begin(), built_in.end(), name) != built_in.end()) {
    errors.add(place, "'" + name + "' is built in: a variable needs another name");
  } else if (scope.symbols.contains(name)) {
    errors.add(place, "the name '" + name + "' is taken by another variable");
  }
}

VariableBlock::Variable VariableBlock::compile_variable(const VariableConfig& config,
                                                        const std::string& prefix, Level level,
                                                        const CompileScope& scope,
                                                        Diagnostics& errors) {
  const std::string name = prefix + config.name;
  Variable variable;
  variable.graph_key = graph_key(prefix, config.name);
  variable.place = config.place;
  if (const auto* text = std::get_if<NameSource>(&config.source)) {
    variable.type.type = ValueType::kText;
    variable.source = NameDraw::compile(*text, scope, name, level, errors);
    return variable;
  }
  if (const auto* color = std::get_if<ColorSource>(&config.source)) {
    variable.type.type = ValueType::kVector;
    variable.source = ColorDraw::compile(*color, scope, name, level, errors);
    return variable;
  }
  const auto* number = std::get_if<NumberSource>(&config.source);
  if (number != nullptr && !is_vector_formula(*number, scope)) {
    const NumberDraw draw = NumberDraw::compile_any(*number, scope, name, level, errors);
    variable.type.dimension = draw.dimension();
    variable.source = draw;
    return variable;
  }
  VectorSource source;
  if (number != nullptr) {
    source.formula = *number;
  } else {
    source = std::get<VectorSource>(config.source);
  }
  const VectorDraw draw = VectorDraw::compile_any(source, scope, name, level, errors);
  variable.type = {ValueType::kVector, draw.dimension()};
  variable.source = draw;
  return variable;
}

VariableBlock VariableBlock::compile(const std::vector<VariableConfig>& variables,
                                     const std::string& prefix, Level level, VariableTable& table,
                                     CompileScope& scope, Diagnostics& errors) {
  VariableBlock block;
  block.per_copy_ = scope.copies;
  for (const VariableConfig& variable : variables) {
    refuse_taken_name(variable.name, variable.place, scope, errors);
    const bool is_name = std::holds_alternative<NameSource>(variable.source);
    const FormulaType type{is_name ? ValueType::kText : ValueType::kNumber, {}};
    scope.symbols[variable.name] = {type, is_name ? table.add_text() : table.add_numbers()};
  }
  const Order order(variables, errors);
  for (const std::size_t i : order.sorted()) {
    Variable variable = compile_variable(variables[i], prefix, level, scope, errors);
    // Only now its type is known; those that refer to it come later.
    Symbol& symbol = scope.symbols[variables[i].name];
    symbol.type = variable.type;
    variable.slot = symbol.slot;
    GraphVariable known{variable.type, block.per_copy_, table.graph_variables.size()};
    const auto entry = table.graph_variables.try_emplace(variable.graph_key, known).first;
    variable.graph_index = entry->second.index;
    block.variables_.push_back(std::move(variable));
  }
  return block;
}

bool VariableBlock::take_given(const Variable& variable, EvaluationContext& context) {
  if (context.given == nullptr) return false;
  const GivenValues& given = (*context.given)[variable.graph_index];
  const bool is_name = variable.type.type == ValueType::kText;
  const std::size_t count = is_name ? given.names.size() : given.numbers.size();
  if (count == 0) return false;
  const std::size_t index = given.per_copy ? context.ordinal : 0;
  if (index >= count) {
    context.report(variable.place,
                   fmt::format("the graph gives '{}' a list of {}, but there are more copies{}",
                               variable.graph_key, count,
                               count == 1 ? "; for all of them, give the value without []" : ""));
  } else if (is_name) {
    context.values.texts[variable.slot] = given.names[index];
  } else {
    std::copy_n(given.numbers[index].begin(), 3, &context.values.numbers[variable.slot]);
  }
  return true;
}

void VariableBlock::evaluate(const Variable& variable, EvaluationContext& context) {
  if (take_given(variable, context)) return;
  if (const auto* name = std::get_if<NameDraw>(&variable.source)) {
    context.values.texts[variable.slot] = name->evaluate(context);
    return;
  }
  double* const numbers = &context.values.numbers[variable.slot];
  if (const auto* number = std::get_if<NumberDraw>(&variable.source)) {
    *numbers = number->evaluate(context);
  } else if (const auto* color = std::get_if<ColorDraw>(&variable.source)) {
    const Rgb value = color->evaluate(context);
    std::copy(value.begin(), value.end(), numbers);
  } else {
    const Eigen::Vector3d value = std::get<VectorDraw>(variable.source).evaluate(context);
    std::copy_n(value.data(), 3, numbers);
  }
}

void VariableBlock::evaluate(EvaluationContext& context) const {
  for (const Variable& variable : variables_) {
    evaluate(variable, context);
    if (context.graph == nullptr) continue;
    Json value;
    if (variable.type.type == ValueType::kText) {
      value = context.values.texts[variable.slot];
    } else if (variable.type.type == ValueType::kVector) {
      const double* const numbers = &context.values.numbers[variable.slot];
      value = {numbers[0], numbers[1], numbers[2]};
    } else {
      value = context.values.numbers[variable.slot];
    }
    Json& entry = (*context.graph)[variable.graph_key];
    if (per_copy_) {
      entry.push_back(std::move(value));
    } else {
      entry = std::move(value);
    }
  }
}

}  // namespace seedframe
