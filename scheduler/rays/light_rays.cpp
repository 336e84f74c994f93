// RayScene::find_shadows and find_hits.
#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>

#include <embree3/rtcore.h>

#include "rays/scene_trees.h"

namespace seedframe {
namespace {

constexpr std::size_t kLanes = 8;
using Wanted = std::array<std::int32_t, kLanes>;

/// Up to eight rays into the lanes of a packet; the lanes beyond them are not wanted.
void aim(RTCRay8& packet, Wanted& wanted, std::span<const LightRay> rays, double ray_start_m) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    wanted[lane] = lane < rays.size() ? -1 : 0;
    if (lane >= rays.size()) continue;
    const LightRay& ray = rays[lane];
    packet.org_x[lane] = static_cast<float>(ray.from.x());
    packet.org_y[lane] = static_cast<float>(ray.from.y());
    packet.org_z[lane] = static_cast<float>(ray.from.z() + ray_start_m);
    packet.dir_x[lane] = static_cast<float>(ray.direction.x());
    packet.dir_y[lane] = static_cast<float>(ray.direction.y());
    packet.dir_z[lane] = static_cast<float>(ray.direction.z());
    packet.tnear[lane] = 0.0F;
    packet.tfar[lane] = static_cast<float>(ray.length_m);
    packet.mask[lane] = 0xffffffffU;
  }
}

/// Calls body(first, rays) for the rays, eight at a time.
template <class Body>
void in_packets(std::span<const LightRay> rays, const Body& body) {
  for (std::size_t first = 0; first < rays.size(); first += kLanes) {
    body(first, rays.subspan(first, std::min(kLanes, rays.size() - first)));
  }
}

}  // namespace

void RayScene::find_shadows(std::span<const LightRay> rays,
                            std::span<std::uint8_t> in_shadow) const {
  assert(rays.size() == in_shadow.size());
  const RTCScene scene = scene_->throwing_shadows();
  RTCRay8 packet{};
  alignas(32) Wanted wanted{};
  in_packets(rays, [&](std::size_t first, std::span<const LightRay> some) {
    aim(packet, wanted, some, scene_->camera.ray_start_m);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(wanted.data(), scene, &context, &packet);
    for (std::size_t lane = 0; lane < some.size(); ++lane) {
      in_shadow[first + lane] = packet.tfar[lane] < 0.0F ? 1 : 0;
    }
  });
}

void RayScene::find_hits(std::span<const LightRay> rays, std::span<LightHit> hits) const {
  assert(rays.size() == hits.size());
  const RTCScene scene = scene_->throwing_shadows();
  RTCRayHit8 packet{};
  alignas(32) Wanted wanted{};
  in_packets(rays, [&](std::size_t first, std::span<const LightRay> some) {
    aim(packet.ray, wanted, some, scene_->camera.ray_start_m);
    std::fill_n(packet.hit.geomID, kLanes, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packet.hit.instID[0], kLanes, RTC_INVALID_GEOMETRY_ID);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect8(wanted.data(), scene, &context, &packet);
    for (std::size_t lane = 0; lane < some.size(); ++lane) {
      const bool met = packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
      hits[first + lane] = {met ? static_cast<int>(packet.hit.instID[0][lane]) : -1,
                            packet.hit.primID[lane], packet.ray.tfar[lane]};
    }
  });
}

}  // namespace seedframe
