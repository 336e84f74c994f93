// seedframe status: how far a campaign is.

#include <memory>

#include <CLI/CLI.hpp>

#include "campaign/campaign.h"
#include "campaign/provenance.h"
#include "cli/exit_code.h"
#include "cli/progress.h"
#include "cli/verb.h"

namespace seedframe {
namespace {

struct StatusArguments {
  std::string folder;
  bool json = false;
};

struct CampaignStatus {
  FrameCounts counts;
  std::optional<AttemptTimings> timings;
  std::vector<AttemptRow> failures;
  std::vector<FrameRow> quarantined;
  TwinSummary twin;
  std::string dataset_hash;
  std::vector<std::string> provenances;
  bool running = false;  ///< a scheduler is at work
};

constexpr int kTimedAttempts = 100;
constexpr int kShownFailures = 5;
constexpr int kShownQuarantined = 20;

Result<CampaignStatus> read_status(const Campaign& campaign) {
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
  status.running =
      !CampaignLock::acquire(campaign.files.lock(), std::chrono::milliseconds(0)).has_value();
  return status;
}

Json status_json(const CampaignStatus& status) {
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
  const TwinSummary& twin = status.twin;
  json["twin"] = {{"frames", twin.frames},
                  {"frames_differing", twin.frames_differing},
                  {"pixels", twin.sum.pixels},
                  {"inside_px", twin.sum.inside_px},
                  {"edge_px", twin.sum.edge_px}};
  if (status.timings) {
    json["mean_seconds"] = {{"build", status.timings->build_s},
                            {"render", status.timings->render_s},
                            {"finish", status.timings->finish_s}};
  }
  return json;
}

std::string twin_text(const TwinSummary& twin) {
  return fmt::format(
      "{} frames were compared with their twins: of {} pixels {} differ inside and {} at edges, in "
      "{} frames\n",
      twin.frames, twin.sum.pixels, twin.sum.inside_px, twin.sum.edge_px, twin.frames_differing);
}

void print_timings(const AttemptTimings& timings, const FrameCounts& counts) {
  const bool rendered = timings.render_s > 0.0;  // else there is no worker, only the twin
  const double frame_s = rendered ? timings.build_s + timings.render_s : timings.finish_s;
  if (rendered) {
    fmt::print(
        "a frame takes a worker {:.3f} s ({:.3f} s of it to build the scene) and {:.3f} s "
        "beside it\n",
        frame_s, timings.build_s, timings.finish_s);
  } else {
    fmt::print("a frame takes a thread {:.3f} s\n", frame_s);
  }
  const auto left = static_cast<double>(counts.pending + counts.running);
  if (left > 0) {
    fmt::print("left for one {}: {}\n", rendered ? "worker" : "thread",
               duration_text(left * frame_s));
  }
}

/// Says so if frames may differ for being made with different things.
void print_mixture(const std::vector<std::string>& provenances) {
  if (provenances.empty()) return;
  const auto json = [](const std::string& text) { return Json::parse(text, nullptr, false); };
  for (const std::string& text : provenances) {
    const std::string difference = describe_difference(json(text), json(provenances.front()));
    if (difference.empty()) continue;
    fmt::print("some attempts were made with {}: their pixels are not comparable\n", difference);
  }
}

void print_status(const CampaignStatus& status, const std::string& folder) {
  const FrameCounts& counts = status.counts;
  fmt::print("{} frames: {} done, {} running, {} pending, {} failed, {} quarantined{}\n",
             counts.total(), counts.done, counts.running, counts.pending, counts.failed,
             counts.quarantined, status.running ? " (a scheduler is at work)" : "");
  if (status.timings) print_timings(*status.timings, counts);
  if (status.twin.frames > 0) fmt::print("{}", twin_text(status.twin));
  print_mixture(status.provenances);
  for (const AttemptRow& row : status.failures) {
    fmt::print("frame {}, attempt {} ({}): {}\n", row.frame, row.attempt, to_string(row.outcome),
               row.message);
  }
  for (const FrameRow& row : status.quarantined) {
    fmt::print("frame {} is quarantined after {} crashes; see it again: {}\n", row.frame,
               row.crashes, command_to_reproduce(folder, row.frame));
  }
  if (!status.dataset_hash.empty()) {
    fmt::print("dataset hash {}\n", status.dataset_hash);
  } else if (!status.running) {
    fmt::print("'seedframe resume {}' renders the rest\n", folder);
  }
}

int show_status(const StatusArguments& arguments) {
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  const Result<CampaignStatus> status = read_status(*campaign);
  if (!status) return report(status.error());
  if (arguments.json) {
    fmt::print("{}", readable_json(status_json(*status)));
  } else {
    print_status(*status, arguments.folder);
  }
  return kExitOk;
}

}  // namespace

void add_status_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<StatusArguments>();
  CLI::App* verb = app.add_subcommand(
      "status",
      "counts by state, timings, last errors, and the dataset hash of a complete campaign");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  verb->add_flag("--json", arguments->json, "print it as JSON");
  verb->footer("Example: seedframe status results/parts");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return show_status(*arguments); }); });
}

}  // namespace seedframe
