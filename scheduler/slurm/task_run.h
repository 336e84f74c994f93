// One array task: takes its batch, makes its frames in a campaign of its own on the node, and
// brings them to where the head finds them.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "campaign/run_setup.h"

namespace seedframe {

struct TaskOrder {
  std::filesystem::path submission;  ///< its folder (SubmissionFiles)
  int batch = 0;
  std::string node;  ///< this one's name
  std::string task;  ///< "<job>_<index>"
  int cpus = 0;      ///< that it may use; 0: the node's
  RunPlaces places;  ///< of the program; its cache is not used
};

/// What came of it, for the task's log, in a sentence. That somebody else has the batch is no
/// error, nor that frames failed. What else went wrong is told to the head, too, if there was a way
/// to. SIGTERM drains it; when what is under way then takes too long, it is dropped.
Result<std::string> run_task(const TaskOrder& order);

}  // namespace seedframe
