#include "quality/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace seedframe {
namespace {

/// By cost, then by error; those with a NaN left out.
std::vector<std::size_t> cheapest_first(const std::vector<CostAndError>& choices) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (!std::isnan(choices[i].cost) && !std::isnan(choices[i].error)) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return choices[a].cost != choices[b].cost ? choices[a].cost < choices[b].cost
                                              : choices[a].error < choices[b].error;
  });
  return order;
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<CostAndError>& choices) {
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : cheapest_first(choices)) {
    if (!front.empty() && choices[i].error >= least) continue;
    least = choices[i].error;
    front.push_back(i);
  }
  return front;
}

std::optional<std::size_t> cheapest_within(const std::vector<CostAndError>& choices,
                                           double most_error) {
  for (const std::size_t i : cheapest_first(choices)) {
    if (choices[i].error <= most_error) return i;
  }
  return std::nullopt;
}

}  // namespace seedframe
