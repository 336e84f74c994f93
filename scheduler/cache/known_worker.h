// What Blender and its workers said of themselves on this machine, so that none needs to be started
// to be asked. Only what cannot have changed since is believed; a worker that does start is asked.
#pragma once

#include <optional>
#include <string>

#include "base/canonical_json.h"
#include "base/error.h"
#include "cache/frame_cache.h"
#include "render/blender_info.h"
#include "render/message.h"
#include "render/worker_options.h"

namespace seedframe {

/// probe_blender, but a program that has told its version already, and whose file has not been
/// touched since, is neither started nor read. `cache` may be null.
Result<BlenderInfo> known_blender(FrameCache* cache, const std::string& program);

/// All that decides over what a worker says of itself: Blender, our scripts and libraries
/// (`facts`, what Provenance knows before any worker starts), the system's libraries, the CPU, and
/// the environment. 64 hex digits, or empty if it cannot be known.
std::string worker_identity(const Json& facts, const WorkerOptions& options);

/// What the last worker of this identity said when it was ready.
std::optional<ReadyMessage> recall_worker(FrameCache& cache, const std::string& identity);
void remember_worker(FrameCache& cache, const std::string& identity, const ReadyMessage& ready);

}  // namespace seedframe
