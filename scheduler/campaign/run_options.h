// What a run is asked for, and what has been found and checked for it before it starts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "image/color_management.h"
#include "render/blender_info.h"
#include "render/worker_options.h"
#include "render/worker_pool.h"

namespace seedframe {

/// The options of submit and resume, which set its members; an audit varies them.
struct RunOptions {
  RunOptions() { pool.workers = worker.threads = 0; }

  /// Workers, their threads and their memory are chosen by set_up_run where they are 0. Without
  /// Blender `workers` are the frames that are traced at once, and `threads` those of each.
  PoolOptions pool;
  WorkerOptions worker;
  std::string blender = "blender";  ///< as find_blender takes it; becomes that of `worker`
  bool sandbox = false;             ///< see sandbox.h
  std::vector<std::filesystem::path> input_folders;  ///< what sandboxed workers read lies in them
  int cores = 0;                                     ///< that it may use; 0: the machine's
  /// For mesh buffers, which outlive the run there; empty: with what goes after it.
  std::filesystem::path meshes;
  bool no_cache = false;       ///< take no frame from the cache; frames are added all the same
  double pause_limit_s = 600;  ///< to wait for room when the disk is full; 0: not at all
  bool no_space_check = false;
  bool quiet = false;
};

class CampaignRun;
class Provenance;
class RunObserver;
struct Campaign;
struct PreparedCampaign;
struct RunSetup;

/// Makes a run of a campaign (make_run.h, slurm_factory.h).
using MakeRun = std::function<std::unique_ptr<CampaignRun>(
    Campaign& campaign, const PreparedCampaign& prepared, Provenance& provenance,
    const RunSetup& setup, RunObserver& observer)>;

struct RunSetup {
  RunOptions options;   ///< with every choice made, and Blender found
  BlenderInfo blender;  ///< of no meaning when nothing is rendered
  /// None: labels by geometry, and Blender is not needed.
  std::shared_ptr<const ColorManagement> color;
  std::filesystem::path cache;     ///< folder of the FrameCache; empty: there is none
  std::uint64_t frame_bytes = 0;   ///< that a frame takes on the disk, about
  std::vector<std::string> notes;  ///< that the user should read, a sentence each
  MakeRun make;                    ///< none: on this machine
};

}  // namespace seedframe
