// Predicts how wrong a frame comes out from how noisy a cheap look at it is: fitted to a few pilot
// frames of the same campaign, of which both are known. How many samples adaptive sampling takes is
// predicted like an error.
#pragma once

#include <cstddef>
#include <vector>

namespace seedframe {

/// One pilot rendered in one way. `setting` is what the ways of a family differ by, above 0: the
/// number of samples, or the threshold of adaptive sampling.
struct Observation {
  double scout = 0.0;  ///< noise of the frame as its scout shows it, above 0
  double setting = 0.0;
  double error = 0.0;  ///< measured
};

/// log error = level + slope · log scout at each setting that was observed; between them, and
/// beyond as in the last piece, its value goes straight over the logarithm of the setting. Fitted
/// by least squares. Few pilots know little of a slope: each setting's is drawn half-way to the one
/// that fits them all, which is held between 0 and 1.5.
class ErrorModel {
 public:
  /// Observations whose scout or error is not above 0 are left out. `is_usable` is false when fewer
  /// than two settings are left.
  explicit ErrorModel(const std::vector<Observation>& observations);

  bool is_usable() const { return settings_.size() >= 2; }
  /// Median of what is to be expected.
  double predict(double scout, double setting) const;
  /// Standard deviation of log(error / prediction) over the observations, at least 0.1: less
  /// cannot be known of a handful.
  double spread() const { return spread_; }
  double slope() const { return slope_; }  ///< the one that fits all settings

 private:
  std::vector<double> settings_;  ///< logarithms, rising
  std::vector<double> levels_;    ///< of each
  std::vector<double> slopes_;    ///< of each
  double slope_ = 1.0;
  double spread_ = 0.0;
};

/// The setting at which the prediction times `margin` is `max_error`, by bisection on its logarithm
/// between `least` and `most`; errors rise with the setting if `rising`. `least` or `most` when the
/// bound lies beyond.
double setting_for(const ErrorModel& model, double scout, double max_error, double margin,
                   double least, double most, bool rising);

/// z of which a share of a normal distribution lies below (share above 0 and below 1).
double normal_quantile(double share);

}  // namespace seedframe
