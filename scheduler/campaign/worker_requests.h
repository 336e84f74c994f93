// What a worker of this machine is started with, and what it is asked for: the same for the frames
// of a campaign and for those that are rendered beside it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/error.h"
#include "campaign/run_options.h"
#include "render/message.h"
#include "scene/expanded_frame.h"

namespace seedframe {

/// With what only the folder says that the workers write to. `work`: for their temporary files.
WorkerOptions worker_options(const RunOptions& options, const std::filesystem::path& work,
                             std::function<std::filesystem::path(int worker)> log_path);

/// Asks for the frame's spec as it is, whatever its id says. Writes the mesh buffers that are not
/// at `mesh_path` (of a SHA-256) yet, whose folder exists.
Result<RenderRequest> make_render_request(
    const ExpandedFrame& frame, const std::filesystem::path& output,
    const std::function<std::filesystem::path(const std::string& sha256)>& mesh_path);

}  // namespace seedframe
