#include "quality/error_model.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace seedframe {
namespace {

constexpr double kLeastSpread = 0.1;
constexpr double kMostSlope = 1.5;

/// Observations of one setting, as logarithms.
struct Group {
  std::vector<double> scouts, errors;

  static double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  }
};

using Groups = std::map<double, Group>;  ///< by the logarithm of the setting

Groups group(const std::vector<Observation>& observations) {
  Groups groups;
  for (const Observation& each : observations) {
    if (!(each.scout > 0.0) || !(each.error > 0.0) || !(each.setting > 0.0)) continue;
    Group& group = groups[std::log(each.setting)];
    group.scouts.push_back(std::log(each.scout));
    group.errors.push_back(std::log(each.error));
  }
  return groups;
}

/// Sums over scouts about their mean, of their squares and of their products with errors.
struct Moments {
  double products = 0.0;
  double squares = 0.0;

  void add(const Group& group) {
    const double scout = Group::mean(group.scouts);
    const double error = Group::mean(group.errors);
    for (std::size_t i = 0; i < group.scouts.size(); ++i) {
      products += (group.scouts[i] - scout) * (group.errors[i] - error);
      squares += (group.scouts[i] - scout) * (group.scouts[i] - scout);
    }
  }
  /// `otherwise` where all scouts are alike.
  double slope(double otherwise) const {
    constexpr double kAlike = 1e-6;
    return squares < kAlike ? otherwise : std::clamp(products / squares, 0.0, kMostSlope);
  }
};

double fit_slope(const Groups& groups) {
  Moments all;
  for (const auto& [setting, each] : groups) all.add(each);
  return all.slope(1.0);
}

double fit_slope(const Group& group, double common) {
  Moments own;
  own.add(group);
  return (own.slope(common) + common) / 2.0;
}

}  // namespace

ErrorModel::ErrorModel(const std::vector<Observation>& observations) {
  const Groups groups = group(observations);
  slope_ = fit_slope(groups);
  double squares = 0.0;
  std::size_t count = 0;
  for (const auto& [setting, each] : groups) {
    settings_.push_back(setting);
    slopes_.push_back(fit_slope(each, slope_));
    levels_.push_back(Group::mean(each.errors) - slopes_.back() * Group::mean(each.scouts));
    for (std::size_t i = 0; i < each.scouts.size(); ++i, ++count) {
      const double rest = each.errors[i] - levels_.back() - slopes_.back() * each.scouts[i];
      squares += rest * rest;
    }
  }
  const std::size_t fitted = groups.size() + 1;
  const double free = count > fitted ? static_cast<double>(count - fitted) : 1.0;
  spread_ = std::max(kLeastSpread, std::sqrt(squares / free));
}

double ErrorModel::predict(double scout, double setting) const {
  const double at = std::log(setting);
  // The piece that it lies in, or the first or last one.
  const auto above = std::upper_bound(settings_.begin() + 1, settings_.end() - 1, at);
  const auto i = static_cast<std::size_t>(above - settings_.begin());
  const double share = (at - settings_[i - 1]) / (settings_[i] - settings_[i - 1]);
  const auto value = [&](std::size_t k) { return levels_[k] + slopes_[k] * std::log(scout); };
  return std::exp(value(i - 1) + share * (value(i) - value(i - 1)));
}

double setting_for(const ErrorModel& model, double scout, double max_error, double margin,
                   double least, double most, bool rising) {
  constexpr int kSteps = 60;
  double low = std::log(least);
  double high = std::log(most);
  for (int step = 0; step < kSteps; ++step) {
    const double middle = (low + high) / 2.0;
    const bool good = model.predict(scout, std::exp(middle)) * margin <= max_error;
    // With rising errors the answer is the greatest that is good, else the least.
    (good == rising ? low : high) = middle;
  }
  return std::exp(rising ? low : high);
}

double normal_quantile(double share) {
  // Bisection of the distribution function: exact enough, and short.
  double low = -10.0;
  double high = 10.0;
  for (int step = 0; step < 80; ++step) {
    const double middle = (low + high) / 2.0;
    const double below = 0.5 * std::erfc(-middle / std::sqrt(2.0));
    (below < share ? low : high) = middle;
  }
  return (low + high) / 2.0;
}

}  // namespace seedframe
