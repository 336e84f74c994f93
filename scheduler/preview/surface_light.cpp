#include "preview/surface_light.h"

#include <array>
#include <cmath>
#include <numbers>

#include "image/luminance.h"

namespace seedframe {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

static_assert(kLampPlaces == kSamplesOfMean);

/// A lamp's light on every pixel. First each fourth is looked at; another one only where those
/// around it are not all lit or all in the dark, or on another surface.
class LampLight {
 public:
  LampLight(const SeenPoints& points, const RayScene& scene)
      : points_(points),
        scene_(scene),
        all_(points.all_pixels()),
        fourth_(points.one_of_four()),
        is_inside_(all_.pixels.size(), 0) {
    for (int row = 0; row < all_.height; ++row) {
      for (int column = 0; column < all_.width; ++column) {
        const std::int32_t pixel = all_.at(row, column);
        if (pixel < 0 || !points.on_surface_around(fourth_, row, column)) continue;
        is_inside_[static_cast<std::size_t>(pixel)] = 1;
      }
    }
  }

  void add(const Lamp& lamp, std::vector<Vector3f>& sums) {
    const std::size_t count = all_.pixels.size();
    lit_.assign(count, kUnknown);
    for (int row = 0; row < fourth_.height; ++row) {
      for (int column = 0; column < fourth_.width; ++column) {
        look(lamp, fourth_.at(row, column));
      }
      find_shadows();
    }
    for (int row = 0; row < all_.height; ++row) {
      for (int column = 0; column < all_.width; ++column) {
        const std::int32_t pixel = all_.at(row, column);
        if (pixel < 0 || lit_[static_cast<std::size_t>(pixel)] != kUnknown) continue;
        if (!settled(row, column)) look(lamp, pixel);
      }
      find_shadows();
    }
    if (lamp.has_size()) points_.smooth(all_, lit_, 1);
    const Vector3f power = lamp.power().cast<float>();
    for (std::size_t i = 0; i < count; ++i) {
      if (lit_[i] > 0.0F) sums[i] += reached(lamp, i) * lit_[i] * power;
    }
  }

 private:
  static constexpr float kUnknown = -1.0F;

  /// W/m² of a watt, if nothing is in between.
  float reached(const Lamp& lamp, std::size_t pixel) const {
    const auto at = static_cast<std::int32_t>(pixel);
    return static_cast<float>(
        lamp.irradiance(points_.position(at).cast<double>(), points_.normal(at).cast<double>()));
  }

  void look(const Lamp& lamp, std::int32_t pixel) {
    if (pixel < 0) return;
    const auto at = static_cast<std::size_t>(pixel);
    if (reached(lamp, at) <= 0.0F) {
      lit_[at] = 0.0F;
      return;
    }
    pixels_.push_back(at);
    const std::size_t place = sample_number(pixel / all_.width, pixel % all_.width);
    rays_.push_back(lamp.ray_from(points_.above(pixel), place));
  }

  /// Of what was looked at since the last time.
  void find_shadows() {
    in_shadow_.resize(rays_.size());
    scene_.find_shadows(rays_, in_shadow_);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      lit_[pixels_[i]] = in_shadow_[i] == 0 ? 1.0F : 0.0F;
    }
    rays_.clear();
    pixels_.clear();
  }

  /// By the points around the pixel, which are known.
  bool settled(int row, int column) {
    const auto pixel = static_cast<std::size_t>(all_.at(row, column));
    if (is_inside_[pixel] == 0) return false;
    const std::array<std::int32_t, 4> around = points_around(fourth_, row, column);
    const float lit = lit_[static_cast<std::size_t>(around.front())];
    for (const std::int32_t other : around) {
      if (lit_[static_cast<std::size_t>(other)] != lit) return false;
    }
    lit_[pixel] = lit;
    return true;
  }

  const SeenPoints& points_;
  const RayScene& scene_;
  PixelGrid all_, fourth_;
  std::vector<std::uint8_t> is_inside_;  ///< by pixel: the points around it are on its surface
  std::vector<float> lit_;               ///< share of the lamp that is seen from each pixel
  std::vector<LightRay> rays_;           ///< and the pixels from which they go
  std::vector<std::size_t> pixels_;
  std::vector<std::uint8_t> in_shadow_;
};

/// Light that comes from no lamp: from around, and from other surfaces.
class ScatteredLight {
 public:
  ScatteredLight(const SeenPoints& points, const RayScene& scene, const SurfaceColors& colors,
                 const LightSources& sources)
      : points_(points),
        scene_(scene),
        colors_(colors),
        sources_(sources),
        grid_(points.one_of_four()) {}

  void add(std::vector<Vector3f>& sums) {
    values_.assign(grid_.pixels.size() * kChannels, 0.0F);
    for (int row = 0; row < grid_.height; ++row) look(row);
    // Sixteen directions are few where bright things are near: twice, and so without a shift.
    points_.smooth(grid_, values_, kChannels, SeenPoints::Reach::kOneBefore);
    points_.smooth(grid_, values_, kChannels, SeenPoints::Reach::kTwoBefore);
    const std::vector<std::int32_t> point_of_pixel = points_.points_for_pixels(grid_);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (point_of_pixel[i] < 0) continue;
      const float* value = &values_[static_cast<std::size_t>(point_of_pixel[i]) * kChannels];
      const float open_share = value[1] > 0.0F ? value[0] / value[1] : 0.0F;
      sums[i] += open_share * from_around(points_.normal(static_cast<std::int32_t>(i))) +
                 std::numbers::pi_v<float> * Vector3f(value[2], value[3], value[4]);
    }
  }

 private:
  /// Of a ray: the brightness of the surroundings behind it, if they are seen; the same in any
  /// case; the light of the surface that is seen.
  static constexpr int kChannels = 5;

  Vector3f from_around(const Vector3f& normal) const {
    const Vector3f turned = sources_.ambient_from_camera * normal;
    return sources_.ambient.irradiance(turned).cwiseProduct(sources_.ambient_color);
  }

  void look(int row) {
    rays_.clear();
    places_.clear();
    for (int column = 0; column < grid_.width; ++column) {
      const std::int32_t pixel = grid_.at(row, column);
      if (pixel < 0) continue;
      const Vector3d normal = points_.normal(pixel).cast<double>();
      const Vector3d across = normal.unitOrthogonal();
      const auto [x, y] = disc_points()[sample_number(row, column)];
      const Vector3d direction = x * across + y * normal.cross(across) +
                                 std::sqrt(std::max(0.0, 1.0 - x * x - y * y)) * normal;
      rays_.push_back({points_.above(pixel), direction});
      places_.push_back(static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width) +
                        static_cast<std::size_t>(column));
    }
    hits_.resize(rays_.size());
    scene_.find_hits(rays_, hits_);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      float* value = &values_[places_[i] * kChannels];
      const Vector3f turned = sources_.ambient_from_camera * rays_[i].direction.cast<float>();
      const Vector3f around =
          sources_.ambient.radiance(turned).cwiseProduct(sources_.ambient_color);
      value[1] = static_cast<float>(luminance(around.x(), around.y(), around.z()));
      if (hits_[i].instance < 0) {
        value[0] = value[1];
      } else {
        Eigen::Map<Vector3f>(value + 2) = sent_on(rays_[i], hits_[i]);
      }
    }
  }

  Vector3f sent_on(const LightRay& ray, const LightHit& hit) const {
    constexpr float kOpen = 0.7F;  // of the surroundings, seen from there
    const auto instance = static_cast<std::size_t>(hit.instance);
    Vector3f normal = colors_.normal(instance, hit.triangle);
    if (normal.dot(ray.direction.cast<float>()) > 0.0F) normal = -normal;
    const Vector3d point = ray.from + double{hit.distance_m} * ray.direction;
    Vector3f irradiance = kOpen * from_around(normal);
    for (const Lamp& lamp : sources_.lamps) {
      irradiance += (lamp.irradiance(point, normal.cast<double>()) * lamp.power()).cast<float>();
    }
    return colors_.mean_color(instance, hit.triangle).cwiseProduct(irradiance) /
           std::numbers::pi_v<float>;
  }

  const SeenPoints& points_;
  const RayScene& scene_;
  const SurfaceColors& colors_;
  const LightSources& sources_;
  PixelGrid grid_;
  std::vector<float> values_;
  std::vector<LightRay> rays_;  ///< of a row
  std::vector<std::size_t> places_;
  std::vector<LightHit> hits_;
};

}  // namespace

std::vector<Vector3f> light_on(const SeenPoints& points, const RayScene& scene,
                               const SurfaceColors& colors, const LightSources& sources) {
  std::vector<Vector3f> sums(points.rays().instance.size(), Vector3f::Zero());
  LampLight lamps(points, scene);
  bool any = !sources.ambient_color.isZero();
  for (const Lamp& lamp : sources.lamps) {
    if (lamp.power().isZero()) continue;
    lamps.add(lamp, sums);
    any = true;
  }
  if (any) ScatteredLight(points, scene, colors, sources).add(sums);
  return sums;
}

}  // namespace seedframe
