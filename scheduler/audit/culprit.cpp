#include "audit/culprit.h"

#include <iterator>

namespace seedframe {
namespace {

Conditions both(Conditions a, const Conditions& b) {
  a.insert(b.begin(), b.end());
  return a;
}

/// Of `candidates`, given that `fixed` alone flips nothing and with all of them does.
Result<Conditions> search(const Conditions& fixed, const Conditions& candidates,
                          const Flips& flips) {
  if (candidates.size() <= 1) return candidates;
  const auto middle =
      std::next(candidates.begin(), static_cast<std::ptrdiff_t>(candidates.size() / 2));
  const Conditions left(candidates.begin(), middle);
  const Conditions right(middle, candidates.end());
  for (const Conditions& half : {left, right}) {
    const Result<bool> flipped = flips(both(fixed, half));
    if (!flipped) return forward_error(flipped);
    if (*flipped) return search(fixed, half, flips);
  }
  // Only together: some of each half, the other half given.
  Result<Conditions> of_left = search(both(fixed, right), left, flips);
  if (!of_left) return of_left;
  Result<Conditions> of_right = search(both(fixed, *of_left), right, flips);
  if (!of_right) return of_right;
  return both(*of_left, *of_right);
}

}  // namespace

Result<Conditions> find_culprits(const Conditions& varied, const Flips& flips) {
  return search({}, varied, flips);
}

}  // namespace seedframe
