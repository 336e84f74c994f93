// What decides over the last bits of a picture beside the frame spec, as far as it can be chosen.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/isa.h"
#include "render/message.h"
#include "spec/render_device.h"

namespace seedframe {

/// By the names that Cycles and Embree give them.
struct Kernels {
  std::string cycles;
  std::string embree;

  bool operator==(const Kernels&) const = default;
};
/// Both with the same instructions.
Kernels kernels_of(Isa isa);

struct WorkerConditions {
  /// On any CPU that has them; none: the best of the CPU.
  std::optional<Kernels> kernels;
  /// Cycles keeps scenes from frame to frame: pixels then depend on the frames before.
  bool persistent_data = false;
  RenderDevice device = RenderDevice::kCpu;
  bool denoise = false;  ///< Open Image Denoise is needed
};

/// Variables for the worker: which kernels, the library to be preloaded that says and pins Embree's
/// (preload/worker_cpu.cpp), and, unless the user has set MALLOC_CONF, an allocator that keeps its
/// memory from frame to frame.
std::map<std::string, std::string> environment_of(const WorkerConditions& conditions,
                                                  const std::filesystem::path& preload);

/// Whether a worker is as it was asked to be; kEnvironment: its machine or its Blender cannot.
Status check_worker(const WorkerConditions& asked, const ReadyMessage& ready);

}  // namespace seedframe
