#include "draws/draw.h"

#include <algorithm>
#include <cmath>

#include "base/nearest_name.h"
#include "draws/quantile.h"
#include "formula/color.h"

namespace seedframe {
namespace {

// Scattered copies try up to this many places within one attempt to meet the constraints.
constexpr std::uint32_t kPlacementStride = 4096;
constexpr double kLargestPoissonMean = 10000.0;

std::vector<NumberDraw> compile_all(const std::vector<NumberSource>& sources,
                                    const CompileScope& scope, const std::string& name, Level level,
                                    Diagnostics& errors) {
  std::vector<NumberDraw> draws;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    draws.push_back(
        NumberDraw::compile_any(sources[i], scope, fmt::format("{}.{}", name, i), level, errors));
  }
  return draws;
}

/// What is wrong with a distribution's parameters, or empty.
std::string parameter_fault(DistributionKind kind, const std::array<double, 4>& p) {
  switch (kind) {
    case DistributionKind::kUniform:
      if (p[0] > p[1]) return fmt::format("uniform wants min <= max, found [{}, {}]", p[0], p[1]);
      break;
    case DistributionKind::kNormal:
      if (p[1] < 0) return fmt::format("normal wants std >= 0, found {}", p[1]);
      break;
    case DistributionKind::kTruncatedNormal:
      if (p[1] < 0) return fmt::format("truncated_normal wants std >= 0, found {}", p[1]);
      if (p[2] > p[3]) {
        return fmt::format("truncated_normal wants min <= max, found [{}, {}]", p[2], p[3]);
      }
      break;
    case DistributionKind::kLogUniform:
      if (!(p[0] > 0 && p[0] <= p[1])) {
        return fmt::format("log_uniform wants 0 < min <= max, found [{}, {}]", p[0], p[1]);
      }
      break;
    case DistributionKind::kInteger:
      if (p[0] > p[1] || p[0] != std::floor(p[0]) || p[1] != std::floor(p[1])) {
        return fmt::format("integer wants whole numbers min <= max, found [{}, {}]", p[0], p[1]);
      }
      break;
    case DistributionKind::kPoisson:
      if (p[0] < 0 || p[0] > kLargestPoissonMean) {
        return fmt::format("poisson wants a mean from 0 to {}, found {}", kLargestPoissonMean,
                           p[0]);
      }
      break;
    case DistributionKind::kChoice:
    case DistributionKind::kEmpirical:
      break;
  }
  return {};
}

std::string weight_fault(const std::vector<double>& weights) {
  double total = 0.0;
  for (const double weight : weights) {
    if (weight < 0.0) return fmt::format("a weight must not be negative, found {}", weight);
    total += weight;
  }
  return total > 0.0 ? std::string() : "all weights are 0: nothing can be chosen";
}

}  // namespace

PhiloxStream::Position EvaluationContext::position(Level level) const {
  const std::uint32_t redrawn = level == Level::kFrame ? frame_attempt * kPlacementStride : 0;
  return {.scene = level == Level::kCampaign ? kNoIndex : draw_scene,
          .frame = level == Level::kFrame ? frame : kNoIndex,
          .copy = copy,
          .attempt = redrawn + placement_attempt};
}

void EvaluationContext::report(const Place& place, const std::string& message) {
  if (error) return;
  const std::string where = place.path.empty() && place.file.empty() ? "" : place.text() + ": ";
  report_frame(where + message);
}

void EvaluationContext::report_frame(const std::string& message) {
  if (error) return;
  error = Error{ErrorKind::kInput,
                fmt::format("{} (scene {}, frame {} of it{})", message, scene, frame,
                            copy == kNoIndex ? std::string() : fmt::format(", copy {}", copy))};
}

std::string draw_name(const std::string& name, const EvaluationContext& context) {
  return context.copy == kNoIndex ? name : fmt::format("{}/{}", name, context.copy);
}

double NumberDraw::Random::uniform(const EvaluationContext& context) const {
  PhiloxStream::Position position = context.position(level);
  if (!sobol) return stream.uniform(position);
  // The point by the index of scene or frame; a redrawn frame takes it from another scramble.
  const std::uint32_t index = level == Level::kFrame
                                  ? position.scene * context.frames_per_scene + position.frame
                                  : position.scene;
  position.scene = position.frame = kNoIndex;
  return sobol->point(index, static_cast<std::uint32_t>(stream.bits(position) >> 32));
}

std::shared_ptr<const NumberDraw::Random> NumberDraw::compile_random(const NumberSource& source,
                                                                     const CompileScope& scope,
                                                                     const std::string& name,
                                                                     Level level,
                                                                     Diagnostics& errors) {
  const Distribution& distribution = *std::get<std::shared_ptr<const Distribution>>(source.value);
  Random random{distribution.kind,
                level,
                name,
                PhiloxStream(scope.seed, name),
                compile_all(distribution.parameters, scope, name, level, errors),
                compile_all(distribution.weights, scope, name + ".weight", level, errors),
                {},
                distribution.samples,
                std::nullopt};
  const bool weights_vary =
      std::any_of(distribution.weights.begin(), distribution.weights.end(),
                  [](const NumberSource& w) { return !std::holds_alternative<double>(w.value); });
  if (!weights_vary) {
    for (const NumberSource& w : distribution.weights) {
      random.constant_weights.push_back(std::get<double>(w.value));
    }
    const std::string fault =
        random.constant_weights.empty() ? std::string() : weight_fault(random.constant_weights);
    if (!fault.empty()) errors.add(source.place, fault);
  }
  for (const NumberDraw& weight : random.weights) {
    if (!weight.dimension().is_plain()) errors.add(weight.place(), "a weight has no unit");
  }
  if (distribution.sobol_dimension) {
    if (scope.copies || level == Level::kCampaign) {
      errors.add(source.place,
                 "sobol covers scenes or frames evenly, and there are neither here: draw it in "
                 "variables.scene or variables.frame, and use that variable here");
    }
    random.sobol = SobolDimension(*distribution.sobol_dimension);
  }
  return std::make_shared<const Random>(std::move(random));
}

NumberDraw NumberDraw::compile_any(const NumberSource& source, const CompileScope& scope,
                                   const std::string& name, Level level, Diagnostics& errors) {
  NumberDraw draw;
  draw.place_ = source.place;
  if (const double* constant = std::get_if<double>(&source.value)) {
    draw.value_ = *constant;
  } else if (const Formula* formula = std::get_if<Formula>(&source.value)) {
    Result<CompiledFormula> compiled = CompiledFormula::compile(formula->text, scope.symbols);
    if (!compiled) {
      errors.add(source.place, compiled.error().message);
    } else if (compiled->type().type != ValueType::kNumber) {
      errors.add(source.place, "'" + formula->text + "' is a vector; a number is wanted here");
    } else {
      draw.dimension_ = compiled->type().dimension;
      draw.value_ = std::make_shared<const CompiledFormula>(std::move(*compiled));
    }
  } else {
    std::shared_ptr<const Random> random = compile_random(source, scope, name, level, errors);
    if (!random->parameters.empty()) draw.dimension_ = random->parameters.front().dimension_;
    for (const NumberDraw& parameter : random->parameters) {
      if (parameter.dimension_ == draw.dimension_) continue;
      errors.add(source.place, "all parameters must have the same unit, found " +
                                   draw.dimension_.text() + " and " + parameter.dimension_.text());
      break;
    }
    draw.value_ = std::move(random);
  }
  return draw;
}

NumberDraw NumberDraw::compile(const NumberSource& source, const CompileScope& scope,
                               const std::string& name, Level level, Diagnostics& errors) {
  NumberDraw draw = compile_any(source, scope, name, level, errors);
  const Dimension wanted = dimension_of_key(name);
  if (!draw.dimension_.is_plain() && draw.dimension_ != wanted) {
    errors.add(source.place, fmt::format("this is in {}, but {} is wanted here",
                                         draw.dimension_.text(), wanted.text()));
  }
  return draw;
}

double NumberDraw::evaluate(EvaluationContext& context) const {
  if (const double* constant = std::get_if<double>(&value_)) return *constant;
  const auto* formula = std::get_if<std::shared_ptr<const CompiledFormula>>(&value_);
  const double value =
      formula != nullptr ? (*formula)->number()
                         : draw(*std::get<std::shared_ptr<const Random>>(value_), place_, context);
  if (std::isfinite(value)) return value;
  context.report(place_, fmt::format("the value is {}, but a number must be finite", value));
  return 0.0;
}

double NumberDraw::draw(const Random& random, const Place& place, EvaluationContext& context) {
  const double u = random.uniform(context);
  double value = 0.0;
  if (random.kind == DistributionKind::kChoice) {
    std::vector<double> drawn_weights;
    if (random.constant_weights.empty()) {
      for (const NumberDraw& weight : random.weights) {
        drawn_weights.push_back(weight.evaluate(context));
      }
      if (const std::string fault = weight_fault(drawn_weights); !fault.empty()) {
        context.report(place, fault);
        return 0.0;
      }
    }
    const std::size_t chosen = quantile::choice(
        u, random.constant_weights.empty() ? drawn_weights : random.constant_weights);
    value = random.parameters[chosen].evaluate(context);
  } else {
    std::array<double, 4> p{};
    for (std::size_t i = 0; i < random.parameters.size(); ++i) {
      p[i] = random.parameters[i].evaluate(context);
    }
    if (const std::string fault = parameter_fault(random.kind, p); !fault.empty()) {
      context.report(place, fault);
      return 0.0;
    }
    switch (random.kind) {
      case DistributionKind::kUniform:
        value = quantile::uniform(u, p[0], p[1]);
        break;
      case DistributionKind::kNormal:
        value = quantile::normal(u, p[0], p[1]);
        break;
      case DistributionKind::kTruncatedNormal:
        value = quantile::truncated_normal(u, p[0], p[1], p[2], p[3]);
        break;
      case DistributionKind::kLogUniform:
        value = quantile::log_uniform(u, p[0], p[1]);
        break;
      case DistributionKind::kInteger:
        value = quantile::integer(u, p[0], p[1]);
        break;
      case DistributionKind::kPoisson:
        value = quantile::poisson(u, p[0]);
        break;
      case DistributionKind::kEmpirical:
        value = quantile::empirical(u, *random.samples);
        break;
      case DistributionKind::kChoice:
        break;
    }
  }
  if (context.record != nullptr)
    context.record->push_back({draw_name(random.name, context), value});
  return value;
}

VectorDraw VectorDraw::compile_any(const VectorSource& source, const CompileScope& scope,
                                   const std::string& name, Level level, Diagnostics& errors) {
  VectorDraw vector;
  if (source.alike) {
    vector.alike_ = true;
    vector.place_ = source.components[0].place;
    vector.components_[0] =
        NumberDraw::compile_any(source.components[0], scope, name, level, errors);
    vector.dimension_ = vector.components_[0].dimension();
    return vector;
  }
  if (!source.formula) {
    vector.place_ = source.components[0].place;
    for (std::size_t i = 0; i < 3; ++i) {
      vector.components_[i] = NumberDraw::compile_any(
          source.components[i], scope, fmt::format("{}[{}]", name, i), level, errors);
    }
    vector.dimension_ = vector.components_[0].dimension();
    for (const NumberDraw& component : vector.components_) {
      if (component.dimension() == vector.dimension_) continue;
      // A plain number goes with any unit that its key wants; two units do not go together.
      if (vector.dimension_.is_plain()) vector.dimension_ = component.dimension();
      if (component.dimension().is_plain() || component.dimension() == vector.dimension_) continue;
      errors.add(vector.place_, "the components of a vector must have the same unit");
      break;
    }
    return vector;
  }
  vector.place_ = source.formula->place;
  const Formula& formula = std::get<Formula>(source.formula->value);
  Result<CompiledFormula> compiled = CompiledFormula::compile(formula.text, scope.symbols);
  if (!compiled) {
    errors.add(vector.place_, compiled.error().message);
  } else if (compiled->type().type != ValueType::kVector) {
    errors.add(vector.place_, "'" + formula.text + "' is a number; a vector is wanted here");
  } else {
    vector.dimension_ = compiled->type().dimension;
    vector.formula_ = std::make_shared<const CompiledFormula>(std::move(*compiled));
  }
  return vector;
}

VectorDraw VectorDraw::compile(const VectorSource& source, const CompileScope& scope,
                               const std::string& name, Level level, Diagnostics& errors) {
  VectorDraw vector = compile_any(source, scope, name, level, errors);
  const Dimension wanted = dimension_of_key(name);
  if (!vector.dimension_.is_plain() && vector.dimension_ != wanted) {
    errors.add(vector.place_, fmt::format("this is in {}, but {} is wanted here",
                                          vector.dimension_.text(), wanted.text()));
  }
  return vector;
}

Eigen::Vector3d VectorDraw::evaluate(EvaluationContext& context) const {
  if (alike_) return Eigen::Vector3d::Constant(components_[0].evaluate(context));
  if (!formula_) {
    return {components_[0].evaluate(context), components_[1].evaluate(context),
            components_[2].evaluate(context)};
  }
  Eigen::Vector3d value = formula_->vector();
  if (value.allFinite()) return value;
  context.report(place_, fmt::format("the value is [{}, {}, {}], but a number must be finite",
                                     value.x(), value.y(), value.z()));
  return Eigen::Vector3d::Zero();
}

ColorDraw ColorDraw::compile(const ColorSource& source, const CompileScope& scope,
                             const std::string& name, Level level, Diagnostics& errors) {
  ColorDraw color;
  color.model_ = source.model;
  if (source.model == ColorModel::kFormula) {
    VectorSource formula;
    formula.formula = source.components[0];
    color.formula_ = VectorDraw::compile_any(formula, scope, name, level, errors);
    if (!color.formula_->dimension().is_plain()) {
      errors.add(color.formula_->place(), "a colour has no unit");
    }
    return color;
  }
  bool constant = true;
  for (std::size_t i = 0; i < 3; ++i) {
    constant = constant && std::holds_alternative<double>(source.components[i].value);
    color.components_[i] = NumberDraw::compile_any(source.components[i], scope,
                                                   fmt::format("{}[{}]", name, i), level, errors);
    const Dimension& dimension = color.components_[i].dimension();
    const bool fits = dimension.is_plain() ||
                      (i == 0 && source.model == ColorModel::kHsv && dimension == kAngle) ||
                      (i == 0 && source.model == ColorModel::kKelvin && dimension == kTemperature);
    if (!fits) {
      errors.add(color.components_[i].place(), "this unit has no meaning in a colour");
    }
  }
  if (constant) {
    EvaluationContext nowhere;
    color.value_ = color.evaluate(nowhere);
    color.constant_ = !nowhere.error;  // an error is reported when a frame is expanded
  }
  return color;
}

Rgb ColorDraw::evaluate(EvaluationContext& context) const {
  if (constant_) return value_;
  std::array<double, 3> c{};
  if (formula_) {
    const Eigen::Vector3d value = formula_->evaluate(context);
    c = {value.x(), value.y(), value.z()};
  } else {
    for (std::size_t i = 0; i < 3; ++i) c[i] = components_[i].evaluate(context);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const bool may_be_negative = model_ == ColorModel::kHsv && i == 0;
    if (c[i] < 0.0 && !may_be_negative) {
      context.report(formula_ ? formula_->place() : components_[i].place(),
                     fmt::format("a colour must not be negative, found {}", c[i]));
      c[i] = 0.0;
    }
  }
  if (model_ == ColorModel::kKelvin) return linear_from_kelvin(c[0]);
  if (model_ == ColorModel::kHsv) return linear_from_hsv(c[0], std::min(c[1], 1.0), c[2]);
  return c;
}

std::vector<NameDraw::Piece> NameDraw::split(const std::string& text, const CompileScope& scope,
                                             const Place& place, Diagnostics& errors) {
  constexpr std::size_t kLongest = 2000;  // as a formula
  std::vector<Piece> pieces;
  std::size_t start = 0;
  if (text.size() > kLongest) {
    errors.add(place,
               fmt::format("a name may have {} characters, found {}", kLongest, text.size()));
    return pieces;
  }
  while (start < text.size()) {
    const std::size_t open = text.find("${", start);
    if (open == std::string::npos) break;
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) {
      errors.add(place, "'" + text + "': '${' without '}'");
      return pieces;
    }
    const std::string variable = text.substr(open + 2, close - open - 2);
    const auto found = scope.symbols.find(variable);
    if (found == scope.symbols.end() || found->second.text == nullptr) {
      std::vector<std::string> known;
      for (const auto& [name, symbol] : scope.symbols) {
        if (symbol.text != nullptr) known.push_back(name);
      }
      errors.add(place, "there is no variable of names '" + variable + "' here" +
                            did_you_mean(variable, known));
      return pieces;
    }
    pieces.push_back({text.substr(start, open - start), found->second.text});
    start = close + 1;
  }
  if (start < text.size() || pieces.empty()) pieces.push_back({text.substr(start), nullptr});
  return pieces;
}

NameDraw NameDraw::compile(const NameSource& source, const CompileScope& scope,
                           const std::string& name, Level level, Diagnostics& errors) {
  NameDraw draw;
  draw.place_ = source.place;
  draw.level_ = level;
  draw.name_ = name;
  if (source.options.size() > 1) draw.stream_ = PhiloxStream(scope.seed, name);
  for (const NameSource::Option& option : source.options) {
    draw.options_.push_back(
        {split(option.text, scope, source.place, errors),
         NumberDraw::compile_any(option.weight, scope, name + ".weight." + option.text, level,
                                 errors)});
  }
  return draw;
}

std::string NameDraw::evaluate(EvaluationContext& context) const {
  if (!stream_ && options_[0].pieces.size() == 1 && options_[0].pieces[0].variable == nullptr) {
    return options_[0].pieces[0].text;
  }
  std::size_t chosen = 0;
  if (stream_) {
    std::vector<double> weights;
    for (const Option& option : options_) weights.push_back(option.weight.evaluate(context));
    if (const std::string fault = weight_fault(weights); !fault.empty()) {
      context.report(place_, fault);
    } else {
      chosen = quantile::choice(stream_->uniform(context.position(level_)), weights);
    }
  }
  std::string value;
  for (const Piece& piece : options_[chosen].pieces) {
    value += piece.text;
    if (piece.variable != nullptr) value += *piece.variable;
  }
  if (stream_ && context.record != nullptr) {
    context.record->push_back({draw_name(name_, context), value});
  }
  return value;
}

std::optional<std::vector<std::string>> NameDraw::possible_values() const {
  std::vector<std::string> values;
  for (const Option& option : options_) {
    std::string value;
    for (const Piece& piece : option.pieces) {
      if (piece.variable != nullptr) return std::nullopt;
      value += piece.text;
    }
    values.push_back(value);
  }
  return values;
}

}  // namespace seedframe
