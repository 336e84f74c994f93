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
#include <link.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

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

/// The name of the library in which Embree lies, as the loader knows it.
struct EmbreeLibrary {
  char path[4096] = "";
};

int find_embree(dl_phdr_info* library, size_t, void* found) {
  if (library->dlpi_name == nullptr || strstr(library->dlpi_name, "/libembree") == nullptr) {
    return 0;
  }
  snprintf(static_cast<EmbreeLibrary*>(found)->path, sizeof(EmbreeLibrary::path), "%s",
           library->dlpi_name);
  return 1;
}

/// A function of Embree; null if there is no Embree. The module bpy loads it for itself alone,
/// where RTLD_NEXT does not look.
void* embree_function(const char* name) {
  if (void* next = dlsym(RTLD_NEXT, name)) return next;
  EmbreeLibrary library;
  if (dl_iterate_phdr(find_embree, &library) == 0) return nullptr;
  void* handle = dlopen(library.path, RTLD_LAZY | RTLD_NOLOAD);  // is never closed: it is in use
  return handle == nullptr ? nullptr : dlsym(handle, name);
}

using NewDevice = void* (*)(const char*);

/// Whether this Embree was built with kernels for AVX-512, which that of the module bpy was not. Of
/// its device's properties only that of rays by 16 depends on it.
bool embree_has_avx512() {
  constexpr int kNativeRay16Supported = 34;  // RTC_DEVICE_PROPERTY_… of Embree 3 and 4
  using GetProperty = ssize_t (*)(void*, int);
  using Release = void (*)(void*);
  const auto make = reinterpret_cast<NewDevice>(embree_function("rtcNewDevice"));
  const auto property = reinterpret_cast<GetProperty>(embree_function("rtcGetDeviceProperty"));
  const auto release = reinterpret_cast<Release>(embree_function("rtcReleaseDevice"));
  if (make == nullptr || property == nullptr || release == nullptr) return true;
  void* device = make("isa=avx512");
  if (device == nullptr) return true;
  const bool has = property(device, kNativeRay16Supported) != 0;
  release(device);
  return has;
}

/// As Embree names them, best first; what Embree 3.13 and 4 themselves ask of a CPU for each.
const char* best_of_cpu() {
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

const char* best_embree_isa() {
  const char* best = best_of_cpu();
  if (strcmp(best, "avx512") != 0) return best;
  static int has = -1;  // several threads may find out at once, and find the same
  if (__atomic_load_n(&has, __ATOMIC_RELAXED) < 0) {
    __atomic_store_n(&has, embree_has_avx512() ? 1 : 0, __ATOMIC_RELAXED);
  }
  return __atomic_load_n(&has, __ATOMIC_RELAXED) == 1 ? best : "avx2";
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
  const auto original = reinterpret_cast<NewDevice>(embree_function("rtcNewDevice"));
  if (original == nullptr) return nullptr;  // nobody calls it then
  char text[512];
  const bool some = config != nullptr && *config != '\0';
  const int length = snprintf(text, sizeof text, "%s%sisa=%s", some ? config : "", some ? "," : "",
                              seedframe_embree_isa());
  const bool fits = length > 0 && length < static_cast<int>(sizeof text);
  return original(fits ? text : config);
}
}
