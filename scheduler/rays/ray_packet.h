// Sixteen neighbouring pixels' rays at a time; included by ray_scene.cpp only.
#pragma once

#include <array>
#include <cstdint>

#include <embree3/rtcore.h>

#include "rays/ray_scene.h"

namespace seedframe {

/// Four columns by four rows, `step` pixels apart. Lane 4j + i is column i of row j.
struct RayPacket {
  static constexpr int kSide = 4;
  static constexpr int kLanes = kSide * kSide;

  alignas(64) std::array<std::int32_t, kLanes> wanted;  ///< -1: to be traced; 0: not
  RTCRayHit16 rays;

  /// Lanes beyond `right` or `bottom` are not wanted. Returns whether any is.
  bool aim(const PixelCamera& camera, int x, int y, int step, int right, int bottom) {
    bool any = false;
    for (int lane = 0; lane < kLanes; ++lane) {
      const int column = x + (lane % kSide) * step;
      const int row = y + (lane / kSide) * step;
      const auto l = static_cast<std::size_t>(lane);
      wanted[l] = column < right && row < bottom ? -1 : 0;
      any = any || wanted[l] != 0;
      // z of the direction is -1, so the ray's parameter is the depth, and the clips are its ends.
      rays.ray.dir_x[l] = static_cast<float>((column - camera.center_px[0]) / camera.focal_px[0]);
      rays.ray.dir_y[l] = static_cast<float>((camera.center_px[1] - row) / camera.focal_px[1]);
      rays.ray.dir_z[l] = -1.0f;
      rays.ray.org_x[l] = rays.ray.org_y[l] = rays.ray.org_z[l] = 0.0f;
      rays.ray.tnear[l] = static_cast<float>(camera.clip_start_m);
      rays.ray.tfar[l] = static_cast<float>(camera.clip_end_m);
      rays.ray.time[l] = 0.0f;
      rays.ray.mask[l] = 0xffffffffu;
      rays.ray.id[l] = rays.ray.flags[l] = 0;
      rays.hit.geomID[l] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][l] = RTC_INVALID_GEOMETRY_ID;
    }
    return any;
  }

  void find_first_hits(RTCScene scene) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(wanted.data(), scene, &context, &rays);
  }

  /// After find_first_hits: the instance's index, or -1.
  int hit(std::size_t lane) const {
    if (wanted[lane] == 0 || rays.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return -1;
    return static_cast<int>(rays.hit.instID[0][lane]);
  }

  /// Finds out what hits anything at all, which is cheaper, by the same arithmetic.
  void find_any_hits(RTCScene scene) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded16(wanted.data(), scene, &context, &rays.ray);
  }

  /// After find_any_hits.
  bool hits(std::size_t lane) const { return wanted[lane] != 0 && rays.ray.tfar[lane] < 0.0f; }
};

}  // namespace seedframe
