// Whatever text stands for a formula: it is compiled or refused, and nothing else happens.

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formula/formula.h"

namespace seedframe {
namespace {

constexpr int kTexts = 10'000;

/// The same numbers on every machine, which the standard's distributions do not promise.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  std::size_t below(std::size_t bound) { return engine_() % bound; }

 private:
  std::mt19937 engine_;
};

struct Variables {
  VariableValues values = {{2.0, 1.0, 2.0, 3.0}, {"gear"}};
  Scope scope = {{"a", number_symbol(0)},
                 {"d", number_symbol(0, kLength)},
                 {"v", {{ValueType::kVector, {}}, 1}},
                 {"kind", {{ValueType::kText, {}}, 0}}};
};

/// True if it was compiled; then it is evaluated as well.
bool try_formula(const std::string& text) {
  static const Variables variables;
  variables_in_formula(text);
  const auto formula = CompiledFormula::compile(text, variables.scope);
  if (formula) {
    formula->vector(variables.values);
    return true;
  }
  const std::string& message = formula.error().message;
  EXPECT_FALSE(message.empty());
  EXPECT_EQ(message.find("std::"), std::string::npos) << message;
  EXPECT_EQ(formula.error().kind, ErrorKind::kInput);
  return false;
}

TEST(FormulaGarbage, RandomBytesAreRefused) {
  Dice dice(1);
  int compiled = 0;
  for (int i = 0; i < kTexts; ++i) {
    std::string text(dice.below(40), '\0');
    for (char& c : text) c = static_cast<char>(dice.below(256));
    compiled += try_formula(text) ? 1 : 0;
  }
  EXPECT_LT(compiled, kTexts / 100);
}

TEST(FormulaGarbage, RandomTokensAreCompiledOrRefused) {
  const std::vector<std::string> tokens = {
      "1",    "2.5",  "0",     "1e300", "3m",   "90deg", "'gear'", "a",  "d",  "v",  "kind",
      "pi",   "+",    "-",     "*",     "/",    "<",     "<=",     "==", "!=", "&&", "||",
      "!",    "?",    ":",     "(",     ")",    "[",     "]",      ",",  ".",  "x",  "sin(",
      "dot(", "max(", "sqrt(", "\t",    "hsv(", "'",     "cm",     "^",  "=",  "é"};
  Dice dice(2);
  int compiled = 0;
  for (int i = 0; i < kTexts; ++i) {
    std::string text;
    const std::size_t length = 1 + dice.below(9);
    for (std::size_t k = 0; k < length; ++k) text += tokens[dice.below(tokens.size())] + " ";
    compiled += try_formula(text) ? 1 : 0;
  }
  // Both happen, or the test looks at one half only.
  EXPECT_GT(compiled, kTexts / 50);
  EXPECT_LT(compiled, kTexts * 9 / 10);
}

TEST(FormulaGarbage, DamagedFormulasAreCompiledOrRefused) {
  const std::string whole =
      "kind == 'gear' ? clamp(a * sin(30deg) + v[1], 0, max(1, 2, 3)) : dot(v, rotate_z([1, 2, "
      "3], 90deg)) * (d / 2cm)";
  ASSERT_TRUE(try_formula(whole));
  Dice dice(3);
  for (int i = 0; i < kTexts; ++i) {
    std::string text = whole;
    const std::size_t changes = 1 + dice.below(3);
    for (std::size_t change = 0; change < changes && !text.empty(); ++change) {
      const std::size_t at = dice.below(text.size());
      switch (dice.below(4)) {
        case 0:
          text[at] = static_cast<char>(dice.below(256));
          break;
        case 1:
          text.erase(at, 1 + dice.below(4));
          break;
        case 2:
          text.insert(at, text.substr(dice.below(text.size()), 1 + dice.below(12)));
          break;
        default:
          text.resize(at + 1);
      }
    }
    try_formula(text);
  }
}

TEST(FormulaGarbage, EveryBeginningOfAFormulaIsCompiledOrRefused) {
  const std::string whole = "kind == 'gear' ? [a, v.x, 2m / d][2] : max(0, sin(-1.5e-3rad))";
  ASSERT_TRUE(try_formula(whole));
  int compiled = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    compiled += try_formula(whole.substr(0, length)) ? 1 : 0;
  }
  EXPECT_EQ(compiled, 2);  // the comparison by itself, with and without the blank behind it
}

}  // namespace
}  // namespace seedframe
