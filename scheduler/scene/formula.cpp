#include "scene/formula.h"

#include <cmath>
#include <limits>

#include <muParser.h>

#include "base/nearest_name.h"
#include "base/portable_math.h"

namespace seedframe {
namespace {

constexpr std::size_t kLongestFormula = 2000;

double modulo(double a, double b) { return a - b * std::floor(a / b); }
double clamp(double x, double low, double high) { return x < low ? low : (x > high ? high : x); }
double absolute(double x) { return std::fabs(x); }
double round_half_up(double x) { return std::floor(x + 0.5); }
double floor_of(double x) { return std::floor(x); }
double ceil_of(double x) { return std::ceil(x); }
double log10_of(double x) { return portable::log(x) / portable::log(10.0); }
double least(const double* values, int count) {
  double result = values[0];
  for (int i = 1; i < count; ++i) result = values[i] < result ? values[i] : result;
  return result;
}
double most(const double* values, int count) {
  double result = values[0];
  for (int i = 1; i < count; ++i) result = values[i] > result ? values[i] : result;
  return result;
}

const std::vector<std::string>& function_names() {
  static const std::vector<std::string> names = {
      "abs", "acos",  "asin", "atan", "atan2", "ceil", "clamp", "cos",   "deg", "exp",  "floor",
      "ln",  "log10", "max",  "min",  "mod",   "pow",  "rad",   "round", "sin", "sqrt", "tan"};
  return names;
}

// muParser's own functions are left out: they call the C library's double versions, whose last bit
// depends on the CPU.
void define_functions(mu::Parser& parser) {
  parser.ClearFun();
  parser.ClearConst();
  parser.ClearInfixOprt();
  parser.DefineInfixOprt(
      "-", [](double x) { return -x; }, mu::prINFIX);
  parser.DefineInfixOprt(
      "+", [](double x) { return x; }, mu::prINFIX);
  parser.DefineConst("pi", portable::kPi);
  parser.DefineFun("abs", absolute);
  parser.DefineFun("acos", portable::acos);
  parser.DefineFun("asin", portable::asin);
  parser.DefineFun("atan", portable::atan);
  parser.DefineFun("atan2", portable::atan2);
  parser.DefineFun("ceil", ceil_of);
  parser.DefineFun("clamp", clamp);
  parser.DefineFun("cos", portable::cos);
  parser.DefineFun("deg", [](double radians) { return radians * (180.0 / portable::kPi); });
  parser.DefineFun("exp", portable::exp);
  parser.DefineFun("floor", floor_of);
  parser.DefineFun("ln", portable::log);
  parser.DefineFun("log10", log10_of);
  parser.DefineFun("max", most);
  parser.DefineFun("min", least);
  parser.DefineFun("mod", modulo);
  parser.DefineFun("pow", portable::pow);
  parser.DefineFun("rad", portable::radians);
  parser.DefineFun("round", round_half_up);
  parser.DefineFun("sin", portable::sin);
  parser.DefineFun("sqrt", portable::sqrt);
  parser.DefineFun("tan", portable::tan);
}

Status refuse_unoffered_operators(const std::string& text) {
  if (text.size() > kLongestFormula) {
    return fail(ErrorKind::kInput, "a formula may have {} characters, this one has {}",
                kLongestFormula, text.size());
  }
  if (text.find('^') != std::string::npos) {
    return fail(ErrorKind::kInput, "'{}': write pow(x, y) instead of x ^ y", text);
  }
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool second = i > 0 && std::string("=<>!").find(text[i - 1]) != std::string::npos;
    const bool first = i + 1 < text.size() && text[i + 1] == '=';
    if (!first && !second) {
      return fail(ErrorKind::kInput, "'{}': a formula assigns nothing; write == to compare", text);
    }
    if (first) ++i;
  }
  return {};
}

std::string reason_of(const mu::Parser::exception_type& error, const Scope& scope) {
  const std::string& token = error.GetToken();
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !token.empty()) {
    std::vector<std::string> names = function_names();
    for (const auto& [name, value] : scope) names.push_back(name);
    const std::string nearest = nearest_name(token, names);
    return "'" + token + "' is neither a number, a variable that is known here nor a function" +
           (nearest.empty() ? "" : " (did you mean '" + nearest + "'?)");
  }
  return error.GetMsg();
}

}  // namespace

struct CompiledFormula::State {
  mu::Parser parser;
};

CompiledFormula::CompiledFormula(std::unique_ptr<State> state) : state_(std::move(state)) {}
CompiledFormula::~CompiledFormula() = default;
CompiledFormula::CompiledFormula(CompiledFormula&&) noexcept = default;
CompiledFormula& CompiledFormula::operator=(CompiledFormula&&) noexcept = default;

Result<CompiledFormula> CompiledFormula::compile(const std::string& text, const Scope& scope) {
  if (Status offered = refuse_unoffered_operators(text); !offered) return forward_error(offered);
  auto state = std::make_unique<State>();
  try {
    define_functions(state->parser);
    for (const auto& [name, value] : scope) {
      // muParser wants to be able to assign; the operator that would is refused above.
      state->parser.DefineVar(name, const_cast<double*>(value));
    }
    state->parser.SetExpr(text);
    state->parser.Eval();
    if (state->parser.GetNumResults() != 1) {
      return fail(ErrorKind::kInput, "'{}': a formula has one result, this has {}", text,
                  state->parser.GetNumResults());
    }
  } catch (const mu::Parser::exception_type& error) {
    return fail(ErrorKind::kInput, "'{}': {}", text, reason_of(error, scope));
  }
  return CompiledFormula(std::move(state));
}

double CompiledFormula::evaluate() const {
  try {
    return state_->parser.Eval();
  } catch (const mu::Parser::exception_type&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

std::vector<std::string> variables_in_formula(const std::string& text) {
  std::vector<std::string> names;
  try {
    mu::Parser parser;
    define_functions(parser);
    parser.SetExpr(text);
    for (const auto& used : parser.GetUsedVar()) names.push_back(used.first);
  } catch (const mu::Parser::exception_type&) {
    names.clear();
  }
  return names;
}

}  // namespace seedframe
