#include "campaign/worker_requests.h"

#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "base/files.h"
#include "render/sandbox.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// What no worker needs, and none gets, so that one that runs wild takes neither memory nor disk
/// from the others.
ResourceLimits worker_limits(const RunOptions& options) {
  constexpr std::uint64_t kMostFrames = 10'000;  // of a worker that is never worn out
  constexpr std::uint64_t kLargestFile = 16ULL << 30;
  constexpr std::uint64_t kOpenFiles = 4096;
  const std::uint64_t frames = options.pool.frames_per_worker > 0
                                   ? static_cast<std::uint64_t>(options.pool.frames_per_worker)
                                   : kMostFrames;
  const auto frame_s = static_cast<std::uint64_t>(options.pool.frame_timeout.count() / 1000 + 1);
  return {.memory_bytes = static_cast<std::uint64_t>(system_memory_bytes()),
          .cpu_s = (frames + 1) * frame_s * static_cast<std::uint64_t>(options.worker.threads),
          .file_bytes = kLargestFile,
          .open_files = kOpenFiles};
}

}  // namespace

WorkerOptions worker_options(const RunOptions& options, const fs::path& work,
                             std::function<fs::path(int worker)> log_path) {
  WorkerOptions worker = options.worker;
  worker.log_path = std::move(log_path);
  worker.limits = worker_limits(options);
  if (options.sandbox) {
    std::vector<fs::path> inputs = options.input_folders;
    inputs.push_back(worker.scripts);
    inputs.push_back(worker.preload);
    if (!options.meshes.empty()) inputs.push_back(options.meshes);
    const BlenderProgram& blender = worker.blender;
    inputs.push_back(blender.path.parent_path());
    if (!blender.module
             .empty()) {  // a virtual environment's bin/python, and what is installed in it
      inputs.push_back(blender.path.parent_path().parent_path());
      inputs.push_back(blender.module.parent_path());
    }
    worker.wrapper = sandbox_arguments(work, inputs);
  }
  // A killed Blender leaves its temporary folder behind; here it goes with the rest of work/.
  std::error_code ignored;
  worker.environment.emplace("TMPDIR", fs::absolute(work, ignored).string());
  return worker;
}

Result<RenderRequest> make_render_request(
    const ExpandedFrame& frame, const fs::path& output,
    const std::function<fs::path(const std::string& sha256)>& mesh_path) {
  RenderRequest request;
  request.spec = canonical_text(frame.spec);
  request.frame_id = frame.id;
  std::error_code error;
  request.output = fs::absolute(output, error);
  for (const auto& [sha256, buffer] : frame.meshes) {
    const fs::path path = mesh_path(sha256);
    if (!fs::exists(path, error)) {
      // Scratch: nobody reads it after a crash. Whole under its name, for who shares the folder.
      const fs::path part = path.string() + fmt::format(".{}.part", ::getpid());
      if (Status written = write_file_unsynced(part, *buffer); !written) {
        return forward_error(written);
      }
      fs::rename(part, path, error);
      if (error) return system_failure("rename", part, error.value());
    }
    request.meshes[sha256] = fs::absolute(path, error);
  }
  const auto add_image = [&](const std::string& sha256) {
    request.textures[sha256] = fs::absolute(frame.used.images.at(sha256)->path, error);
  };
  for (const MaterialSpec& material : frame.spec.materials) {
    for (const auto& texture : material.textures) add_image(texture.second);
  }
  if (!frame.spec.world.hdri.empty()) add_image(frame.spec.world.hdri);
  return request;
}

}  // namespace seedframe
