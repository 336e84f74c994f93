// Preloaded into each Blender: what its CPU computes, and which of Embree's kernels it uses.
//
// Cycles chooses its own kernel by the CPU, and Embree, which finds what a ray hits, chooses
// another one by itself: on a CPU with AVX-512 images differ from those of one without, though
// Cycles' kernel is the same. Embree takes its choice as an argument of rtcNewDevice only, which
// Cycles leaves empty. This library stands in front of that function and adds the choice to the
// argument, so that it is known, and can be pinned with SEEDFRAME_EMBREE_ISA (docs/determinism.md).
//
// No C++ library and nothing that runs when it is loaded: whatever the worker starts may get it
// too.
#include <dlfcn.h>
#include <immintrin.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

namespace {

/// FNV-1a, 64 bits.
class Hash {
 public:
  void add(const void* data, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) {
      value_ = (value_ ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3ULL;
    }
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// As Embree names them, best first; what Embree 3.13 itself asks of a CPU for each.
const char* best_embree_isa() {
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl")) {
    return "avx512";
  }
  if (avx2) return "avx2";
  if (__builtin_cpu_supports("avx")) return "avx";
  if (__builtin_cpu_supports("sse4.2")) return "sse4.2";
  return "sse2";
}

}  // namespace

extern "C" {

/// The kernels that Embree uses in this process: "avx512", "avx2", "avx", "sse4.2" or "sse2".
const char* seedframe_embree_isa() {
  const char* pinned = getenv("SEEDFRAME_EMBREE_ISA");
  return pinned != nullptr && *pinned != '\0' ? pinned : best_embree_isa();
}

/// A hash over what the CPU's approximate reciprocals (rcpps, rsqrtps) answer for every leading 16
/// bits of mantissa in four octaves. Makers of CPUs use different tables, within the same specified
/// error, and Cycles computes with them: where this differs, pixels do.
uint64_t seedframe_reciprocals() {
  Hash hash;
  for (uint32_t i = 0; i < (4u << 16); i += 4) {
    uint32_t bits[4];
    for (uint32_t k = 0; k < 4; ++k) bits[k] = 0x3f000000u + ((i + k) << 7);  // from 0.5 to 8
    float values[4];
    memcpy(values, bits, sizeof values);
    const __m128 x = _mm_loadu_ps(values);
    _mm_storeu_ps(values, _mm_rcp_ps(x));
    hash.add(values, sizeof values);
    _mm_storeu_ps(values, _mm_rsqrt_ps(x));
    hash.add(values, sizeof values);
  }
  return hash.value();
}

/// Embree's, with the choice of kernels added to what the caller configures.
void* rtcNewDevice(const char* config) {  // NOLINT(readability-identifier-naming): Embree's name
  using NewDevice = void* (*)(const char*);
  const NewDevice original = reinterpret_cast<NewDevice>(dlsym(RTLD_NEXT, "rtcNewDevice"));
  if (original == nullptr) return nullptr;
  char text[512];
  const bool some = config != nullptr && *config != '\0';
  const int length = snprintf(text, sizeof text, "%s%sisa=%s", some ? config : "", some ? "," : "",
                              seedframe_embree_isa());
  const bool fits = length > 0 && length < static_cast<int>(sizeof text);
  return original(fits ? text : config);
}
}
