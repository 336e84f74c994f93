// The messages between scheduler and worker, docs/formats/worker-protocol.md.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <variant>

#include "base/error.h"
#include "render/frame_job.h"

namespace seedframe {

inline constexpr int kWorkerProtocol = 5;

/// Everything a worker needs to render one frame.
struct RenderRequest {
  std::string spec;                                       ///< the frame spec as one line of JSON
  std::string frame_id;                                   ///< is to be noted in the file
  std::filesystem::path output;                           ///< EXR to write; its folder exists
  std::map<std::string, std::filesystem::path> meshes;    ///< SHA-256 -> mesh buffer
  std::map<std::string, std::filesystem::path> textures;  ///< SHA-256 -> image file
  bool sample_counts = false;  ///< the file is to say how many samples pixels had
  bool save_scene = false;     ///< the scene is to be saved as saved_scene(output)
};

/// Where the time of a rendered frame went, in seconds.
struct RenderTimings {
  double build_s = 0.0;   ///< in the worker: from the message to a complete scene
  double render_s = 0.0;  ///< in the worker: Cycles, and writing the EXR
  double total_s = 0.0;   ///< in the scheduler: from sending the request to its answer
  double cpu_s = 0.0;     ///< of all threads of the worker, for both
};

/// The worker can take frames. What it says of itself belongs in the provenance.
struct ReadyMessage {
  int protocol = 0;
  std::string blender;      ///< "3.4.1"
  std::string build;        ///< Blender's build hash
  std::string ocio_config;  ///< path of the colour configuration that Blender uses
  std::string kernel;       ///< that Cycles uses: "avx2", "avx", "sse42", "sse41", "sse3", "sse2"
  std::string embree;       ///< kernels that Embree uses: "avx512", "avx2", …; empty: unknown
  std::string reciprocals;  ///< hash of the CPU's approximate reciprocals; empty: unknown
  std::string libc;         ///< "glibc 2.36"
  std::string device;       ///< "cpu", or the devices that it renders on; empty: there are none
  std::string devices;      ///< all that there are: "CPU (…), CUDA (…)"
  std::string denoisers;    ///< "OpenImageDenoise", or empty
};

/// Comes every few seconds, whatever else the worker does.
struct AliveMessage {
  std::int64_t memory_bytes = 0;  ///< resident
};

struct DoneMessage {
  FrameJob job;
  double build_s = 0.0;
  double render_s = 0.0;
  double cpu_s = 0.0;
};

struct FailedMessage {
  FrameJob job;
  std::string error;
};

using WorkerMessage = std::variant<ReadyMessage, AliveMessage, DoneMessage, FailedMessage>;

/// Where a worker saves the scene that it has rendered, with its images in it.
std::filesystem::path saved_scene(const std::filesystem::path& output);

/// One line, with its line feed.
std::string encode_render_message(const FrameJob& job, const RenderRequest& request);

/// Reads one line of a worker; kRender errors quote the beginning of what came instead.
Result<WorkerMessage> parse_worker_message(std::string_view line);

}  // namespace seedframe
