// What Slurm's own programs say and do: sbatch, squeue, scancel, sinfo, scontrol.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "slurm/slurm_options.h"

namespace seedframe {

/// Of the controller, and of the partition that tasks go to.
struct SlurmCluster {
  int most_tasks = 1;  ///< of one array (MaxArraySize)
  int most_jobs = 1;   ///< that the controller keeps, of all users (MaxJobCount)
  int nodes = 1;       ///< that are not down
  int cpus = 1;        ///< of the smallest node
};

/// A task of an array that waits or runs.
struct QueuedTask {
  std::int64_t job = 0;  ///< of the array
  int index = 0;
  bool waits = false;
  std::string node;     ///< empty while it waits
  std::string comment;  ///< of its job
};

struct ArrayOrder {
  std::vector<int> indices;
  std::string name;
  std::string comment;
  std::filesystem::path script;  ///< gets the index by SLURM_ARRAY_TASK_ID
  std::filesystem::path logs;    ///< folder of the tasks' output, <job>_<index>.log
  double time_s = 0.0;           ///< 0: the partition's
  int cpus = 1;
  std::vector<std::string> exclude;  ///< nodes
};

/// Calls programs in PATH, each for a minute at most. kEnvironment errors: they are not there, or
/// the controller gives no answer, which may pass.
class SlurmCommands {
 public:
  explicit SlurmCommands(const SlurmOptions& options) : options_(options) {}

  Result<SlurmCluster> cluster() const;
  /// The job's id. kInput: Slurm refuses it for good, and says why. After any other error the job
  /// may be there all the same: its comment tells.
  Result<std::int64_t> submit(const ArrayOrder& order) const;
  /// All of this user's tasks.
  Result<std::vector<QueuedTask>> queue() const;
  /// Tasks of an array; `waiting_only`: those that have not begun.
  Status cancel(std::int64_t job, bool waiting_only) const;
  Status cancel_task(std::int64_t job, int index) const;
  /// SIGTERM to what tasks of the array are running.
  Status tell_to_stop(std::int64_t job) const;
  /// For tasks of the array that have not begun.
  Status exclude(std::int64_t job, const std::vector<std::string>& nodes) const;

 private:
  const SlurmOptions& options_;
};

// What the programs print, read; for tests.
Result<SlurmCluster> read_cluster(std::string_view config, std::string_view nodes);
std::vector<QueuedTask> read_queue(std::string_view text);
std::optional<std::int64_t> read_job_id(std::string_view text);
/// "0-99,105"; of indices in order.
std::string index_list(const std::vector<int>& indices);
/// Whether trying again would be of no use, told by what sbatch said.
bool is_refusal(std::string_view message);

}  // namespace seedframe
