#include "report/campaign_status.h"

#include <algorithm>

#include "base/folder_lock.h"
#include "campaign/input_files.h"
#include "campaign/provenance.h"

namespace seedframe {
namespace {

constexpr int kTimedAttempts = 100;
constexpr int kShownFailures = 5;
constexpr int kShownQuarantined = 20;

/// Of a run that is under way.
void add_progress(const RunProgress& progress, const std::vector<std::string>& nodes, double now,
                  CampaignStatus& status) {
  for (const WorkerRow& row : progress.workers) {
    status.workers.push_back(
        {row, worker_name(row.worker, nodes), row.frame ? std::max(0.0, now - row.since) : 0.0});
  }
  const bool traced = status.timings && status.timings->render_s == 0.0;
  if (traced) status.workers.clear();  // its threads have no numbers
  const double elapsed_s = now - progress.began;
  if (progress.done < 2 || elapsed_s <= 0.0) return;
  status.left_s = static_cast<double>(status.counts.pending + status.counts.running) * elapsed_s /
                  static_cast<double>(progress.done);
}

}  // namespace

Result<CampaignStatus> read_status(const Campaign& campaign, double now) {
  CampaignStatus status;
  const auto counts = campaign.store.counts();
  if (!counts) return forward_error(counts);
  status.counts = *counts;
  const auto timings = campaign.store.mean_timings(kTimedAttempts);
  if (!timings) return forward_error(timings);
  status.timings = *timings;
  const auto failures = campaign.store.recent_failures(kShownFailures);
  if (!failures) return forward_error(failures);
  status.failures = *failures;
  const auto quarantined = campaign.store.frames_in(FrameState::kQuarantined, kShownQuarantined);
  if (!quarantined) return forward_error(quarantined);
  status.quarantined = *quarantined;
  const auto twin = campaign.store.twin_summary();
  if (!twin) return forward_error(twin);
  status.twin = *twin;
  const auto hash = campaign.store.dataset_hash();
  if (!hash) return forward_error(hash);
  status.dataset_hash = *hash;
  const auto provenances = campaign.store.provenances();
  if (!provenances) return forward_error(provenances);
  status.provenances = *provenances;
  auto promise = read_promise_status(campaign);
  if (!promise) return forward_error(promise);
  status.promise = std::move(*promise);
  auto touched = inputs_touched(campaign);
  if (!touched) return forward_error(touched);
  status.inputs_touched = std::move(*touched);
  status.cluster = read_cluster_state(campaign.files);
  const auto lock = FolderLock::acquire(campaign.files.lock(), std::chrono::milliseconds(0));
  status.running = !lock && lock.error().kind == ErrorKind::kInput;  // held, not out of reach
  if (status.running) {
    const auto progress = campaign.store.run_progress();
    if (!progress) return forward_error(progress);
    const auto nodes = read_nodes(campaign.files);
    if (!nodes) return forward_error(nodes);
    add_progress(*progress, *nodes, now, status);
  }
  return status;
}

Json to_json(const CampaignStatus& status) {
  Json failures = Json::array();
  for (const AttemptRow& row : status.failures) {
    failures.push_back({{"frame", row.frame},
                        {"attempt", row.attempt},
                        {"outcome", to_string(row.outcome)},
                        {"message", row.message}});
  }
  Json quarantined = Json::array();
  for (const FrameRow& row : status.quarantined) {
    quarantined.push_back({{"frame", row.frame}, {"crashes", row.crashes}, {"error", row.error}});
  }
  Json json = {{"frames", status.counts.total()},   {"done", status.counts.done},
               {"pending", status.counts.pending},  {"running", status.counts.running},
               {"failed", status.counts.failed},    {"quarantined", status.counts.quarantined},
               {"quarantined_frames", quarantined}, {"active", status.running},
               {"recent_failures", failures},       {"dataset_hash", status.dataset_hash}};
  json["provenances"] = Json::array();
  for (const std::string& text : status.provenances) {
    json["provenances"].push_back(Json::parse(text, nullptr, /*allow_exceptions=*/false));
  }
  json["inputs_touched"] = status.inputs_touched;
  json["quality"] = status.promise ? to_json(*status.promise) : Json();
  const TwinSummary& twin = status.twin;
  json["twin"] = {{"frames", twin.frames},
                  {"frames_differing", twin.frames_differing},
                  {"pixels", twin.sum.pixels},
                  {"inside_px", twin.sum.inside_px},
                  {"edge_px", twin.sum.edge_px}};
  json["workers"] = Json::array();
  for (const WorkerStatus& worker : status.workers) {
    json["workers"].push_back({{"worker", worker.row.worker},
                               {"name", worker.name},
                               {"done", worker.row.done},
                               {"failed", worker.row.failed},
                               {"frame_s", worker.row.frame_s},
                               {"frame", worker.row.frame ? Json(*worker.row.frame) : Json()},
                               {"frame_for_s", worker.frame_for_s}});
  }
  json["cluster"] = status.cluster ? to_json(*status.cluster) : Json();
  json["left_s"] = status.left_s ? Json(*status.left_s) : Json();
  if (status.timings) {
    json["mean_seconds"] = {{"build", status.timings->build_s},
                            {"render", status.timings->render_s},
                            {"finish", status.timings->finish_s}};
  }
  return json;
}

std::vector<std::string> mixed_provenances(const CampaignStatus& status) {
  std::vector<std::string> differences;
  const auto json = [](const std::string& text) { return Json::parse(text, nullptr, false); };
  for (const std::string& text : status.provenances) {
    std::string difference = describe_difference(json(text), json(status.provenances.front()));
    if (!difference.empty()) differences.push_back(std::move(difference));
  }
  return differences;
}

}  // namespace seedframe
