// What computes the pixels.
#pragma once

#include <array>
#include <cstddef>

namespace seedframe {

/// The CPU, or all devices of a kind that the machine has, by Cycles' names for them.
enum class RenderDevice { kCpu, kCuda, kOptix, kHip, kOneapi, kMetal };
inline constexpr std::array<const char*, 6> kRenderDeviceNames = {"cpu", "cuda",   "optix",
                                                                  "hip", "oneapi", "metal"};

inline const char* name_of(RenderDevice device) {
  return kRenderDeviceNames[static_cast<std::size_t>(device)];
}

}  // namespace seedframe
