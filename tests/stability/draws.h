// What the cases draw at random, the same in every run.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "base/philox.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// Uniform numbers in the order in which they are asked for.
class Draws {
 public:
  explicit Draws(const std::string& name) : stream_(17, name) {}
  double operator()(double low, double high) {
    return low + (high - low) * stream_.uniform({0, 0, next_++, 0});
  }
  Eigen::Quaterniond rotation() {
    const Eigen::Vector3d axis((*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1));
    return Eigen::Quaterniond(Eigen::AngleAxisd((*this)(0, 6.28), axis.normalized()));
  }

 private:
  PhiloxStream stream_;
  std::uint32_t next_ = 0;
};

inline Affine placed(const Eigen::Vector3d& at, double scale, const Eigen::Quaterniond& turn) {
  Affine map = Affine::Identity();
  map.translate(at).rotate(turn).scale(scale);
  return map;
}

}  // namespace seedframe
