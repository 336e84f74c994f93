#include "scene/formula.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::HasSubstr;

double value_of(const std::string& text, const Scope& scope = {}) {
  const auto formula = CompiledFormula::compile(text, scope);
  EXPECT_TRUE(formula) << text << ": " << formula.error().message;
  return formula ? formula->number() : NAN;
}

std::string error_of(const std::string& text, const Scope& scope = {}) {
  const auto formula = CompiledFormula::compile(text, scope);
  return formula ? "(no error)" : formula.error().message;
}

TEST(Formula, Computes) {
  EXPECT_DOUBLE_EQ(value_of("1 + 2 * 3"), 7.0);
  EXPECT_DOUBLE_EQ(value_of("-(4 - 1)"), -3.0);
  EXPECT_DOUBLE_EQ(value_of("pow(2, 10)"), 1024.0);
  EXPECT_DOUBLE_EQ(value_of("min(3, 1, 2) + max(1, 5)"), 6.0);
  EXPECT_DOUBLE_EQ(value_of("mod(-1, 3)"), 2.0);
  EXPECT_DOUBLE_EQ(value_of("clamp(7, 0, 5)"), 5.0);
  EXPECT_DOUBLE_EQ(value_of("round(2.5)"), 3.0);
  EXPECT_DOUBLE_EQ(value_of("3 > 2 ? 10 : 20"), 10.0);
  EXPECT_DOUBLE_EQ(value_of("1 == 1 && 2 != 3"), 1.0);
  EXPECT_NEAR(value_of("sin(rad(30))"), 0.5, 1e-15);
  EXPECT_NEAR(value_of("deg(pi)"), 180.0, 1e-12);
}

TEST(Formula, ReadsVariablesWhenEvaluated) {
  double x = 2.0;
  const auto formula = CompiledFormula::compile("x * x", {{"x", number_symbol(&x)}});
  ASSERT_TRUE(formula);
  EXPECT_DOUBLE_EQ(formula->number(), 4.0);
  x = 3.0;
  EXPECT_DOUBLE_EQ(formula->number(), 9.0);
}

TEST(Formula, UnknownNamesGetASuggestion) {
  const double radius = 1.0;
  EXPECT_THAT(error_of("2 * raduis", {{"radius", number_symbol(&radius)}}), HasSubstr("did you mean 'radius'?"));
  EXPECT_THAT(error_of("sqr(2)"), HasSubstr("did you mean 'sqrt'?"));
}

TEST(Formula, RefusesWhatItDoesNotOffer) {
  double x = 1.0;
  const Scope scope = {{"x", number_symbol(&x)}};
  EXPECT_THAT(error_of("x ^ 2", scope), HasSubstr("pow(x, y)"));
  EXPECT_THAT(error_of("x = 5", scope), HasSubstr("=="));
  EXPECT_DOUBLE_EQ(x, 1.0);
  EXPECT_THAT(error_of("1, 2"), HasSubstr("one result"));
  EXPECT_NE(error_of("1 +"), "(no error)");
  EXPECT_NE(error_of("(1"), "(no error)");
  EXPECT_NE(error_of(""), "(no error)");
  EXPECT_THAT(error_of(std::string(5000, '1')), HasSubstr("2000 characters"));
}

TEST(Formula, ListsItsVariables) {
  EXPECT_THAT(variables_in_formula("a + sin(b) * a"), ::testing::UnorderedElementsAre("a", "b"));
}

}  // namespace
}  // namespace seedframe
