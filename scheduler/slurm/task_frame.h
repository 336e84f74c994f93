// What a task says of a frame that it has made, or could not make, and of itself.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "store/job_store.h"

namespace seedframe {

/// A frame that is over as far as the task is concerned. Written after the frame's folder has its
/// name, so that who reads it finds that complete.
struct TaskFrame {
  std::int64_t frame = 0;
  std::string frame_id;
  FrameState state = FrameState::kDone;  ///< or kFailed, or kQuarantined
  std::vector<AttemptRow> attempts;      ///< in the task, oldest first
  int workers = 1;                       ///< of the task
  double startup_s = 0.0;                ///< from the task's start to its first frame
  std::string node;
};

Json to_json(const TaskFrame& record);
/// kCorrupt: not what to_json made.
Result<TaskFrame> task_frame_from_json(const Json& json, const std::string& what);

/// The last that a task writes.
struct TaskEnd {
  bool stopped = false;  ///< it was told to
  Error error;           ///< why it could not go on; an empty message: it could
};
Json to_json(const TaskEnd& end);
TaskEnd task_end_from_json(const Json& json);

/// Names in a batch's results.
namespace batch_files {
inline constexpr const char* kEnd = "end.json";
std::string frame(std::int64_t frame);             ///< its folder, once it is complete
std::string record(std::int64_t frame);            ///< "000042.json"
std::string rejected(std::int64_t frame);          ///< folder with what was not as its twin sees it
std::string log(std::int64_t frame, int attempt);  ///< the last words of a worker that it cost
}  // namespace batch_files

}  // namespace seedframe
