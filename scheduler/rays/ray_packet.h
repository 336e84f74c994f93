// Eight neighbouring pixels' rays at a time: as many as AVX2 has lanes. Included by sources only.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <embree3/rtcore.h>

#include "rays/pixel_camera.h"

namespace seedframe {

/// Four columns by two rows, or any eight pixels. Lane 4j + i is column i of row j.
struct RayPacket {
  static constexpr int kColumns = 4;
  static constexpr int kRows = 2;
  static constexpr std::size_t kLanes = kColumns * kRows;
  static constexpr unsigned kEveryInstance = 0xffffffffU;

  alignas(32) std::array<std::int32_t, kLanes> wanted{};  ///< -1: to be traced; 0: not
  RTCRayHit8 rays{};

  explicit RayPacket(const PixelCamera& camera)
      : start_m_(camera.ray_start_m),
        start_(static_cast<float>(start_m_)),
        far_(static_cast<float>(std::max(0.0, camera.clip_end_m - start_m_))) {
    const double near = std::max(0.0, camera.clip_start_m - start_m_);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // z of the direction is -1, so the ray's parameter is the depth from where it begins, and the
      // clips are its ends.
      rays.ray.dir_z[lane] = -1.0F;
      rays.ray.tnear[lane] = static_cast<float>(near);
      rays.ray.mask[lane] = kEveryInstance;
    }
  }

  void aim_lane(std::size_t lane, float ray_x, float ray_y) {
    wanted[lane] = -1;
    rays.ray.dir_x[lane] = ray_x;
    rays.ray.dir_y[lane] = ray_y;
    rays.ray.org_x[lane] = ray_x * start_;
    rays.ray.org_y[lane] = ray_y * start_;
  }

  /// At pixels `step` apart. Lanes beyond `right` or `bottom` are not wanted.
  void aim(const PixelRays& pixels, int x, int y, int step, int right, int bottom) {
    std::size_t lane = 0;
    for (int j = 0; j < kRows; ++j) {
      const int row = y + j * step;
      for (int i = 0; i < kColumns; ++i, ++lane) {
        const int column = x + i * step;
        wanted[lane] = 0;
        if (column < right && row < bottom) aim_lane(lane, pixels.x(column), pixels.y(row));
      }
    }
  }

  void find_first_hits(RTCScene scene) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      rays.ray.tfar[lane] = far_;
      rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(wanted.data(), scene, &context, &rays);
  }

  /// After find_first_hits: the instance's index, or -1.
  int hit(std::size_t lane) const {
    if (wanted[lane] == 0 || rays.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return -1;
    return static_cast<int>(rays.hit.instID[0][lane]);
  }

  /// Of what the lane hits: planar, metres.
  double depth(std::size_t lane) const { return start_m_ + rays.ray.tfar[lane]; }

  /// Finds out what hits anything at all, which is cheaper, by the same arithmetic. Only instances
  /// that have one of the bits of `mask` can be hit.
  void find_any_hits(RTCScene scene, unsigned mask = kEveryInstance) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      rays.ray.tfar[lane] = far_;
      rays.ray.mask[lane] = mask;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(wanted.data(), scene, &context, &rays.ray);
  }

  /// After find_any_hits.
  bool hits(std::size_t lane) const { return wanted[lane] != 0 && rays.ray.tfar[lane] < 0.0F; }

 private:
  double start_m_;
  float start_;
  float far_;
};

}  // namespace seedframe
