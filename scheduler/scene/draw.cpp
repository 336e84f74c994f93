#include "scene/draw.h"

#include <algorithm>
#include <cmath>

#include "base/nearest_name.h"
#include "scene/color.h"
#include "scene/quantile.h"

namespace seedframe {
namespace {

std::string record_name(const std::string& name, const EvaluationContext& context) {
  return context.copy == kNoIndex ? name : fmt::format("{}/{}", name, context.copy);
}

std::vector<NumberDraw> compile_all(const std::vector<NumberSource>& sources,
                                    const CompileScope& scope, const std::string& name, Level level,
                                    Diagnostics& errors) {
  std::vector<NumberDraw> draws;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    draws.push_back(
        NumberDraw::compile(sources[i], scope, fmt::format("{}.{}", name, i), level, errors));
  }
  return draws;
}

std::vector<double> evaluate_all(const std::vector<NumberDraw>& draws, EvaluationContext& context) {
  std::vector<double> values;
  values.reserve(draws.size());
  for (const NumberDraw& draw : draws) values.push_back(draw.evaluate(context));
  return values;
}

/// What is wrong with a distribution's parameters, or empty.
std::string parameter_fault(DistributionKind kind, const std::vector<double>& p) {
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
    case DistributionKind::kChoice:
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
  return {.scene = level == Level::kCampaign ? kNoIndex : scene,
          .frame = level == Level::kFrame ? frame : kNoIndex,
          .copy = copy,
          .attempt = attempt};
}

void EvaluationContext::report(const Place& place, const std::string& message) {
  if (error) return;
  error =
      Error{ErrorKind::kInput,
            fmt::format("{}: {} (scene {}, frame {} of it{})", place.text(), message, scene, frame,
                        copy == kNoIndex ? std::string() : fmt::format(", copy {}", copy))};
}

NumberDraw NumberDraw::compile(const NumberSource& source, const CompileScope& scope,
                               const std::string& name, Level level, Diagnostics& errors) {
  NumberDraw draw;
  draw.place_ = source.place;
  if (const double* constant = std::get_if<double>(&source.value)) {
    draw.value_ = *constant;
  } else if (const Formula* formula = std::get_if<Formula>(&source.value)) {
    Result<CompiledFormula> compiled = CompiledFormula::compile(formula->text, scope.numbers);
    if (compiled) {
      draw.value_ = std::make_shared<const CompiledFormula>(std::move(*compiled));
    } else {
      errors.add(source.place, compiled.error().message);
    }
  } else {
    const Distribution& distribution = *std::get<std::shared_ptr<const Distribution>>(source.value);
    draw.value_ = std::make_shared<const Random>(
        Random{distribution.kind, level, name, PhiloxStream(scope.seed, name),
               compile_all(distribution.parameters, scope, name, level, errors),
               compile_all(distribution.weights, scope, name + ".weight", level, errors)});
  }
  return draw;
}

double NumberDraw::evaluate(EvaluationContext& context) const {
  if (const double* constant = std::get_if<double>(&value_)) return *constant;
  const auto* formula = std::get_if<std::shared_ptr<const CompiledFormula>>(&value_);
  const double value = formula != nullptr
                           ? (*formula)->evaluate()
                           : draw(*std::get<std::shared_ptr<const Random>>(value_), context);
  if (std::isfinite(value)) return value;
  context.report(place_, fmt::format("the value is {}, but a number must be finite", value));
  return 0.0;
}

double NumberDraw::draw(const Random& random, EvaluationContext& context) const {
  const double u = random.stream.uniform(context.position(random.level));
  double value = 0.0;
  if (random.kind == DistributionKind::kChoice) {
    const std::vector<double> weights = evaluate_all(random.weights, context);
    if (const std::string fault = weight_fault(weights); !fault.empty()) {
      context.report(place_, fault);
      return 0.0;
    }
    value = random.parameters[quantile::choice(u, weights)].evaluate(context);
  } else {
    const std::vector<double> p = evaluate_all(random.parameters, context);
    if (const std::string fault = parameter_fault(random.kind, p); !fault.empty()) {
      context.report(place_, fault);
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
      case DistributionKind::kChoice:
        break;
    }
  }
  if (context.record != nullptr) {
    context.record->push_back({record_name(random.name, context), value});
  }
  return value;
}

VectorDraw VectorDraw::compile(const std::array<NumberSource, 3>& components,
                               const CompileScope& scope, const std::string& name, Level level,
                               Diagnostics& errors) {
  VectorDraw vector;
  for (std::size_t i = 0; i < 3; ++i) {
    vector.components_[i] =
        NumberDraw::compile(components[i], scope, fmt::format("{}[{}]", name, i), level, errors);
  }
  return vector;
}

Eigen::Vector3d VectorDraw::evaluate(EvaluationContext& context) const {
  return {components_[0].evaluate(context), components_[1].evaluate(context),
          components_[2].evaluate(context)};
}

ColorDraw ColorDraw::compile(const ColorSource& source, const CompileScope& scope,
                             const std::string& name, Level level, Diagnostics& errors) {
  ColorDraw color;
  color.model_ = source.model;
  for (std::size_t i = 0; i < 3; ++i) {
    color.components_[i] = NumberDraw::compile(source.components[i], scope,
                                               fmt::format("{}[{}]", name, i), level, errors);
  }
  return color;
}

Rgb ColorDraw::evaluate(EvaluationContext& context) const {
  std::array<double, 3> c{};
  for (std::size_t i = 0; i < 3; ++i) {
    c[i] = components_[i].evaluate(context);
    const bool may_be_negative = model_ == ColorModel::kHsv && i == 0;
    if (c[i] < 0.0 && !may_be_negative) {
      context.report(components_[i].place(),
                     fmt::format("a colour must not be negative, found {}", c[i]));
      c[i] = 0.0;
    }
  }
  if (model_ == ColorModel::kKelvin) return linear_from_kelvin(c[0]);
  if (model_ == ColorModel::kHsv) {
    return linear_from_hsv(c[0], std::min(c[1], 1.0), c[2]);
  }
  return c;
}

std::vector<NameDraw::Piece> NameDraw::split(const std::string& text, const CompileScope& scope,
                                             const Place& place, Diagnostics& errors) {
  std::vector<Piece> pieces;
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t open = text.find("${", start);
    if (open == std::string::npos) break;
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) {
      errors.add(place, "'" + text + "': '${' without '}'");
      return pieces;
    }
    const std::string variable = text.substr(open + 2, close - open - 2);
    const auto found = scope.names.find(variable);
    if (found == scope.names.end()) {
      std::vector<std::string> known;
      for (const auto& entry : scope.names) known.push_back(entry.first);
      errors.add(place, "there is no variable of names '" + variable + "' here" +
                            did_you_mean(variable, known));
      return pieces;
    }
    pieces.push_back({text.substr(start, open - start), found->second});
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
    draw.options_.push_back({split(option.text, scope, source.place, errors),
                             NumberDraw::compile(option.weight, scope,
                                                 name + ".weight." + option.text, level, errors)});
  }
  return draw;
}

std::string NameDraw::evaluate(EvaluationContext& context) const {
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
    context.record->push_back({record_name(name_, context), value});
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
