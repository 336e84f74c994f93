#include "formula/formula.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/portable_math.h"
#include "formula/formula_functions.h"
#include "tests/fixtures/message_of.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

double value_of(const std::string& text, const Scope& scope = {},
                const VariableValues& values = {}) {
  const auto formula = CompiledFormula::compile(text, scope);
  EXPECT_TRUE(formula) << text << ": " << formula.error().message;
  return formula ? formula->number(values) : NAN;
}

Eigen::Vector3d vector_of(const std::string& text, const Scope& scope = {}) {
  const auto formula = CompiledFormula::compile(text, scope);
  EXPECT_TRUE(formula) << text << ": " << formula.error().message;
  if (!formula) return Eigen::Vector3d::Constant(NAN);
  EXPECT_EQ(formula->type().type, ValueType::kVector) << text;
  return formula->vector({});
}

Dimension dimension_of(const std::string& text, const Scope& scope = {}) {
  const auto formula = CompiledFormula::compile(text, scope);
  EXPECT_TRUE(formula) << text << ": " << formula.error().message;
  return formula ? formula->type().dimension : Dimension{};
}

std::string formula_error(const std::string& text, const Scope& scope = {}) {
  const auto formula = CompiledFormula::compile(text, scope);
  return message_of(formula);
}

void expect_vector(const std::string& text, const Eigen::Vector3d& expected,
                   const Scope& scope = {}) {
  const Eigen::Vector3d found = vector_of(text, scope);
  EXPECT_TRUE((found - expected).cwiseAbs().maxCoeff() < 1e-14)
      << text << " is " << found.transpose();
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(Formula, Computes) {
  EXPECT_DOUBLE_EQ(value_of("1 + 2 * 3"), 7.0);
  EXPECT_DOUBLE_EQ(value_of("8 - 2 - 1"), 5.0);
  EXPECT_DOUBLE_EQ(value_of("8 / 2 / 2"), 2.0);
  EXPECT_DOUBLE_EQ(value_of("-(4 - 1)"), -3.0);
  EXPECT_DOUBLE_EQ(value_of("- -2 * +3"), 6.0);
  EXPECT_DOUBLE_EQ(value_of(".5 + 1.5e1"), 15.5);
  EXPECT_DOUBLE_EQ(value_of("pow(2, 10)"), 1024.0);
  EXPECT_DOUBLE_EQ(value_of("min(3, 1, 2) + max(1, 5)"), 6.0);
  EXPECT_DOUBLE_EQ(value_of("mod(-1, 3)"), 2.0);
  EXPECT_DOUBLE_EQ(value_of("clamp(7, 0, 5)"), 5.0);
  EXPECT_DOUBLE_EQ(value_of("clamp(-7, 0, 5)"), 0.0);
  EXPECT_DOUBLE_EQ(value_of("round(2.5)"), 3.0);
  EXPECT_DOUBLE_EQ(value_of("floor(-0.5) + ceil(0.5)"), 0.0);
  EXPECT_DOUBLE_EQ(value_of("log10(1000) + ln(exp(2))"), 5.0);
  EXPECT_NEAR(value_of("sin(rad(30))"), 0.5, 1e-15);
  EXPECT_NEAR(value_of("deg(pi)"), 180.0, 1e-12);
  EXPECT_NEAR(value_of("atan2(1, -1)"), 0.75 * portable::kPi, 1e-15);
}

TEST(Formula, ComparisonsAndLogicAreOneOrZero) {
  EXPECT_EQ(value_of("3 > 2"), 1.0);
  EXPECT_EQ(value_of("2 >= 2"), 1.0);
  EXPECT_EQ(value_of("2 < 2"), 0.0);
  EXPECT_EQ(value_of("2 <= 1"), 0.0);
  EXPECT_EQ(value_of("1 == 1 && 2 != 3"), 1.0);
  EXPECT_EQ(value_of("0 || 7"), 1.0);
  EXPECT_EQ(value_of("!7 + !0"), 1.0);
  EXPECT_EQ(value_of("1 || 0 && 0"), 1.0);  // && binds closer
}

TEST(Formula, ReadsVariablesWhenEvaluated) {
  const auto formula = CompiledFormula::compile("x * x", {{"x", number_symbol(1)}});
  ASSERT_TRUE(formula);
  EXPECT_DOUBLE_EQ(formula->number({{7.0, 2.0}, {}}), 4.0);
  EXPECT_DOUBLE_EQ(formula->number({{7.0, 3.0}, {}}), 9.0);
}

TEST(Formula, AConditionComputesOnlyTheBranchThatItTakes) {
  const Scope scope = {{"x", number_symbol(0)}};
  const auto formula = CompiledFormula::compile("x == 0 ? 5 : 10 / x", scope);
  ASSERT_TRUE(formula);
  EXPECT_EQ(formula->number({{0.0}, {}}), 5.0);
  EXPECT_EQ(formula->number({{4.0}, {}}), 2.5);
  EXPECT_EQ(value_of("1 ? 2 : sqrt(-1)"), 2.0);
  EXPECT_EQ(value_of("0 && 1 / 0 > 1 ? 1 : 2"), 2.0);
  EXPECT_EQ(value_of("0 ? 1 : 0 ? 2 : 3"), 3.0);  // the second belongs to the first's else
}

TEST(Formula, UnitsAreConvertedToTheirBase) {
  EXPECT_DOUBLE_EQ(value_of("25mm + 3cm"), 0.055);
  EXPECT_DOUBLE_EQ(value_of("1km - 1m"), 999.0);
  EXPECT_DOUBLE_EQ(value_of("2 km"), 2000.0);
  EXPECT_DOUBLE_EQ(value_of("1rad"), 180.0 / portable::kPi);
  EXPECT_EQ(dimension_of("1cm"), kLength);
  EXPECT_EQ(dimension_of("1rad"), kAngle);
  EXPECT_EQ(dimension_of("6500K"), kTemperature);
  EXPECT_EQ(dimension_of("40W"), kRadiantFlux);
  EXPECT_EQ(dimension_of("-(3lm)"), kLuminousFlux);
}

TEST(Formula, UnitsMultiplyAndDivide) {
  EXPECT_EQ(dimension_of("2m * 3m").text(), "m^2");
  EXPECT_EQ(dimension_of("800lm / 10W").text(), "lm/W");
  EXPECT_EQ(dimension_of("1 / 2m").text(), "1/m");
  EXPECT_TRUE(dimension_of("3m / 2cm").is_plain());
  EXPECT_DOUBLE_EQ(value_of("3m / 2cm"), 150.0);
  EXPECT_EQ(dimension_of("sqrt(4m * 9m)"), kLength);
  EXPECT_DOUBLE_EQ(value_of("sqrt(4m * 9m)"), 6.0);
  EXPECT_THAT(formula_error("sqrt(4m)"), HasSubstr("sqrt needs a number whose unit is a square"));
}

TEST(Formula, UnitsThatDoNotGoTogetherAreRefusedByName) {
  EXPECT_THAT(formula_error("30deg + 2m"),
              HasSubstr("'30deg + 2m': '+' between a number in deg and a number in m"));
  EXPECT_THAT(formula_error("1 - 2m"), HasSubstr("'-' between a number and a number in m"));
  EXPECT_THAT(formula_error("1m < 1m * 1m"),
              HasSubstr("'<' between a number in m and a number in m^2"));
  EXPECT_THAT(formula_error("max(1m, 2deg)"), HasSubstr("max needs numbers of one unit"));
  EXPECT_THAT(formula_error("exp(1m)"), HasSubstr("exp needs plain numbers"));
  EXPECT_THAT(formula_error("sin(1m)"), HasSubstr("sin needs an angle"));
  EXPECT_THAT(formula_error("1 ? 1m : 1W"), HasSubstr("found a number in m and a number in W"));
  EXPECT_THAT(formula_error("1m ? 1 : 2"), HasSubstr("before '?'"));
  EXPECT_THAT(formula_error("1m && 1"), HasSubstr("'&&' between"));
  EXPECT_THAT(formula_error("!1m"), HasSubstr("'!' needs a plain number, found a number in m"));
}

TEST(Formula, ZeroGoesWithEveryUnit) {
  EXPECT_EQ(dimension_of("0 + 2m"), kLength);
  EXPECT_EQ(dimension_of("max(0, 2m)"), kLength);
  EXPECT_EQ(dimension_of("1 ? 0 : 2deg"), kAngle);
  EXPECT_EQ(value_of("2m > 0"), 1.0);
  EXPECT_EQ(dimension_of("[0, 0, 2m]"), kLength);
  EXPECT_NE(formula_error("1 + 2m"), "(no error)");
}

TEST(Formula, AHighPowerOfAUnitIsNoPlainNumber) {
  // As many as make an exponent of eight bits come round to 0.
  EXPECT_FALSE(dimension_of("1m" + repeated("*1m", 255)).is_plain());
  EXPECT_FALSE(dimension_of("1/1m" + repeated("/1m", 255)).is_plain());
}

TEST(Formula, PlainAnglesAreRadiansInTrigonometry) {
  EXPECT_NEAR(value_of("sin(pi / 6)"), 0.5, 1e-15);
  EXPECT_NEAR(value_of("sin(30deg)"), 0.5, 1e-15);
  EXPECT_NEAR(value_of("cos(1rad)"), std::cos(1.0), 1e-15);
  EXPECT_NEAR(value_of("sin(30)"), std::sin(30.0), 1e-15);
  EXPECT_DOUBLE_EQ(value_of("deg(30deg)"), 30.0);
  expect_vector("rotate_z([1, 0, 0], 90deg)", {0, 1, 0});
  expect_vector("rotate_z([1, 0, 0], pi / 2)", {0, 1, 0});
}

TEST(Formula, UnknownUnitsAreListed) {
  EXPECT_THAT(formula_error("3ft"), HasSubstr("there is no unit 'ft' (there are: deg, rad, m, cm"));
  EXPECT_THAT(formula_error("2 m x"), HasSubstr("expected an operator, found 'x' (character 5)"));
  EXPECT_THAT(formula_error("0x10"), HasSubstr("no unit 'x10'"));
}

TEST(Formula, VectorsHaveMembersAndIndices) {
  const VariableValues values = {{1.0, 2.0, 3.0}, {}};
  const Scope scope = {{"v", {{ValueType::kVector, kLength}, 0}}};
  EXPECT_EQ(value_of("v.x + v.y * 10 + v.z * 100", scope, values), 321.0);
  EXPECT_EQ(value_of("v[0] - v[2]", scope, values), -2.0);
  EXPECT_EQ(value_of("[4, 5, 6].g", scope), 5.0);
  EXPECT_EQ(dimension_of("v.x", scope), kLength);
  EXPECT_THAT(formula_error("v.w", scope), HasSubstr("'w' is not a component of a vector"));
  EXPECT_THAT(formula_error("v[3]", scope), HasSubstr("'3' is not a component"));
  EXPECT_THAT(formula_error("v[x]", scope), HasSubstr("expected 0, 1 or 2 after '['"));
  EXPECT_THAT(formula_error("v.x.y", scope), HasSubstr("only a vector has a component y"));
}

TEST(Formula, VectorsComputeComponentByComponent) {
  expect_vector("[1, 2, 3] + [10, 20, 30]", {11, 22, 33});
  expect_vector("[1, 2, 3] * [10, 20, 30] - [1, 1, 1]", {9, 39, 89});
  expect_vector("2 * [1, 2, 3]", {2, 4, 6});
  expect_vector("-[1, 2, 3] / 2", {-0.5, -1, -1.5});
  expect_vector("1 ? [1, 2, 3] : [4, 5, 6]", {1, 2, 3});
  EXPECT_THAT(formula_error("[1, 2, 3] + 1"), HasSubstr("'+' between a vector and a number"));
  EXPECT_THAT(formula_error("1 / [1, 2, 3]"), HasSubstr("a vector cannot divide"));
  EXPECT_THAT(formula_error("[1, 2]"), HasSubstr("a vector has three components, found 2"));
  EXPECT_THAT(formula_error("[]"), HasSubstr("found 0"));
  EXPECT_THAT(formula_error("[1, 2m, 3]"), HasSubstr("numbers of one unit"));
  EXPECT_THAT(formula_error("[[1, 2, 3], 0, 0]"), HasSubstr("numbers of one unit"));
  EXPECT_THAT(formula_error("[1, 2, 3] < [1, 2, 4]"),
              HasSubstr("'<' between a vector and a vector"));
}

TEST(Formula, VectorFunctions) {
  EXPECT_EQ(value_of("dot([1, 2, 3], [4, 5, 6])"), 32.0);
  expect_vector("cross([1, 0, 0], [0, 1, 0])", {0, 0, 1});
  EXPECT_EQ(value_of("length([2m, 3m, 6m])"), 7.0);
  EXPECT_EQ(dimension_of("length([2m, 3m, 6m])"), kLength);
  expect_vector("normalize([0, 3m, 4m])", {0, 0.6, 0.8});
  EXPECT_TRUE(dimension_of("normalize([0, 3m, 4m])").is_plain());
  EXPECT_EQ(dimension_of("dot([1m, 0, 0], [1m, 0, 0])").text(), "m^2");
  expect_vector("rotate_x([0, 1, 0], 90deg)", {0, 0, 1});
  expect_vector("rotate_y([0, 0, 1], 90deg)", {1, 0, 0});
  expect_vector("rotate_z([0, 1, 5], 180deg)", {0, -1, 5});
  EXPECT_THAT(formula_error("length(3)"), HasSubstr("length needs a vector"));
  EXPECT_THAT(formula_error("dot([1, 2, 3], 1)"), HasSubstr("dot needs two vectors"));
  EXPECT_THAT(formula_error("rotate_x([1, 2, 3], 1m)"), HasSubstr("rotate_x needs a vector and"));
  EXPECT_THAT(formula_error("max([1, 2, 3], 1)"), HasSubstr("max needs numbers of one unit"));
}

TEST(Formula, ColorsAreVectors) {
  expect_vector("hsv(120, 1, 1)", {0, 1, 0});
  expect_vector("hsv(120deg, 1, 1)", {0, 1, 0});
  expect_vector("rgb(0.1, 0.2, 0.3) * 2", {0.2, 0.4, 0.6});
  EXPECT_EQ(vector_of("blackbody(3000)"), vector_of("blackbody(3000K)"));
  EXPECT_THAT(formula_error("blackbody(3m)"), HasSubstr("blackbody needs a temperature"));
}

TEST(Formula, NamesAndTextsCanBeComparedAndNothingElse) {
  const Scope scope = {{"kind", {{ValueType::kText, {}}, 0}}, {"x", number_symbol(0)}};
  const auto formula = CompiledFormula::compile("kind == 'gear' ? 2 : 3", scope);
  ASSERT_TRUE(formula);
  EXPECT_EQ(formula->number({{1.0}, {"gear"}}), 2.0);
  EXPECT_EQ(formula->number({{1.0}, {"washer"}}), 3.0);
  EXPECT_EQ(value_of("\"gear\" != kind", scope, {{1.0}, {"washer"}}), 1.0);
  EXPECT_EQ(value_of("'' == 'a'"), 0.0);
  EXPECT_THAT(formula_error("kind + 1", scope),
              HasSubstr("'kind' is a name: it can only be compared"));
  EXPECT_THAT(formula_error("'gear'"), HasSubstr("a text can only be compared"));
  EXPECT_THAT(formula_error("kind == x", scope), HasSubstr("compared with a text or a name"));
  EXPECT_THAT(formula_error("kind < 'b'", scope), HasSubstr("can only be compared, with == or !="));
  EXPECT_THAT(formula_error("kind == 'gear", scope), HasSubstr("must end with one (character 9)"));
}

TEST(Formula, UnknownNamesGetASuggestion) {
  EXPECT_THAT(formula_error("2 * raduis", {{"radius", number_symbol(0)}}),
              HasSubstr("did you mean 'radius'?"));
  EXPECT_THAT(formula_error("sqr(2)"), HasSubstr("did you mean 'sqrt'?"));
  EXPECT_THAT(formula_error("quux"), HasSubstr("'quux' is neither a number, a variable"));
}

TEST(Formula, ErrorsNameTheCharacter) {
  EXPECT_THAT(formula_error("1 + * 2"), HasSubstr("expected a value, found '*' (character 5)"));
  EXPECT_THAT(formula_error("1 2"), HasSubstr("expected an operator, found '2' (character 3)"));
  EXPECT_THAT(formula_error("(1"), HasSubstr("expected ')', but the formula ends (character 3)"));
  EXPECT_THAT(formula_error("1 ? 2"),
              HasSubstr("expected ':', but the formula ends (character 6)"));
  EXPECT_THAT(formula_error("max(1 2)"), HasSubstr("expected ')', found '2' (character 7)"));
  EXPECT_THAT(formula_error("1 +"),
              HasSubstr("expected a value, but the formula ends (character 4)"));
  EXPECT_THAT(formula_error(""), HasSubstr("but the formula ends (character 1)"));
  EXPECT_THAT(formula_error("1e999"), HasSubstr("too large or too small (character 1)"));
  EXPECT_THAT(formula_error("1, 2"), HasSubstr("one result (character 2)"));
}

TEST(Formula, ACharacterOfSeveralBytesIsNamedWhole) {
  EXPECT_THAT(formula_error("2 × 3"), HasSubstr("'×' has no meaning here (character 3)"));
  EXPECT_THAT(formula_error("2 \xF0\x9F\x98\x80"), HasSubstr("'\xF0\x9F\x98\x80' has no meaning"));
}

TEST(Formula, RefusesWhatItDoesNotOffer) {
  const Scope scope = {{"x", number_symbol(0)}};
  EXPECT_THAT(formula_error("x ^ 2", scope), HasSubstr("pow(x, y)"));
  EXPECT_THAT(formula_error("x = 5", scope), HasSubstr("=="));
  EXPECT_THAT(formula_error("pow(2)"), HasSubstr("pow needs 2 arguments, found 1"));
  EXPECT_THAT(formula_error("sin()"), HasSubstr("sin needs 1 argument, found 0"));
  EXPECT_THAT(formula_error("max(" + repeated("1,", 64) + "1)"), HasSubstr("found 65"));
  EXPECT_THAT(formula_error("x(1)", scope), HasSubstr("there is no function 'x'"));
  EXPECT_THAT(formula_error("sin + 1"), HasSubstr("'sin' is neither"));
}

TEST(Formula, LengthAndDepthHaveLimits) {
  EXPECT_EQ(value_of(repeated("(", 90) + "7" + repeated(")", 90)), 7.0);
  EXPECT_EQ(value_of(repeated("-", 90) + "7"), 7.0);
  EXPECT_EQ(value_of("1" + repeated("+1", 999)), 1000.0);
  EXPECT_EQ(value_of(repeated(" ", 1999) + "7"), 7.0);
  EXPECT_THAT(formula_error(repeated(" ", 2000) + "7"), HasSubstr("2000 characters"));
  for (const char* open : {"(", "[", "-", "!", "max(", "1?", "1?1:", "[1,"}) {
    EXPECT_THAT(formula_error(repeated(open, 150)), HasSubstr("nested too deeply")) << open;
  }
}

TEST(Formula, ResultsThatAreNotFiniteAreLeftToTheCaller) {
  EXPECT_TRUE(std::isinf(value_of("1 / 0")));
  EXPECT_TRUE(std::isnan(value_of("0 / 0")));
  EXPECT_TRUE(std::isinf(value_of("1e308 * 10")));
  EXPECT_TRUE(vector_of("normalize([0, 0, 0])").array().isNaN().all());
}

TEST(Formula, ListsItsVariables) {
  EXPECT_THAT(variables_in_formula("a + sin(b) * a - pi"),
              ::testing::UnorderedElementsAre("a", "b"));
  EXPECT_THAT(variables_in_formula("[v.x, c ? d : 1, 0] * 2m"),
              ::testing::UnorderedElementsAre("v", "c", "d"));
  EXPECT_TRUE(variables_in_formula("1 +").empty());
}

TEST(Formula, EveryFunctionCanBeCalled) {
  // Some list of plain numbers or of vectors suits each.
  for (const std::string& name : formula_function_names()) {
    bool compiles = false;
    for (const char* arguments : {"(1)", "(1, 1)", "(1, 1, 1)", "([1, 2, 3])", "([1, 2, 3], 1)",
                                  "([1, 2, 3], [3, 2, 1])"}) {
      compiles = compiles || CompiledFormula::compile(name + arguments, {}).has_value();
    }
    EXPECT_TRUE(compiles) << name;
  }
}

}  // namespace
}  // namespace seedframe
