// Which of several conditions is to blame, by bisection.
#pragma once

#include <functional>

#include "audit/condition.h"
#include "base/error.h"

namespace seedframe {

/// Whether the outcome is another one when just these conditions are varied.
using Flips = std::function<Result<bool>(const Conditions&)>;

/// A smallest part of `varied` that flips the outcome: one condition if any does so alone, else
/// several that do so together. `varied` itself flips it, nothing does not. About 2 log2 n
/// questions for one culprit. (Zeller and Hildebrandt, "Simplifying and isolating failure-inducing
/// input", IEEE TSE 28(2), 2002, is the idea; their dd for interfering changes is the recursion.)
Result<Conditions> find_culprits(const Conditions& varied, const Flips& flips);

}  // namespace seedframe
