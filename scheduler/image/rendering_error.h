// How far a rendering is from what it would be with endless samples. docs/error_metrics.md says
// what each number is good for.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "image/edge_error.h"
#include "image/image.h"

namespace seedframe {

/// Means over pixels and their three channels, of scene-linear RGB; x is a value of the rendering,
/// r of the reference.
struct SquaredErrors {
  double mse = 0.0;  ///< (x − r)²
  /// (x − r)² / (r² + 0.01): Rousselle, Knaus and Zwicker, "Adaptive Sampling and Reconstruction
  /// using Greedy Error Minimization" (2011).
  double rel_mse = 0.0;
  /// (x − r)² / (m + 0.01)², where m is the mean of the three channels of the reference's pixel, 0
  /// if that is less: the MRSE of pbrt-v4's imgtool, which has each channel's own r in place of m.
  /// With the mean, a saturated colour's dark channels do not outweigh all else. Weighs dark pixels
  /// up to a hundred times as much as rel_mse.
  double mrse = 0.0;

  double rmse() const;  ///< √mse, in the unit of the pictures
};

struct LinearError {
  std::int64_t pixels = 0;      ///< that are compared; all else is 0 if there is none
  std::int64_t not_finite = 0;  ///< pixels left out: NaN or infinite in either picture
  SquaredErrors squared;
  std::array<double, 3> bias = {};  ///< mean of x − r by channel; noise has none, denoisers may
  /// Mean luminance (Rec. 709) of the rendering over that of the reference, less 1; 0 if both are
  /// black, infinite if only the reference is.
  double luminance_bias = 0.0;
};

/// Of display RGB, in codes of 8 bits.
struct DisplayError {
  std::int64_t pixels = 0;
  double mse = 0.0;            ///< codes², over all values
  double bias = 0.0;           ///< mean of x − r, over all values
  std::optional<double> ssim;  ///< as ssim() has it
  double flip = 0.0;           ///< mean of flip_map()

  double rmse() const;     ///< codes
  double psnr_db() const;  ///< of a range of 255; infinite when nothing differs
};

/// Pictures are of the same size, with 3 or 4 channels, alpha is ignored (asserted).
LinearError linear_error(const Image<float>& rendering, const Image<float>& reference);
DisplayError display_error(const Image<std::uint8_t>& rendering,
                           const Image<std::uint8_t>& reference);

/// A picture twice: scene-linear, and as it is displayed.
struct Picture {
  Image<float> linear;
  Image<std::uint8_t> display;
};

struct RenderingError {
  LinearError linear;
  DisplayError display;
  EdgeError edges;  ///< in codes of the display
};

RenderingError rendering_error(const Picture& rendering, const Picture& reference,
                               const Image<std::uint16_t>& ids);

// A reference is noisy too. Let it be the mean of two renderings A and B of the same frame with
// independent samples; its own variance is then the mean of (A − B)² / 4. What is measured against
// it is on average E[(x − r)²] = MSE(x) + variance(r), if the rendering's samples are independent
// of both, so the variance is subtracted. (x − r)² − (A − B)² / 4 is (x − A)(x − B), whose mean is
// the MSE of x.

/// Value by value, all channels; of the same size (asserted).
Image<float> mean_of(const Image<float>& half_a, const Image<float>& half_b);

/// What of squared errors is the reference's own.
struct ReferenceVariance {
  SquaredErrors linear;  ///< weighted as the errors are, with the halves' mean for r
  double display = 0.0;  ///< codes²
  double edges = 0.0;    ///< codes², of EdgeError::mean_square
};

SquaredErrors linear_variance(const Image<float>& half_a, const Image<float>& half_b);
/// For a reference which is the display of the halves' mean. That is not the mean of their
/// displays, but where noise is less than the display's curve is bent, the two have the same
/// variance, down to what rounding to codes adds (1/12 code² each to a rendering and a reference,
/// of which a reference that is all but free of noise has nothing that could be subtracted).
double display_variance(const Image<std::uint8_t>& half_a, const Image<std::uint8_t>& half_b);
ReferenceVariance reference_variance(const Picture& half_a, const Picture& half_b,
                                     const Image<std::uint16_t>& ids);

/// max(0, measured − variance): by chance less may be measured than the reference's own variance.
double without_variance(double measured, double variance);
SquaredErrors without_variance(const SquaredErrors& measured, const SquaredErrors& variance);
/// Biases, SSIM, FLIP and contrasts stay what they are.
RenderingError without_variance(const RenderingError& measured, const ReferenceVariance& variance);

}  // namespace seedframe
