// From the tree of a formula to a program.
#pragma once

#include "base/error.h"
#include "formula/formula_program.h"
#include "formula/formula_syntax.h"

namespace seedframe {

/// Errors (kInput) say what is wrong without the formula's text: an unknown name (with "did you
/// mean"), types or units that do not go together.
Result<FormulaProgram> compile_formula(const FormulaNode& root, const Scope& scope);

}  // namespace seedframe
