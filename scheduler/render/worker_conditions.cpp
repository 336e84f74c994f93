#include "render/worker_conditions.h"

#include <array>
#include <cstdlib>

#include <fmt/format.h>

namespace seedframe {
namespace {

struct IsaRow {
  const char* cycles;      ///< name of Cycles' kernel
  const char* embree;      ///< and of Embree's
  const char* next_above;  ///< forbids Cycles all kernels above
};

/// Cycles tries its kernels from the best on, and skips those that a variable forbids.
constexpr std::array<IsaRow, 4> kRows = {{{"sse2", "sse2", "CYCLES_CPU_NO_SSE3"},
                                          {"sse41", "sse4.2", "CYCLES_CPU_NO_AVX"},
                                          {"avx", "avx", "CYCLES_CPU_NO_AVX2"},
                                          {"avx2", "avx2", ""}}};

const IsaRow& row_of(Isa isa) { return kRows[static_cast<std::size_t>(isa)]; }

}  // namespace

std::map<std::string, std::string> environment_of(const WorkerConditions& conditions,
                                                  const std::filesystem::path& preload) {
  std::map<std::string, std::string> environment;
  const char* others = std::getenv("LD_PRELOAD");
  const bool alone = others == nullptr || *others == '\0';
  if (!preload.empty()) {
    environment["LD_PRELOAD"] = preload.string() + (alone ? "" : fmt::format(":{}", others));
  }
  if (conditions.isa) {
    const IsaRow& row = row_of(*conditions.isa);
    environment["SEEDFRAME_EMBREE_ISA"] = row.embree;
    if (*row.next_above != '\0') environment[row.next_above] = "1";
  }
  return environment;
}

Status check_worker(const WorkerConditions& asked, const ReadyMessage& ready) {
  if (!asked.isa) return {};
  const IsaRow& row = row_of(*asked.isa);
  if (ready.kernel != row.cycles) {
    return fail(ErrorKind::kEnvironment,
                "the config pins Cycles to its kernel {}, and this machine uses {}: the CPU is too "
                "old, this Blender has no such kernel, or a variable CYCLES_CPU_NO_… forbids it. "
                "Set determinism.isa to what all machines have; see docs/determinism.md",
                row.cycles, ready.kernel);
  }
  if (ready.embree != row.embree) {
    return fail(ErrorKind::kEnvironment,
                "the config pins Embree to its kernels {}, and this Blender uses {}: its Embree is "
                "no library of its own, which could be told so. Use the Blender of Debian's "
                "package, or determinism: machine",
                row.embree, ready.embree.empty() ? "others that it does not tell" : ready.embree);
  }
  return {};
}

}  // namespace seedframe
