#include "quality/sample_counts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace seedframe {
namespace {

/// With the least samples that we ask for (16) the first look is after 32.
constexpr int kFirstLook = 2 * kSamplesBetweenLooks;

/// Whether pixels that stopped before the others did so at a look.
bool are_looks(const std::vector<float>& shares, int most) {
  constexpr double kRounding = 0.01;  // of a look
  return std::all_of(shares.begin(), shares.end(), [&](float share) {
    const double samples = static_cast<double>(share) * most;
    const double looks = samples / kSamplesBetweenLooks;
    const bool is_look = std::abs(looks - std::round(looks)) < kRounding;
    return share >= 1.0F || (is_look && samples > kFirstLook - 1);
  });
}

}  // namespace

double mean_samples(const Image<float>& shares, int most_samples) {
  std::vector<float> distinct = shares.values;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  int most = std::min(kFirstLook, most_samples);
  while (most < most_samples && !are_looks(distinct, most)) most += kSamplesBetweenLooks;
  const double sum = std::accumulate(shares.values.begin(), shares.values.end(), 0.0);
  return std::min(most, most_samples) * sum / static_cast<double>(shares.values.size());
}

}  // namespace seedframe
