#include "slurm/cluster_state.h"

#include <fmt/format.h>

#include "base/files.h"

namespace seedframe {

Json to_json(const ClusterState& state) {
  return {{"jobs", state.jobs},   {"waiting", state.waiting}, {"running", state.running},
          {"nodes", state.nodes}, {"frames", state.frames},   {"left_out", state.left_out}};
}

std::optional<ClusterState> read_cluster_state(const CampaignFiles& files) {
  const Result<std::string> text = read_file(files.slurm_state());
  if (!text) return std::nullopt;
  const Json json = Json::parse(*text, nullptr, false);
  try {
    ClusterState state;
    state.jobs = json.at("jobs").get<std::set<std::int64_t>>();
    state.waiting = integer_of<std::int64_t>(json.at("waiting"));
    state.running = integer_of<std::int64_t>(json.at("running"));
    state.nodes = json.at("nodes").get<std::set<std::string>>();
    state.frames = integer_of<std::int64_t>(json.at("frames"));
    state.left_out = json.at("left_out").get<std::set<std::string>>();
    return state;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

Result<std::vector<std::string>> read_nodes(const CampaignFiles& files) {
  std::error_code missing;
  if (!std::filesystem::exists(files.nodes(), missing)) return std::vector<std::string>();
  const Result<std::string> text = read_file(files.nodes());
  if (!text) return forward_error(text);
  const Json json = Json::parse(*text, nullptr, false);
  try {
    return json.get<std::vector<std::string>>();
  } catch (const Json::exception&) {
    return fail(ErrorKind::kCorrupt, "{} is not a list of nodes", files.nodes().string());
  }
}

Result<std::map<std::int64_t, std::string>> nodes_of(const Campaign& campaign,
                                                     const std::vector<std::int64_t>& frames) {
  const Result<std::vector<std::string>> nodes = read_nodes(campaign.files);
  if (!nodes) return forward_error(nodes);
  std::map<std::int64_t, std::string> made_on;
  for (const std::int64_t frame : frames) {
    const auto attempts = campaign.store.attempts(frame);
    if (!attempts) return forward_error(attempts);
    for (const AttemptRow& attempt : *attempts) {
      const int node = attempt.worker / kNodeWorkers;
      const bool known = attempt.worker >= 0 && node < static_cast<int>(nodes->size());
      if (attempt.outcome != AttemptOutcome::kDone || !known) continue;
      made_on[frame] = (*nodes)[static_cast<std::size_t>(node)];
    }
  }
  return made_on;
}

std::string worker_name(int worker, const std::vector<std::string>& nodes) {
  const int node = worker / kNodeWorkers;
  if (worker < 0 || node >= static_cast<int>(nodes.size())) {
    return fmt::format("worker {}", worker);
  }
  return fmt::format("worker {} on {}", worker % kNodeWorkers,
                     nodes[static_cast<std::size_t>(node)]);
}

}  // namespace seedframe
