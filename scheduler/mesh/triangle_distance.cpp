#include "mesh/triangle_distance.h"

#include <algorithm>

namespace seedframe {
namespace {

using Vector = Eigen::Vector3d;

// Of b, for the point of the segment a–b that is nearest to p.
double segment_weight(const Vector& p, const Vector& a, const Vector& b) {
  const double length = (b - a).squaredNorm();
  return length > 0.0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
}

// Of a triangle without area: the nearest point of its three sides.
Vector nearest_weights_of_sides(const Vector& p, const Vector& a, const Vector& b,
                                const Vector& c) {
  const double ab = segment_weight(p, a, b);
  const double bc = segment_weight(p, b, c);
  const double ca = segment_weight(p, c, a);
  const Vector candidates[] = {{1.0 - ab, ab, 0.0}, {0.0, 1.0 - bc, bc}, {ca, 0.0, 1.0 - ca}};
  const auto distance = [&](const Vector& w) {
    return (w.x() * a + w.y() * b + w.z() * c - p).squaredNorm();
  };
  return *std::min_element(
      std::begin(candidates), std::end(candidates),
      [&](const Vector& s, const Vector& t) { return distance(s) < distance(t); });
}

}  // namespace

Vector nearest_weights(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = b - a;
  const Vector ac = c - a;
  const Vector ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
  const Vector bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
  const Vector cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
  const double wa = d3 * d6 - d5 * d4;
  const double wb = d5 * d2 - d1 * d6;
  const double wc = d1 * d4 - d3 * d2;
  const double sum = wa + wb + wc;
  if (wa > 0.0 && wb > 0.0 && wc > 0.0 && sum > 0.0) return {wa / sum, wb / sum, wc / sum};
  return nearest_weights_of_sides(p, a, b, c);
}

// The same regions as in nearest_weights, and those of the sides: it is asked millions of times.
double squared_distance_to_triangle(const Vector& p, const Vector& a, const Vector& b,
                                    const Vector& c) {
  const Vector ab = b - a;
  const Vector ac = c - a;
  const Vector ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return ap.squaredNorm();
  const Vector bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return bp.squaredNorm();
  const Vector cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return cp.squaredNorm();
  const double wa = d3 * d6 - d5 * d4;
  const double wb = d5 * d2 - d1 * d6;
  const double wc = d1 * d4 - d3 * d2;
  const double sum = wa + wb + wc;
  // Of a sliver, rounding would name the wrong side.
  constexpr double kSliver = 1e-10;
  if (sum <= kSliver * ab.squaredNorm() * ac.squaredNorm()) {
    const Vector w = nearest_weights_of_sides(p, a, b, c);
    return (w.x() * a + w.y() * b + w.z() * c - p).squaredNorm();
  }
  if (wc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
  if (wb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
  if (wa <= 0.0) {
    const double from_b = d4 - d3;
    const double from_c = d5 - d6;
    return (bp - from_b / (from_b + from_c) * (c - b)).squaredNorm();
  }
  return (ap - wb / sum * ab - wc / sum * ac).squaredNorm();
}

double squared_distance_to_segment(const Vector& p, const Vector& a, const Vector& b) {
  const double t = segment_weight(p, a, b);
  return (a + t * (b - a) - p).squaredNorm();
}

}  // namespace seedframe
