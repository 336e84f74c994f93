// seedframe status: how far a campaign is.

#include <memory>

#include <CLI/CLI.hpp>
#include <unistd.h>

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

/// Lines that no terminal of 80 columns breaks in the middle of a word; elsewhere as they are, for
/// whoever reads them with a program.
template <class... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  constexpr std::size_t kColumns = 80;
  const std::string line = fmt::format(format, std::forward<Arguments>(arguments)...);
  say("{}\n", ::isatty(STDOUT_FILENO) != 0 ? wrapped(line, kColumns) : line);
}

void tell_twin(const TwinSummary& twin) {
  tell(
      "{} frames were compared with their twins: of {} pixels {} differ inside and {} at edges, in "
      "{} frames",
      twin.frames, twin.sum.pixels, twin.sum.inside_px, twin.sum.edge_px, twin.frames_differing);
}

void tell_timings(const AttemptTimings& timings, const CampaignStatus& status) {
  const bool rendered = timings.render_s > 0.0;  // else there is no worker, only the twin
  const double frame_s = rendered ? timings.build_s + timings.render_s : timings.finish_s;
  if (rendered) {
    tell(
        "a frame takes a worker {:.3f} s ({:.3f} s of it to build the scene) and {:.3f} s beside "
        "it",
        frame_s, timings.build_s, timings.finish_s);
  } else {
    tell("a frame takes a thread {:.3f} s", frame_s);
  }
  const auto left = static_cast<double>(status.counts.pending + status.counts.running);
  if (left > 0 && !status.running) {
    tell("left for one {}: {}", rendered ? "worker" : "thread", duration_text(left * frame_s));
  }
}

void tell_cluster(const ClusterState& cluster, bool running, const std::string& folder) {
  tell("in Slurm: {} tasks run{}, {} wait (jobs {}); {} frames are with them", cluster.running,
       cluster.nodes.empty() ? "" : fmt::format(" on {}", fmt::join(cluster.nodes, ", ")),
       cluster.waiting, fmt::join(cluster.jobs, ", "), cluster.frames);
  if (!cluster.left_out.empty()) {
    tell("no more tasks are given to {}, where they made nothing",
         fmt::join(cluster.left_out, ", "));
  }
  if (!running) {
    tell("that was when the last run ended: 'seedframe resume {}' collects what they make", folder);
  }
}

/// A line for each that is at work, and when they will be done.
void tell_progress(const CampaignStatus& status) {
  for (const WorkerStatus& worker : status.workers) {
    const WorkerRow& row = worker.row;
    tell("  {:<10} {:>6} frame{} done{}{}{}", worker.name, row.done, row.done == 1 ? "" : "s",
         row.done > 0 ? fmt::format(", {:.2f} s each", row.frame_s) : "",
         row.failed > 0 ? fmt::format(", {} failed", row.failed) : "",
         row.frame
             ? fmt::format(", at frame {} for {}", *row.frame, duration_text(worker.frame_for_s))
         : status.cluster ? ""
                          : ", idle");
  }
  if (status.left_s) tell("left: about {}", duration_text(*status.left_s));
}

void tell_troubles(const CampaignStatus& status, const std::string& folder) {
  if (!status.inputs_touched.empty()) {
    const std::size_t more = status.inputs_touched.size() - 1;
    tell(
        "{}{} changed or gone since its frames were made; 'seedframe resume {}' says what would be "
        "made again",
        printable(status.inputs_touched.front()),
        more == 0 ? " has" : fmt::format(" and {} more inputs have", more), folder);
  }
  for (const std::string& difference : mixed_provenances(status)) {
    tell("some attempts were made with {}: their pixels are not comparable", difference);
  }
  for (const AttemptRow& row : status.failures) {
    tell("frame {}, attempt {} ({}): {}", row.frame, row.attempt, to_string(row.outcome),
         row.message);
  }
  for (const FrameRow& row : status.quarantined) {
    tell("frame {} is quarantined after {} crashes; see it again: {}", row.frame, row.crashes,
         command_to_reproduce(folder, row.frame));
  }
}

void print_status(const CampaignStatus& status, const std::string& folder) {
  const FrameCounts& counts = status.counts;
  tell("{} frames: {} done, {} running, {} pending, {} failed, {} quarantined{}", counts.total(),
       counts.done, counts.running, counts.pending, counts.failed, counts.quarantined,
       status.running ? " (at work)" : "");
  tell_progress(status);
  if (status.cluster) tell_cluster(*status.cluster, status.running, folder);
  if (status.timings) tell_timings(*status.timings, status);
  if (status.twin.frames > 0) tell_twin(status.twin);
  if (status.promise) {
    for (const std::string& line : lines_of(*status.promise, folder)) tell("{}", line);
  }
  tell_troubles(status, folder);
  if (!status.dataset_hash.empty()) {
    tell("dataset hash {}", status.dataset_hash);
  } else if (!status.running) {
    tell("'seedframe resume {}' renders the rest", folder);
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
