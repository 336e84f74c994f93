// How far images of a frame are from what exact arithmetic says of it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "image/image.h"
#include "tests/stability/exact_image.h"

namespace seedframe {

/// What the twin or Blender says of a frame.
struct FrameImages {
  Image<std::uint16_t> ids;
  Image<float> depth;   ///< planar, metres
  Image<float> normal;  ///< x, y, z in the camera's frame
};

/// Many errors of one kind.
class ErrorSamples {
 public:
  void add(double error) { errors_.push_back(error); }
  bool empty() const { return errors_.empty(); }
  /// The least that a `share` of all errors do not exceed; 0 when there are none.
  double quantile(double share) const;

 private:
  std::vector<double> errors_;
};

struct Agreement {
  std::int64_t pixels = 0;
  std::int64_t wrong = 0;  ///< of them, those that show another id; never where there is a tie
  /// Where the id is right: in units of the last place of the exact depth as a float32.
  ErrorSamples depth_ulp;
  ErrorSamples normal_deg;

  void add(const ExactImage& exact, const FrameImages& images);
};

/// Of the pixels where twin and Blender differ, who shows what exact arithmetic says.
struct Judgement {
  std::int64_t twin = 0;
  std::int64_t blender = 0;
  std::int64_t nobody = 0;
  std::int64_t ties = 0;  ///< both are right

  void add(const ExactImage& exact, const Image<std::uint16_t>& twin,
           const Image<std::uint16_t>& blender);
};

}  // namespace seedframe
