#include "scene/variables.h"

#include <algorithm>
#include <map>

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
  for (const NameSource::Option& option : std::get<NameSource>(variable.source).options) {
    collect_references(option.weight, names);
    for (std::size_t open = option.text.find("${"); open != std::string::npos;
         open = option.text.find("${", open + 2)) {
      const std::size_t close = option.text.find('}', open);
      if (close != std::string::npos)
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

  void visit(std::size_t index) {
    if (states_[index] == State::kDone) return;
    if (states_[index] == State::kOpen) {
      report_cycle(index);
      return;
    }
    states_[index] = State::kOpen;
    trail_.push_back(index);
    for (const std::string& name : references(variables_[index])) {
      const auto found = indices_.find(name);
      if (found != indices_.end()) visit(found->second);
    }
    trail_.pop_back();
    states_[index] = State::kDone;
    sorted_.push_back(index);
  }

  void report_cycle(std::size_t index) {
    const auto start = std::find(trail_.begin(), trail_.end(), index);
    std::string cycle;
    for (auto i = start; i != trail_.end(); ++i) cycle += variables_[*i].name + " → ";
    errors_.add(variables_[index].place, "these variables refer to each other in a circle: " +
                                             cycle + variables_[index].name);
  }

  const std::vector<VariableConfig>& variables_;
  Diagnostics& errors_;
  std::vector<State> states_;
  std::map<std::string, std::size_t> indices_;
  std::vector<std::size_t> trail_;
  std::vector<std::size_t> sorted_;
};

}  // namespace

VariableBlock VariableBlock::compile(const std::vector<VariableConfig>& variables,
                                     const std::string& prefix, Level level, VariableValues& values,
                                     CompileScope& scope, Diagnostics& errors) {
  VariableBlock block;
  std::vector<Variable> unordered(variables.size());
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const VariableConfig& variable = variables[i];
    if (scope.numbers.contains(variable.name) || scope.names.contains(variable.name)) {
      errors.add(variable.place, "the name '" + variable.name + "' is taken by another variable");
    }
    if (std::holds_alternative<NumberSource>(variable.source)) {
      unordered[i].number = values.number();
      scope.numbers[variable.name] = unordered[i].number;
    } else {
      unordered[i].name = values.name();
      scope.names[variable.name] = unordered[i].name;
    }
  }
  const Order order(variables, errors);
  for (const std::size_t i : order.sorted()) {
    const std::string name = prefix + variables[i].name;
    if (const NumberSource* number = std::get_if<NumberSource>(&variables[i].source)) {
      unordered[i].source = NumberDraw::compile(*number, scope, name, level, errors);
    } else {
      unordered[i].source =
          NameDraw::compile(std::get<NameSource>(variables[i].source), scope, name, level, errors);
    }
    block.variables_.push_back(unordered[i]);
  }
  return block;
}

void VariableBlock::evaluate(EvaluationContext& context) const {
  for (const Variable& variable : variables_) {
    if (variable.number != nullptr) {
      *variable.number = std::get<NumberDraw>(variable.source).evaluate(context);
    } else {
      *variable.name = std::get<NameDraw>(variable.source).evaluate(context);
    }
  }
}

}  // namespace seedframe
