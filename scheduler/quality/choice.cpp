#include "quality/choice.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace seedframe {
namespace {

Choice choice_of(const Variation& variation, const CostAndError& at) {
  return {variation.name, variation.lever, variation.samples, variation.denoises(), at};
}

/// A sum of logarithms.
struct GeometricMean {
  double sum = 0.0;
  int count = 0;

  void add(double ratio) {
    sum += std::log(ratio);
    ++count;
  }
  double value() const { return std::exp(sum / count); }
};

/// Nothing if a frame has no error, of which there is no ratio, or the variation was left out.
std::optional<CostAndError> relative_to(const MeasuredVariation& measured,
                                        const MeasuredVariation& base, const Measure& measure,
                                        GeometricMean& cost, GeometricMean& error) {
  for (std::size_t i = 0; i < measured.frames.size(); ++i) {
    const double wrong = measure.of(measured.frames[i].error);
    const double base_wrong = measure.of(base.frames[i].error);
    if (wrong <= 0.0 || base_wrong <= 0.0) return std::nullopt;
    cost.add(measured.frames[i].cpu_s / base.frames[i].cpu_s);
    error.add(wrong / base_wrong);
  }
  if (measured.frames.empty()) return std::nullopt;
  return CostAndError{cost.value(), error.value()};
}

bool is_plain(const Choice& choice) { return choice.lever == Lever::kSamples; }

}  // namespace

std::vector<Choice> choices_of(const SceneStudy& scene, const Measure& measure) {
  std::vector<Choice> choices;
  for (const MeasuredVariation& measured : scene.variations) {
    if (!measured.left_out.empty()) continue;
    choices.push_back(
        choice_of(measured.variation, {measured.cpu_s(), measure.of(measured.error())}));
  }
  return choices;
}

std::vector<Choice> choices_overall(const std::vector<SceneStudy>& scenes, const Measure& measure) {
  std::vector<Choice> choices;
  if (scenes.empty()) return choices;
  for (const MeasuredVariation& first : scenes.front().variations) {
    GeometricMean cost;
    GeometricMean error;
    std::optional<CostAndError> at;
    for (const SceneStudy& scene : scenes) {
      const MeasuredVariation* measured = scene.find(first.variation.name);
      const MeasuredVariation* base = scene.find(plain_samples(kOverallSamples).name);
      at = measured == nullptr || base == nullptr || base->frames.empty()
               ? std::nullopt
               : relative_to(*measured, *base, measure, cost, error);
      if (!at) break;
    }
    if (at) choices.push_back(choice_of(first.variation, *at));
  }
  return choices;
}

std::vector<std::size_t> front_of(const std::vector<Choice>& choices, bool denoised) {
  std::vector<CostAndError> points;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i].denoises && !denoised) continue;
    points.push_back(choices[i].at);
    indices.push_back(i);
  }
  std::vector<std::size_t> front;
  for (const std::size_t i : pareto_front(points)) front.push_back(indices[i]);
  return front;
}

std::vector<Advice> advice_for(const std::vector<Choice>& choices) {
  std::vector<CostAndError> exact;
  std::vector<CostAndError> any;
  for (const Choice& choice : choices) {
    constexpr double kNever = INFINITY;
    exact.push_back({choice.at.cost, choice.denoises ? kNever : choice.at.error});
    any.push_back(choice.at);
  }
  std::vector<Advice> advices;
  for (const int samples : {4, 16, 64, 256, 1024}) {
    const auto plain = std::find_if(choices.begin(), choices.end(), [&](const Choice& choice) {
      return is_plain(choice) && choice.samples == samples;
    });
    if (plain == choices.end()) continue;
    advices.push_back({*plain, choices[*cheapest_within(exact, plain->at.error)],
                       choices[*cheapest_within(any, plain->at.error)]});
  }
  return advices;
}

}  // namespace seedframe
