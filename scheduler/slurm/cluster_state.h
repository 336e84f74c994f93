// How far a run by Slurm is, for who looks at the campaign from outside.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "campaign/campaign.h"
#include "frames/campaign_files.h"

namespace seedframe {

struct ClusterState {
  std::set<std::int64_t> jobs;
  std::int64_t waiting = 0;  ///< tasks
  std::int64_t running = 0;
  std::set<std::string> nodes;     ///< that those run on
  std::int64_t frames = 0;         ///< that are with tasks
  std::set<std::string> left_out;  ///< nodes that get no more tasks
};

Json to_json(const ClusterState& state);

/// As the last head wrote it; none: no run by Slurm is under way, or it cannot be read.
std::optional<ClusterState> read_cluster_state(const CampaignFiles& files);

/// Worker w of the n-th node is kNodeWorkers × n + w: the store knows workers by numbers.
inline constexpr int kNodeWorkers = 1000;

/// The campaign's nodes, by number; none if no frame of it came from another machine. kCorrupt: the
/// list is damaged.
Result<std::vector<std::string>> read_nodes(const CampaignFiles& files);

/// The node that made each of these frames, if one did that has a name.
Result<std::map<std::int64_t, std::string>> nodes_of(const Campaign& campaign,
                                                     const std::vector<std::int64_t>& frames);

/// "worker 3", or "worker 3 on n2".
std::string worker_name(int worker, const std::vector<std::string>& nodes);

}  // namespace seedframe
