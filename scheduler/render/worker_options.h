// How workers of this machine are started.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "render/blender_program.h"
#include "render/child_process.h"
#include "render/memory.h"
#include "render/worker_conditions.h"

namespace seedframe {

struct WorkerOptions {
  BlenderProgram blender;         ///< to be started (BlenderInfo::program)
  std::filesystem::path scripts;  ///< the folder blender_scripts/
  std::filesystem::path preload;  ///< see environment_of; empty: nothing is
  int threads = 1;
  WorkerConditions conditions;
  /// Set in a worker's environment on top of worker_environment and environment_of.
  std::map<std::string, std::string> environment;
  bool ignores_terminate = false;    ///< see ChildCommand
  std::vector<std::string> wrapper;  ///< a program that starts it, see sandbox.h
  ResourceLimits limits;             ///< that no worker gets beyond
  /// Processes that the kernel has killed for lack of memory since it started.
  std::function<std::int64_t()> out_of_memory_kills = system_out_of_memory_kills;
  /// The log of each worker, which is appended to; its folder exists. CampaignFiles::worker_log
  /// fits.
  std::function<std::filesystem::path(int worker)> log_path;
};

}  // namespace seedframe
