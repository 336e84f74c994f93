#include "formula/formula.h"

#include <set>

#include "formula/formula_compiler.h"
#include "formula/formula_program.h"
#include "formula/formula_syntax.h"

namespace seedframe {
namespace {

void collect_names(const FormulaNode& node, std::set<std::string>& names) {
  if (node.kind == FormulaNode::Kind::kName) names.insert(node.text);
  for (const FormulaNode& child : node.children) collect_names(child, names);
}

}  // namespace

Symbol number_symbol(std::size_t slot, Dimension dimension) {
  return {{ValueType::kNumber, dimension}, slot};
}

CompiledFormula::CompiledFormula(std::unique_ptr<FormulaProgram> program)
    : program_(std::move(program)) {}
CompiledFormula::~CompiledFormula() = default;
CompiledFormula::CompiledFormula(CompiledFormula&&) noexcept = default;
CompiledFormula& CompiledFormula::operator=(CompiledFormula&&) noexcept = default;

Result<CompiledFormula> CompiledFormula::compile(const std::string& text, const Scope& scope) {
  const Result<FormulaNode> root = parse_formula(text);
  if (!root) return forward_error(root);
  Result<FormulaProgram> program = compile_formula(*root, scope);
  if (!program) return fail(ErrorKind::kInput, "'{}': {}", text, program.error().message);
  return CompiledFormula(std::make_unique<FormulaProgram>(std::move(*program)));
}

FormulaType CompiledFormula::type() const { return program_->type(); }

double CompiledFormula::number(const VariableValues& values) const {
  return program_->evaluate(values)[0];
}

Eigen::Vector3d CompiledFormula::vector(const VariableValues& values) const {
  const FormulaValue value = program_->evaluate(values);
  return {value[0], value[1], value[2]};
}

std::vector<std::string> variables_in_formula(const std::string& text) {
  const Result<FormulaNode> root = parse_formula(text);
  std::set<std::string> names;
  if (root) collect_names(*root, names);
  names.erase("pi");
  return {names.begin(), names.end()};
}

}  // namespace seedframe
