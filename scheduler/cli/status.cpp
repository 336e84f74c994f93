// seedframe status: how far a campaign is.

#include <memory>

#include <CLI/CLI.hpp>

#include "cli/verb.h"
#include "console/exit_code.h"
#include "console/progress.h"
#include "console/say.h"
#include "report/campaign_status.h"

namespace seedframe {
namespace {

struct StatusArguments {
  std::string folder;
  bool json = false;
};

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
    say("a frame takes a worker {:.3f} s ({:.3f} s of it to build the scene) and {:.3f} s "
        "beside it\n",
        frame_s, timings.build_s, timings.finish_s);
  } else {
    say("a frame takes a thread {:.3f} s\n", frame_s);
  }
  const auto left = static_cast<double>(counts.pending + counts.running);
  if (left > 0) {
    say("left for one {}: {}\n", rendered ? "worker" : "thread", duration_text(left * frame_s));
  }
}

void print_status(const CampaignStatus& status, const std::string& folder) {
  const FrameCounts& counts = status.counts;
  say("{} frames: {} done, {} running, {} pending, {} failed, {} quarantined{}\n", counts.total(),
      counts.done, counts.running, counts.pending, counts.failed, counts.quarantined,
      status.running ? " (a scheduler is at work)" : "");
  if (status.timings) print_timings(*status.timings, counts);
  if (status.twin.frames > 0) say("{}", twin_text(status.twin));
  if (status.promise) {
    for (const std::string& line : lines_of(*status.promise, folder)) say("{}\n", line);
  }
  if (!status.inputs_touched.empty()) {
    const std::size_t more = status.inputs_touched.size() - 1;
    say("{}{} changed or gone since its frames were made; 'seedframe resume {}' says what would be "
        "made again\n",
        printable(status.inputs_touched.front()),
        more == 0 ? " has" : fmt::format(" and {} more inputs have", more), folder);
  }
  for (const std::string& difference : mixed_provenances(status)) {
    say("some attempts were made with {}: their pixels are not comparable\n", difference);
  }
  for (const AttemptRow& row : status.failures) {
    say("frame {}, attempt {} ({}): {}\n", row.frame, row.attempt, to_string(row.outcome),
        row.message);
  }
  for (const FrameRow& row : status.quarantined) {
    say("frame {} is quarantined after {} crashes; see it again: {}\n", row.frame, row.crashes,
        command_to_reproduce(folder, row.frame));
  }
  if (!status.dataset_hash.empty()) {
    say("dataset hash {}\n", status.dataset_hash);
  } else if (!status.running) {
    say("'seedframe resume {}' renders the rest\n", folder);
  }
}

int show_status(const StatusArguments& arguments) {
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  const Result<CampaignStatus> status = read_status(*campaign);
  if (!status) return report(status.error());
  if (arguments.json) {
    fmt::print("{}", readable_json(to_json(*status)));
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
