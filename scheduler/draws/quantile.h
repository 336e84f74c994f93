// Distributions as quantile functions: a draw is quantile(u) of one uniform u in (0, 1).
//
// One uniform a draw, never a rejection: so a draw has one key, stays where it is when its
// parameters move, and any even sequence of u covers the distribution evenly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace seedframe::quantile {

/// On [min, max].
double uniform(double u, double min, double max);
/// std >= 0. Uses Boost.Math's inverse of the complementary error function.
double normal(double u, double mean, double std);
/// The normal distribution given that it falls into [min, max]; works far out in a tail as well.
double truncated_normal(double u, double mean, double std, double min, double max);
/// log(x) is uniform between log(min) and log(max); 0 < min <= max.
double log_uniform(double u, double min, double max);
/// Whole numbers from min to max, both included, each as likely.
double integer(double u, double min, double max);
/// Whole numbers from 0; 0 <= mean <= 10000.
double poisson(double u, double mean);
/// One of the sorted samples (at least one), each as likely.
double empirical(double u, std::span<const double> samples);
/// An index into weights (>= 0, with a positive sum), as likely as its weight.
std::size_t choice(double u, std::span<const double> weights);
/// What makes weights unfit for choice, in a sentence; empty if nothing does.
std::string weight_error(std::span<const double> weights);

}  // namespace seedframe::quantile
