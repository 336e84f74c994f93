#include "draws/number_draw.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "draws/bounded_normal.h"
#include "draws/quantile.h"

namespace seedframe {
namespace {

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
std::string parameter_error(DistributionKind kind, const std::array<double, 4>& p) {
  switch (kind) {
    case DistributionKind::kUniform:
      if (p[0] > p[1]) return fmt::format("uniform needs min <= max, found [{}, {}]", p[0], p[1]);
      break;
    case DistributionKind::kNormal:
      if (p[1] < 0) return fmt::format("normal needs std >= 0, found {}", p[1]);
      break;
    case DistributionKind::kTruncatedNormal:
      if (p[1] < 0) return fmt::format("truncated_normal needs std >= 0, found {}", p[1]);
      if (p[2] > p[3]) {
        return fmt::format("truncated_normal needs min <= max, found [{}, {}]", p[2], p[3]);
      }
      break;
    case DistributionKind::kBoundedNormal:
      return BoundedNormal::error(p[0], p[1], p[2], p[3]);
    case DistributionKind::kLogUniform:
      if (!(p[0] > 0 && p[0] <= p[1])) {
        return fmt::format("log_uniform needs 0 < min <= max, found [{}, {}]", p[0], p[1]);
      }
      break;
    case DistributionKind::kInteger:
      if (p[0] > p[1] || p[0] != std::floor(p[0]) || p[1] != std::floor(p[1])) {
        return fmt::format("integer needs whole numbers min <= max, found [{}, {}]", p[0], p[1]);
      }
      break;
    case DistributionKind::kPoisson:
      if (p[0] < 0 || p[0] > kLargestPoissonMean) {
        return fmt::format("poisson needs a mean from 0 to {}, found {}", kLargestPoissonMean,
                           p[0]);
      }
      break;
    case DistributionKind::kChoice:
    case DistributionKind::kEmpirical:
      break;
  }
  return {};
}

}  // namespace

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
    const std::string wrong = random.constant_weights.empty()
                                  ? std::string()
                                  : quantile::weight_error(random.constant_weights);
    if (!wrong.empty()) errors.add(source.place, wrong);
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
      errors.add(source.place, "'" + formula->text + "' is a vector; a number is needed here");
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
    errors.add(source.place, fmt::format("this is in {}, but {} is needed here",
                                         draw.dimension_.text(), wanted.text()));
  }
  return draw;
}

double NumberDraw::evaluate(EvaluationContext& context) const {
  if (const double* constant = std::get_if<double>(&value_)) return *constant;
  const auto* formula = std::get_if<std::shared_ptr<const CompiledFormula>>(&value_);
  const double value =
      formula != nullptr ? (*formula)->number(context.values)
                         : draw(*std::get<std::shared_ptr<const Random>>(value_), place_, context);
  if (std::isfinite(value)) return value;
  context.report(place_, fmt::format("the value is {}, but a number must be finite", value));
  return 0.0;
}

DrawLaw NumberDraw::law_of(const Random& random, const std::array<double, 4>& parameters,
                           const std::vector<double>& drawn_weights) {
  DrawLaw law;
  law.level = random.level;
  law.kind = random.kind;
  law.parameters = parameters;
  if (random.kind != DistributionKind::kChoice) {
    law.samples = random.samples;
    return law;
  }
  law.weights = random.constant_weights.empty() ? drawn_weights : random.constant_weights;
  for (const NumberDraw& option : random.parameters) {
    const double* constant = std::get_if<double>(&option.value_);
    if (constant == nullptr) {
      law.numbers.clear();
      break;
    }
    law.numbers.push_back(*constant);
  }
  return law;
}

double NumberDraw::draw(const Random& random, const Place& place, EvaluationContext& context) {
  const double u = random.uniform(context);
  double value = 0.0;
  std::array<double, 4> p{};
  std::vector<double> drawn_weights;
  if (random.kind == DistributionKind::kChoice) {
    if (random.constant_weights.empty()) {
      for (const NumberDraw& weight : random.weights) {
        drawn_weights.push_back(weight.evaluate(context));
      }
      if (const std::string wrong = quantile::weight_error(drawn_weights); !wrong.empty()) {
        context.report(place, wrong);
        return 0.0;
      }
    }
    const std::size_t chosen = quantile::choice(
        u, random.constant_weights.empty() ? drawn_weights : random.constant_weights);
    value = random.parameters[chosen].evaluate(context);
  } else {
    for (std::size_t i = 0; i < random.parameters.size(); ++i) {
      p[i] = random.parameters[i].evaluate(context);
    }
    if (const std::string wrong = parameter_error(random.kind, p); !wrong.empty()) {
      context.report(place, wrong);
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
      case DistributionKind::kBoundedNormal:
        value = BoundedNormal(p[0], p[1], p[2], p[3]).quantile(u);
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
  if (context.record != nullptr) {
    context.record->push_back(
        {draw_name(random.name, context), value, law_of(random, p, drawn_weights)});
  }
  return value;
}

}  // namespace seedframe
