// Which of many choices are worth their cost.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace seedframe {

struct CostAndError {
  double cost = 0.0;
  double error = 0.0;
};

/// Indices of those that no other is at most as dear and at most as wrong as, cheapest first; of
/// equal ones the first. A NaN is never among them.
std::vector<std::size_t> pareto_front(const std::vector<CostAndError>& choices);

/// The cheapest that is at most so wrong; of equally cheap ones the less wrong.
std::optional<std::size_t> cheapest_within(const std::vector<CostAndError>& choices,
                                           double most_error);

}  // namespace seedframe
