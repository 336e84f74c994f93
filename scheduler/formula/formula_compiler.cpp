#include "formula/formula_compiler.h"

#include <map>

#include "base/nearest_name.h"
#include "base/portable_math.h"

namespace seedframe {
namespace {

bool is_zero(const FormulaNode& node) {
  return node.kind == FormulaNode::Kind::kNumber && node.text.empty() && node.value == 0.0;
}

const char* name_of(ValueType type) {
  switch (type) {
    case ValueType::kNumber:
      return "a number";
    case ValueType::kVector:
      return "a vector";
    case ValueType::kText:
      return "a text";
  }
  return "";
}

/// Checks types and units while it turns the tree into operations.
class Builder {
 public:
  Builder(const Scope& scope, FormulaProgram& program) : scope_(scope), program_(program) {}

  /// The index of the operation; an error once stops everything.
  std::size_t build(const FormulaNode& node) {
    if (!error_.empty()) return 0;
    switch (node.kind) {
      case FormulaNode::Kind::kNumber:
        return number(node);
      case FormulaNode::Kind::kText:
        refuse("a text can only be compared, with == or !=");
        return 0;
      case FormulaNode::Kind::kName:
        return name(node);
      case FormulaNode::Kind::kCall:
        return call(node);
      case FormulaNode::Kind::kOperator:
        return node.children.size() == 1 ? unary(node) : binary(node);
      case FormulaNode::Kind::kCondition:
        return condition(node);
      case FormulaNode::Kind::kVector:
        return vector(node);
      case FormulaNode::Kind::kMember:
        return member(node);
    }
    return 0;
  }

  const std::string& error() const { return error_; }

 private:
  using Code = FormulaProgram::Code;
  using Operation = FormulaProgram::Operation;

  void refuse(const std::string& reason) {
    if (error_.empty()) error_ = reason;
  }

  std::size_t add(Operation operation) {
    program_.operations.push_back(std::move(operation));
    return program_.operations.size() - 1;
  }
  std::size_t add(Code code, FormulaType type, std::array<std::size_t, 3> inputs = {}) {
    Operation operation;
    operation.code = code;
    operation.type = type;
    operation.inputs = inputs;
    return add(std::move(operation));
  }
  const FormulaType& type_of(std::size_t index) const { return program_.operations[index].type; }

  /// A vector in text says so; a number says its unit.
  std::string describe(const FormulaType& type) const {
    if (type.type == ValueType::kNumber && !type.dimension.is_plain()) {
      return "a number in " + type.dimension.text();
    }
    return name_of(type.type);
  }

  std::size_t number(const FormulaNode& node) {
    Operation operation;
    operation.constant = node.value;
    if (!node.text.empty()) {
      const auto unit = find_unit(node.text);
      if (!unit) {
        refuse("there is no unit '" + node.text +
               "' (there are: deg, rad, m, cm, mm, km, W, lm, K)");
        return 0;
      }
      operation.constant *= unit->base_units;
      operation.type.dimension = unit->dimension;
    }
    return add(std::move(operation));
  }

  std::size_t name(const FormulaNode& node) {
    const auto found = scope_.find(node.text);
    if (found != scope_.end()) {
      const Symbol& symbol = found->second;
      if (symbol.type.type == ValueType::kText) {
        refuse("'" + node.text + "' is a name: it can only be compared, with == or !=");
        return 0;
      }
      Operation operation;
      operation.code = symbol.type.type == ValueType::kNumber ? Code::kNumber : Code::kVector;
      operation.type = symbol.type;
      operation.slot = symbol.slot;
      return add(std::move(operation));
    }
    if (node.text == "pi") {
      Operation operation;
      operation.constant = portable::kPi;
      return add(std::move(operation));
    }
    std::vector<std::string> known = formula_function_names();
    for (const auto& entry : scope_) known.push_back(entry.first);
    const std::string nearest = nearest_name(node.text, known);
    refuse("'" + node.text + "' is neither a number, a variable that is known here nor a function" +
           (nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
    return 0;
  }

  std::size_t call(const FormulaNode& node) {
    const FormulaFunction* function = find_formula_function(node.text);
    if (function == nullptr) {
      refuse("there is no function '" + node.text + "'" +
             did_you_mean(node.text, formula_function_names()));
      return 0;
    }
    if (node.children.size() < function->least_arguments ||
        node.children.size() > function->most_arguments) {
      refuse(fmt::format("{} needs {} argument{}, found {}", node.text, function->least_arguments,
                         function->least_arguments == 1 ? "" : "s", node.children.size()));
      return 0;
    }
    Operation operation;
    operation.code = Code::kCall;
    operation.function = function;
    for (const FormulaNode& child : node.children) {
      operation.arguments.push_back(build(child));
      if (!error_.empty()) return 0;
      operation.argument_types.push_back(type_of(operation.arguments.back()));
    }
    adopt_units_for_zeros(node, operation.argument_types);
    const Result<FormulaType> type = function->result(operation.argument_types);
    if (!type) {
      refuse(node.text + " " + type.error().message);
      return 0;
    }
    operation.type = *type;
    return add(std::move(operation));
  }

  /// max(0, length): a literal 0 is 0 of anything.
  static void adopt_units_for_zeros(const FormulaNode& node, std::vector<FormulaType>& types) {
    FormulaType other;
    for (const FormulaType& type : types) {
      if (!type.dimension.is_plain()) other = type;
    }
    for (std::size_t i = 0; i < types.size(); ++i) {
      if (is_zero(node.children[i])) types[i].dimension = other.dimension;
    }
  }

  std::size_t unary(const FormulaNode& node) {
    const std::size_t input = build(node.children[0]);
    if (!error_.empty() || node.text == "+") return input;
    if (node.text == "-") return add(Code::kNegate, type_of(input), {input});
    if (type_of(input) != FormulaType{}) {
      refuse("'!' needs a plain number, found " + describe(type_of(input)));
      return 0;
    }
    return add(Code::kNot, {}, {input});
  }

  std::size_t binary(const FormulaNode& node) {
    if ((node.text == "==" || node.text == "!=") &&
        (is_text(node.children[0]) || is_text(node.children[1]))) {
      return compare_texts(node);
    }
    const std::size_t a = build(node.children[0]);
    const std::size_t b = build(node.children[1]);
    if (!error_.empty()) return 0;
    FormulaType left = type_of(a);
    FormulaType right = type_of(b);
    if (is_zero(node.children[0])) left.dimension = right.dimension;
    if (is_zero(node.children[1])) right.dimension = left.dimension;
    if (node.text == "*") return multiply(a, b);
    if (node.text == "/") {
      if (right.type == ValueType::kNumber) {
        return add(Code::kDivide, {left.type, type_of(a).dimension / type_of(b).dimension}, {a, b});
      }
      refuse("a vector cannot divide");
      return 0;
    }
    if (node.text == "+" || node.text == "-") {
      if (left == right) return add(node.text == "+" ? Code::kAdd : Code::kSubtract, left, {a, b});
      refuse_pair(node.text, left, right);
      return 0;
    }
    if (left != right || left.type != ValueType::kNumber) {
      refuse_pair(node.text, left, right);
      return 0;
    }
    if (node.text == "&&") return add(Code::kAnd, {}, {a, b});
    if (node.text == "||") return add(Code::kOr, {}, {a, b});
    if (node.text == "==") return add(Code::kEqual, {}, {a, b});
    if (node.text == "!=") return add(Code::kNotEqual, {}, {a, b});
    if (node.text == "<") return add(Code::kLess, {}, {a, b});
    if (node.text == "<=") return add(Code::kLessEqual, {}, {a, b});
    if (node.text == ">") return add(Code::kLess, {}, {b, a});
    return add(Code::kLessEqual, {}, {b, a});
  }

  std::size_t multiply(std::size_t a, std::size_t b) {
    const FormulaType& left = type_of(a);
    const FormulaType& right = type_of(b);
    const Dimension dimension = left.dimension * right.dimension;
    if (left.type == right.type) return add(Code::kMultiply, {left.type, dimension}, {a, b});
    if (left.type == ValueType::kVector) {
      return add(Code::kScale, {ValueType::kVector, dimension}, {a, b});
    }
    return add(Code::kScale, {ValueType::kVector, dimension}, {b, a});
  }

  void refuse_pair(const std::string& symbol, const FormulaType& left, const FormulaType& right) {
    refuse("'" + symbol + "' between " + describe(left) + " and " + describe(right));
  }

  bool is_text(const FormulaNode& node) const {
    if (node.kind == FormulaNode::Kind::kText) return true;
    if (node.kind != FormulaNode::Kind::kName) return false;
    const auto found = scope_.find(node.text);
    return found != scope_.end() && found->second.type.type == ValueType::kText;
  }

  std::size_t compare_texts(const FormulaNode& node) {
    Operation operation;
    operation.code = node.text == "==" ? Code::kTextEqual : Code::kTextNotEqual;
    for (std::size_t side = 0; side < 2; ++side) {
      const FormulaNode& child = node.children[side];
      if (!is_text(child)) {
        refuse("a text can only be compared with a text or a name");
        return 0;
      }
      if (child.kind == FormulaNode::Kind::kText) {
        operation.texts[side].literal = child.text;
      } else {
        operation.texts[side].slot = scope_.at(child.text).slot;
      }
    }
    return add(std::move(operation));
  }

  std::size_t condition(const FormulaNode& node) {
    std::array<std::size_t, 3> inputs{};
    for (std::size_t i = 0; i < 3; ++i) inputs[i] = build(node.children[i]);
    if (!error_.empty()) return 0;
    if (type_of(inputs[0]) != FormulaType{}) {
      refuse("what stands before '?' must be a plain number or a comparison");
      return 0;
    }
    FormulaType first = type_of(inputs[1]);
    FormulaType second = type_of(inputs[2]);
    if (is_zero(node.children[1])) first.dimension = second.dimension;
    if (is_zero(node.children[2])) second.dimension = first.dimension;
    if (first == second) return add(Code::kCondition, first, inputs);
    refuse("the two results of '?' must be of the same type, found " + describe(first) + " and " +
           describe(second));
    return 0;
  }

  std::size_t vector(const FormulaNode& node) {
    if (node.children.size() != 3) {
      refuse(fmt::format("a vector has three components, found {}", node.children.size()));
      return 0;
    }
    std::array<std::size_t, 3> inputs{};
    std::vector<FormulaType> types;
    for (std::size_t i = 0; i < 3; ++i) {
      inputs[i] = build(node.children[i]);
      if (!error_.empty()) return 0;
      types.push_back(type_of(inputs[i]));
    }
    adopt_units_for_zeros(node, types);
    for (const FormulaType& type : types) {
      if (type.type != ValueType::kNumber || type != types[0]) {
        refuse("the components of a vector must be numbers of one unit");
        return 0;
      }
    }
    return add(Code::kMakeVector, {ValueType::kVector, types[0].dimension}, inputs);
  }

  std::size_t member(const FormulaNode& node) {
    static const std::map<std::string, std::size_t> components = {
        {"x", 0}, {"y", 1}, {"z", 2}, {"r", 0}, {"g", 1}, {"b", 2}, {"0", 0}, {"1", 1}, {"2", 2}};
    const std::size_t input = build(node.children[0]);
    if (!error_.empty()) return 0;
    const auto found = components.find(node.text);
    if (found == components.end() || type_of(input).type != ValueType::kVector) {
      refuse(found == components.end()
                 ? "'" + node.text + "' is not a component of a vector (there are: x, y, z)"
                 : "only a vector has a component " + node.text);
      return 0;
    }
    Operation operation;
    operation.code = Code::kComponent;
    operation.type = {ValueType::kNumber, type_of(input).dimension};
    operation.inputs = {input};
    operation.component = found->second;
    return add(std::move(operation));
  }

  const Scope& scope_;
  FormulaProgram& program_;
  std::string error_;
};

}  // namespace

Result<FormulaProgram> compile_formula(const FormulaNode& root, const Scope& scope) {
  FormulaProgram program;
  Builder builder(scope, program);
  builder.build(root);
  if (!builder.error().empty()) return fail(ErrorKind::kInput, "{}", builder.error());
  return program;
}

}  // namespace seedframe
