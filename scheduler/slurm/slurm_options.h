// What a run on a Slurm cluster is asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"

namespace seedframe {

struct SlurmOptions {
  std::string partition;          ///< empty: Slurm's default
  int nodes = 0;                  ///< most tasks at once, each on one node; 0: as Slurm likes
  std::int64_t time_s = 0;        ///< most time of a task; 0: its partition's
  int cpus = 0;                   ///< of a task; 0: as many as the partition's smallest node has
  std::vector<std::string> more;  ///< options of sbatch, as they are
  int batch_frames = 0;           ///< frames of a task; 0: chosen (task_plan.h)
  double poll_s = 5.0;            ///< from one look at the queue to the next
  /// On each node, for what its tasks work with; empty: seedframe-<user id> in its TMPDIR or /tmp.
  std::filesystem::path node_folder;
  /// By frame: the node that must not make it (an audit).
  std::map<std::int64_t, std::string> avoid;
};

/// All but `avoid`.
Json to_json(const SlurmOptions& options);
/// Reads what to_json wrote; the error (kCorrupt) names `what`.
Result<SlurmOptions> slurm_options_from_json(const Json& json, const std::string& what);

/// As sbatch takes a time: "90" (minutes), "90:30", "1:30:00", "2-12", "2-12:30", "2-12:30:00".
/// kInput: none of these.
Result<std::int64_t> read_slurm_time(const std::string& text);
/// "1:30:00", of whole minutes, rounded up.
std::string slurm_time(double seconds);

}  // namespace seedframe
