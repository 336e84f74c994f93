#include "render/worker_conditions.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>

namespace seedframe {
namespace {

struct KernelRow {
  const char* cycles;                       ///< name of Cycles' kernel
  const char* embree;                       ///< and of Embree's, with the same instructions
  std::array<const char*, 2> forbidden_by;  ///< variables, of which Cycles reads one
};

/// Cycles tries its kernels from the best on, and skips those that a variable forbids; which there
/// are depends on Blender's version. In the order of Isa.
constexpr std::array<KernelRow, 5> kRows = {
    {{"sse2", "sse2", {"CYCLES_CPU_NO_SSE2", ""}},
     {"sse41", "sse4.2", {"CYCLES_CPU_NO_SSE3", "CYCLES_CPU_NO_SSE41"}},
     {"sse42", "sse4.2", {"CYCLES_CPU_NO_SSE42", ""}},
     {"avx", "avx", {"CYCLES_CPU_NO_AVX", ""}},
     {"avx2", "avx2", {"CYCLES_CPU_NO_AVX2", ""}}}};

/// jemalloc, which Debian's Blender has, would give its pages back after each frame and be handed
/// zeroed ones for the next. It keeps what the largest frame had, and no more.
constexpr const char* kKeepPages = "dirty_decay_ms:-1,muzzy_decay_ms:-1,thp:always";

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

Status check_abilities(const WorkerConditions& asked, const ReadyMessage& ready) {
  if (asked.device != RenderDevice::kCpu && ready.device.empty()) {
    return fail(
        ErrorKind::kEnvironment,
        "render.device is {}, and Blender {} finds no such device on this machine, only {}. "
        "Install its driver, use a Blender that was built for it, or set render.device to "
        "what there is",
        name_of(asked.device), ready.blender, ready.devices.empty() ? "the CPU" : ready.devices);
  }
  if (asked.denoise && ready.denoisers.find("OpenImageDenoise") == std::string::npos) {
    return fail(
        ErrorKind::kEnvironment,
        "render.denoise needs Open Image Denoise, and this Blender {} was built without it. "
        "Use another one ('scripts/setup.sh --blender 4.5' installs one that has it), or "
        "set render.denoise to off",
        ready.blender);
  }
  return {};
}

}  // namespace

Kernels kernels_of(Isa isa) {
  const KernelRow& row = kRows[static_cast<std::size_t>(isa)];
  return {row.cycles, row.embree};
}

std::map<std::string, std::string> environment_of(const WorkerConditions& conditions,
                                                  const std::filesystem::path& preload) {
  std::map<std::string, std::string> environment;
  if (!preload.empty()) {
    const std::string others = is_set("LD_PRELOAD") ? std::getenv("LD_PRELOAD") : "";
    environment["LD_PRELOAD"] = preload.string() + (others.empty() ? "" : ":" + others);
  }
  if (!is_set("MALLOC_CONF")) environment["MALLOC_CONF"] = kKeepPages;
  if (conditions.kernels) {
    environment["SEEDFRAME_EMBREE_ISA"] = conditions.kernels->embree;
    const auto* row = std::find_if(kRows.begin(), kRows.end(), [&](const KernelRow& each) {
      return conditions.kernels->cycles == each.cycles;
    });
    while (row != kRows.end() && ++row != kRows.end()) {
      for (const char* variable : row->forbidden_by) {
        if (*variable != '\0') environment[variable] = "1";
      }
    }
  }
  return environment;
}

Status check_worker(const WorkerConditions& asked, const ReadyMessage& ready) {
  if (Status able = check_abilities(asked, ready); !able || !asked.kernels) return able;
  if (ready.kernel != asked.kernels->cycles) {
    return fail(ErrorKind::kEnvironment,
                "Cycles was to use its kernel {}, and on this machine it uses {}: the CPU is too "
                "old, this Blender has no such kernel, or a variable CYCLES_CPU_NO_… forbids it. "
                "Set determinism.isa to what all machines have; see docs/determinism.md",
                asked.kernels->cycles, ready.kernel);
  }
  if (ready.embree != asked.kernels->embree) {
    return fail(ErrorKind::kEnvironment,
                "Embree was to use its kernels {}, and this Blender uses {}: its Embree is "
                "not a library of its own, so it cannot be told. Use the Blender of Debian's "
                "package, or determinism: machine",
                asked.kernels->embree,
                ready.embree.empty() ? "others that it does not tell" : ready.embree);
  }
  return {};
}

}  // namespace seedframe
