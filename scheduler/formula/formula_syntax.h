// Text of a formula to a tree; knows no types and no variables.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

struct FormulaNode {
  enum class Kind {
    kNumber,     ///< value, and in text its unit or nothing
    kText,       ///< a text in quotes
    kName,       ///< a variable or constant
    kCall,       ///< text(children)
    kOperator,   ///< text is + - * / < <= > >= == != && || with two children, or - + ! with one
    kCondition,  ///< children: condition, then, else
    kVector,     ///< [x, y, z]
    kMember,     ///< children[0].text, or children[0][number]
  };
  Kind kind = Kind::kNumber;
  std::string text;
  double value = 0.0;
  std::vector<FormulaNode> children;
};

/// Errors name the character at which no sense can be made, counted from 1.
Result<FormulaNode> parse_formula(const std::string& text);

}  // namespace seedframe
