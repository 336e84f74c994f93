#include "draws/draw_law.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "draws/bounded_normal.h"

namespace seedframe {
namespace {

double normal_up_to(double x, double mean, double std) {
  if (std <= 0.0) return x >= mean ? 1.0 : 0.0;
  return 0.5 * std::erfc((mean - x) / (std * std::sqrt(2.0)));
}

double truncated_normal_up_to(double x, const std::array<double, 4>& p) {
  const double below = normal_up_to(p[2], p[0], p[1]);
  const double inside = normal_up_to(p[3], p[0], p[1]) - below;
  if (x < p[2]) return 0.0;
  if (x >= p[3] || inside <= 0.0) return 1.0;
  return std::clamp((normal_up_to(x, p[0], p[1]) - below) / inside, 0.0, 1.0);
}

double poisson_up_to(double x, double mean) {
  if (x < 0.0) return 0.0;
  const double last = std::floor(x);
  if (mean <= 0.0) return 1.0;
  // Beyond that nothing is left, and the sum would be long.
  if (last > mean + 40.0 * std::sqrt(mean) + 40.0) return 1.0;
  double sum = 0.0;
  for (double k = 0.0; k <= last; ++k) {
    sum += std::exp(k * std::log(mean) - mean - std::lgamma(k + 1.0));
  }
  return std::min(1.0, sum);
}

std::optional<double> choice_up_to(const DrawLaw& law, double x) {
  if (law.numbers.empty()) return std::nullopt;
  const double all = std::accumulate(law.weights.begin(), law.weights.end(), 0.0);
  double below = 0.0;
  for (std::size_t i = 0; i < law.numbers.size(); ++i) {
    if (law.numbers[i] <= x) below += law.weights[i];
  }
  return below / all;
}

double linear_up_to(double x, double min, double max) {
  if (max <= min) return x >= min ? 1.0 : 0.0;
  return std::clamp((x - min) / (max - min), 0.0, 1.0);
}

double empirical_up_to(double x, const std::vector<double>& samples) {
  const auto after = std::upper_bound(samples.begin(), samples.end(), x);
  return static_cast<double>(after - samples.begin()) / static_cast<double>(samples.size());
}

}  // namespace

const char* name_of(DistributionKind kind) {
  switch (kind) {
    case DistributionKind::kUniform:
      return "uniform";
    case DistributionKind::kNormal:
      return "normal";
    case DistributionKind::kTruncatedNormal:
      return "truncated_normal";
    case DistributionKind::kBoundedNormal:
      return "bounded_normal";
    case DistributionKind::kLogUniform:
      return "log_uniform";
    case DistributionKind::kInteger:
      return "integer";
    case DistributionKind::kPoisson:
      return "poisson";
    case DistributionKind::kChoice:
      return "choice";
    case DistributionKind::kEmpirical:
      return "empirical";
  }
  return "";
}

bool is_discrete(const DrawLaw& law) {
  return law.kind == DistributionKind::kInteger || law.kind == DistributionKind::kPoisson ||
         (law.kind == DistributionKind::kChoice && !(law.numbers.empty() && law.names.empty()));
}

std::optional<double> share_up_to(const DrawLaw& law, double x) {
  const std::array<double, 4>& p = law.parameters;
  switch (law.kind) {
    case DistributionKind::kUniform:
      return linear_up_to(x, p[0], p[1]);
    case DistributionKind::kNormal:
      return normal_up_to(x, p[0], p[1]);
    case DistributionKind::kTruncatedNormal:
      return truncated_normal_up_to(x, p);
    case DistributionKind::kBoundedNormal:
      return BoundedNormal(p[0], p[1], p[2], p[3]).share_up_to(x);
    case DistributionKind::kLogUniform:
      return x <= p[0] ? 0.0 : linear_up_to(std::log(x), std::log(p[0]), std::log(p[1]));
    case DistributionKind::kInteger:
      return linear_up_to(std::floor(x) + 1.0, std::ceil(p[0]), std::floor(p[1]) + 1.0);
    case DistributionKind::kPoisson:
      return poisson_up_to(x, p[0]);
    case DistributionKind::kChoice:
      return choice_up_to(law, x);
    case DistributionKind::kEmpirical:
      if (!law.samples || law.samples->empty()) return std::nullopt;
      return empirical_up_to(x, *law.samples);
  }
  return std::nullopt;
}

}  // namespace seedframe
