#include "tests/stability/exact_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/pixel_rect.h"
#include "mesh/corner_normals.h"
#include "tests/stability/exact_hits.h"

namespace seedframe {
namespace {

using Eigen::Vector3d;

/// Above what a dozen operations in double round, relative to their largest terms.
constexpr double kRounding = 20 * std::numeric_limits<double>::epsilon();

/// In the camera's frame.
struct Triangle {
  Triangle(const Affine& map, const Mesh& mesh, std::size_t index) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = mesh.positions[mesh.triangles[index][k]];
      const Vector3d object(p[0], p[1], p[2]);
      corners[k] = map * object;
      error = std::max(
          error, map.linear().cwiseAbs().rowwise().sum().maxCoeff() * object.cwiseAbs().maxCoeff() +
                     map.translation().cwiseAbs().maxCoeff());
      reach = std::max(reach, corners[k].norm());
    }
    error *= kRounding;
    const auto& [a, b, c] = corners;
    normal = (b - a).cross(c - a);
    size = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  }

  std::array<Vector3d, 3> corners;
  Vector3d normal;     ///< not of unit length
  double error = 0.0;  ///< a bound of the corners' rounding, metres
  double reach = 0.0;  ///< the farthest corner's distance
  double size = 0.0;   ///< the longest side
};

enum class Verdict { kMiss, kHit, kDoubtful };

/// A ray and a triangle.
struct Meeting {
  Verdict verdict = Verdict::kMiss;
  double depth = 0.0;
  double depth_error = 0.0;           ///< a bound
  std::array<double, 3> shares = {};  ///< of the corners
};

Meeting meet(const Triangle& triangle, const Vector3d& ray, const CameraSpec& camera) {
  const auto& [a, b, c] = triangle.corners;
  const std::array<double, 3> sides = {ray.dot(b.cross(c - b)), ray.dot(c.cross(a - c)),
                                       ray.dot(a.cross(b - a))};  // opposite to a, b, c
  const double length = ray.norm();
  const double margin =
      4.0 * (triangle.error + kRounding * triangle.reach) * triangle.reach * length;
  const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
  if (*least<-margin&& * most> margin) return {};
  Meeting meeting;
  const bool inside = *least > margin || *most < -margin;
  const double slope = triangle.normal.dot(ray);
  const double steepness = std::abs(slope) / length;
  const double normal_error = 4.0 * triangle.error * triangle.size;
  if (steepness <= normal_error) {  // edge-on, as far as can be told
    return {Verdict::kDoubtful, std::numeric_limits<double>::quiet_NaN(), 0.0, {}};
  }
  meeting.depth = triangle.normal.dot(a) / slope;
  meeting.depth_error = (triangle.normal.norm() * (triangle.error + kRounding * triangle.reach) +
                         normal_error * triangle.size) /
                        std::abs(slope);
  const double sum = sides[0] + sides[1] + sides[2];
  for (std::size_t k = 0; k < 3; ++k) meeting.shares[k] = sides[k] / sum;
  const auto beyond = [&](double clip, double sign) {
    return sign * (meeting.depth - clip) > meeting.depth_error;
  };
  if (beyond(camera.clip_start_m, -1.0) || beyond(camera.clip_end_m, 1.0)) return {};
  const bool within = beyond(camera.clip_start_m, 1.0) && beyond(camera.clip_end_m, -1.0);
  meeting.verdict = inside && within ? Verdict::kHit : Verdict::kDoubtful;
  return meeting;
}

/// The pixels whose rays may meet the triangle.
PixelRect pixels_of(const Triangle& triangle, const FrameSpec& spec) {
  const CameraSpec& camera = spec.camera;
  const PixelRect all{0, 0, spec.render.width, spec.render.height};
  const auto before = std::count_if(triangle.corners.begin(), triangle.corners.end(),
                                    [](const Vector3d& p) { return p.z() < 0.0; });
  if (before == 0) return {};
  constexpr double kFlat = 1e-9;  // so near to the camera's plane projections say nothing
  Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const Vector3d& p : triangle.corners) {
    if (-p.z() < kFlat * triangle.reach) return all;
    const Eigen::Array2d at(camera.center_px[0] - camera.focal_px[0] * p.x() / p.z(),
                            camera.center_px[1] + camera.focal_px[1] * p.y() / p.z());
    low = low.min(at);
    high = high.max(at);
  }
  constexpr double kRim = 1e-3;
  const auto first = [&](int axis, int size) {
    return static_cast<int>(std::ceil(std::clamp(low[axis] - kRim, 0.0, size * 1.0)));
  };
  const auto last = [&](int axis, int size) {
    return static_cast<int>(std::floor(std::clamp(high[axis] + kRim, -1.0, size - 1.0)));
  };
  const int x = first(0, all.width), y = first(1, all.height);
  return {x, y, std::max(0, last(0, all.width) - x + 1), std::max(0, last(1, all.height) - y + 1)};
}

Vector3d ray_of(const CameraSpec& camera, int x, int y) {
  return {(x - camera.center_px[0]) / camera.focal_px[0],
          (camera.center_px[1] - y) / camera.focal_px[1], -1.0};
}

/// A triangle of a frame.
struct Place {
  std::int64_t instance = -1;  ///< index in the spec; -1: none
  std::size_t triangle = 0;
};

/// The nearest that certainly is hit.
struct Nearest {
  Meeting meeting;
  Place place;
};

/// Whether a meeting could change what the pixel shows.
bool matters(const Meeting& meeting, const Place& place, const Nearest& nearest) {
  if (nearest.place.instance < 0 || std::isnan(meeting.depth)) return true;
  const double doubt = meeting.depth_error + nearest.meeting.depth_error;
  const double behind = meeting.depth - nearest.meeting.depth;
  if (meeting.verdict == Verdict::kDoubtful && behind < -doubt) return true;
  return place.instance != nearest.place.instance && behind <= doubt;
}

using Solids = std::vector<const ExactTracer::Solid*>;  // by the instance's index

/// The search for what the pixels of one frame show.
class Search {
 public:
  Search(const FrameSpec& spec, Solids solids)
      : spec_(spec),
        solids_(std::move(solids)),
        width_(spec.render.width),
        nearest_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(spec.render.height)) {}

  ExactImage image() {
    find_nearest();
    ExactImage image{width_, std::vector<ExactPixel>(nearest_.size()), 0};
    decide_doubtful(image);
    for (std::size_t pixel = 0; pixel < nearest_.size(); ++pixel) {
      if (nearest_[pixel].place.instance >= 0) shade(pixel, image.pixels[pixel]);
    }
    return image;
  }

 private:
  Vector3d ray(std::size_t pixel) const {
    const auto index = static_cast<int>(pixel);
    return ray_of(spec_.camera, index % width_, index / width_);
  }
  const InstanceSpec& instance(const Place& place) const {
    return spec_.instances[static_cast<std::size_t>(place.instance)];
  }
  const ExactTracer::Solid& solid(const Place& place) const {
    return *solids_[static_cast<std::size_t>(place.instance)];
  }

  /// body(pixel, place, meeting) for whatever may be hit.
  template <class Body>
  void for_each_meeting(const Body& body) const {
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      const Mesh& mesh = solids_[i]->mesh;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle triangle(spec_.instances[i].camera_from_object, mesh, t);
        const PixelRect rect = pixels_of(triangle, spec_);
        for (int y = rect.y; y < rect.end_y(); ++y) {
          for (int x = rect.x; x < rect.end_x(); ++x) {
            const Meeting meeting = meet(triangle, ray_of(spec_.camera, x, y), spec_.camera);
            if (meeting.verdict == Verdict::kMiss) continue;
            body(static_cast<std::size_t>(y * width_ + x), Place{static_cast<std::int64_t>(i), t},
                 meeting);
          }
        }
      }
    }
  }

  void find_nearest() {
    for_each_meeting([&](std::size_t pixel, const Place& place, const Meeting& meeting) {
      Nearest& found = nearest_[pixel];
      const bool nearer = found.place.instance < 0 || meeting.depth < found.meeting.depth;
      if (meeting.verdict == Verdict::kHit && nearer) found = {meeting, place};
    });
  }

  void decide_doubtful(ExactImage& image) {
    std::map<std::size_t, std::vector<Nearest>> candidates;  // by pixel
    for_each_meeting([&](std::size_t pixel, const Place& place, const Meeting& meeting) {
      if (matters(meeting, place, nearest_[pixel])) candidates[pixel];
    });
    if (candidates.empty()) return;
    for_each_meeting([&](std::size_t pixel, const Place& place, const Meeting& meeting) {
      const auto found = candidates.find(pixel);
      if (found != candidates.end()) found->second.push_back({meeting, place});
    });
    for (const auto& [pixel, met] : candidates) {
      const auto index = static_cast<int>(pixel);
      const ExactHit hit =
          exact_first_hit(spec_.camera, index % width_, index / width_, triangles_of(met));
      image.pixels[pixel].tie = hit.tie;
      nearest_[pixel] = hit.triangle < 0 ? Nearest() : met[static_cast<std::size_t>(hit.triangle)];
      nearest_[pixel].meeting.depth = hit.depth;
    }
    image.asked = static_cast<std::int64_t>(candidates.size());
  }

  std::vector<ExactTriangle> triangles_of(const std::vector<Nearest>& candidates) const {
    std::vector<ExactTriangle> triangles;
    for (const auto& [meeting, place] : candidates) {
      const Mesh& mesh = solid(place).mesh;
      ExactTriangle& triangle = triangles.emplace_back();
      triangle.instance = &instance(place);
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.object_corners[k] = mesh.positions[mesh.triangles[place.triangle][k]];
      }
    }
    return triangles;
  }

  void shade(std::size_t pixel, ExactPixel& shown) const {
    const auto& [meeting, place] = nearest_[pixel];
    const Affine& map = instance(place).camera_from_object;
    Vector3d normal = Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& n = solid(place).normals[3 * place.triangle + k];
      normal += meeting.shares[k] * Vector3d(n[0], n[1], n[2]);
    }
    normal = (map.linear().inverse().transpose() * normal).normalized();
    const Triangle triangle(map, solid(place).mesh, place.triangle);
    shown.id = static_cast<std::uint16_t>(instance(place).id);
    shown.depth = meeting.depth;
    shown.normal = triangle.normal.dot(ray(pixel)) > 0.0 ? Vector3d(-normal) : normal;
  }

  const FrameSpec& spec_;
  Solids solids_;
  int width_;
  std::vector<Nearest> nearest_;  ///< by pixel
};

}  // namespace

const ExactTracer::Solid& ExactTracer::solid(const std::string& mesh) {
  const auto [found, is_new] = solids_.try_emplace(mesh);
  if (is_new) {
    found->second.mesh = *mesh_from_buffer(*buffers_.at(mesh), "mesh");
    const Mesh& read = found->second.mesh;
    found->second.normals = corner_normals(read.positions, read.triangles, read.smooth_angle_rad);
  }
  return found->second;
}

ExactImage ExactTracer::trace(const FrameSpec& spec) {
  std::vector<const Solid*> solids;
  for (const InstanceSpec& instance : spec.instances) solids.push_back(&solid(instance.mesh));
  return Search(spec, std::move(solids)).image();
}

}  // namespace seedframe
