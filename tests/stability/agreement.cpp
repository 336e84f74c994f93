#include "tests/stability/agreement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/portable_math.h"

namespace seedframe {
namespace {

/// The step between float32 numbers of this size, above the least normal one.
double float_step(double value) {
  constexpr int kDigits = 23;  // after the first
  return std::ldexp(1.0, std::ilogb(value) - kDigits);
}

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / portable::kPi;
}

}  // namespace

double ErrorSamples::quantile(double share) const {
  if (errors_.empty()) return 0.0;
  std::vector<double> errors = errors_;
  const auto last = static_cast<double>(errors.size() - 1);
  const auto place = errors.begin() + static_cast<std::ptrdiff_t>(std::ceil(share * last));
  std::nth_element(errors.begin(), place, errors.end());
  return *place;
}

void Agreement::add(const ExactImage& exact, const FrameImages& images) {
  for (int row = 0; row < images.ids.height; ++row) {
    for (int column = 0; column < images.ids.width; ++column) {
      const ExactPixel& truth = exact.at(row, column);
      ++pixels;
      if (images.ids.at(row, column) != truth.id) {
        wrong += truth.tie ? 0 : 1;
        continue;
      }
      if (truth.id == 0) continue;
      const double depth = images.depth.at(row, column);
      depth_ulp.add(std::abs(depth - truth.depth) / float_step(truth.depth));
      const Eigen::Vector3d normal(images.normal.at(row, column, 0),
                                   images.normal.at(row, column, 1),
                                   images.normal.at(row, column, 2));
      normal_deg.add(degrees_between(normal, truth.normal));
    }
  }
}

void Judgement::add(const ExactImage& exact, const Image<std::uint16_t>& twin_ids,
                    const Image<std::uint16_t>& blender_ids) {
  for (int row = 0; row < twin_ids.height; ++row) {
    for (int column = 0; column < twin_ids.width; ++column) {
      const auto by_twin = twin_ids.at(row, column);
      const auto by_blender = blender_ids.at(row, column);
      if (by_twin == by_blender) continue;
      const ExactPixel& truth = exact.at(row, column);
      if (truth.tie) {
        ++ties;
      } else if (by_twin == truth.id) {
        ++twin;
      } else if (by_blender == truth.id) {
        ++blender;
      } else {
        ++nobody;
      }
    }
  }
}

}  // namespace seedframe
