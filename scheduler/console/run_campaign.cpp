#include "console/run_campaign.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "campaign/campaign_runner.h"
#include "campaign/disk_space.h"
#include "campaign/drain_signals.h"
#include "campaign/run_setup.h"
#include "console/exit_code.h"
#include "console/progress.h"
#include "console/say.h"
#include "export/kept_inputs.h"

namespace seedframe {
namespace {

/// "rendering 24 frames of 320 × 240 at 32 samples"
std::string describe_work(const CampaignSettings& settings, std::size_t frames) {
  const RenderSettings& render = settings.render;
  if (settings.labels == LabelSource::kTwin) {
    return fmt::format("tracing the labels of {} frames of {} × {}", frames, render.width,
                       render.height);
  }
  return fmt::format("rendering {} frames of {} × {} at {}{} samples", frames, render.width,
                     render.height, settings.quality ? "most " : "", render.samples);
}

/// What is left to do, if anything is; else what can be done now.
int print_next(const Campaign& campaign, const FrameCounts& counts, bool interrupted) {
  const std::string folder = campaign.files.root().string();
  if (counts.quarantined > 0) {
    say("{} frames are quarantined, each has cost too many workers: 'seedframe status {}' "
        "names them and how to see it again\n",
        counts.quarantined, folder);
  }
  if (counts.failed > 0) {
    say("{} frames failed: 'seedframe status {}' names them, 'seedframe resume {}' tries "
        "them again\n",
        counts.failed, folder, folder);
  }
  if (counts.failed + counts.quarantined > 0) return kExitSomeFailed;
  if (counts.done < counts.total()) {
    say("'seedframe resume {}' renders the rest\n", folder);
    return interrupted ? kExitInterrupted : kExitOk;
  }
  const Result<std::string> hash = campaign.store.dataset_hash();
  if (!hash) return report(hash.error());
  say("dataset hash {}\n'seedframe export {} --format coco' writes annotations\n", *hash, folder);
  return kExitOk;
}

int print_outcome(const Campaign& campaign, std::int64_t done_before, const RunSummary& summary,
                  double seconds, bool interrupted) {
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return report(counts.error());
  say("{} of {} frames are done ({} in this run{}, {})\n", counts->done, counts->total(),
      std::max<std::int64_t>(0, counts->done - done_before),
      summary.from_cache > 0 ? fmt::format(", {} of them found on this machine", summary.from_cache)
                             : "",
      duration_text(seconds));
  const int code = print_next(campaign, *counts, interrupted);
  if (counts->done > 0) {
    say("look: 'seedframe show {0}' or 'seedframe report {0}'\n", campaign.files.root().string());
  }
  return code;
}

}  // namespace

int run_campaign(Campaign& campaign, const PreparedCampaign& prepared, const UsedFiles& used,
                 RunSetup& setup, std::vector<PendingFrame> frames) {
  const Result<FrameCounts> before = campaign.store.counts();
  if (!before) return report(before.error());
  const bool silent = setup.options.quiet || frames.empty();
  if (!silent) {
    say_aside("{} into {}: {}\n", describe_work(prepared.settings, frames.size()),
              campaign.files.root().string(), describe(setup));
  }
  const Result<RoomForecast> room =
      forecast_room(campaign, prepared.settings, frames.size(), setup);
  if (!room) return report(room.error());
  if (!silent) {
    std::fprintf(stderr, "they take about %s; %s are free\n", bytes_text(room->needed).c_str(),
                 bytes_text(room->free).c_str());
  }
  if (Status fits = check_room(campaign.files, *room, frames.size(), setup.options); !fits) {
    return report(fits.error());
  }
  const Result<KeptInputs> inputs = inputs_of(prepared);
  if (!inputs) return report(inputs.error());
  if (Status kept = keep_inputs(campaign.files, *inputs); !kept) return report(kept.error());
  const auto start = std::chrono::steady_clock::now();
  Progress progress(static_cast<std::int64_t>(frames.size()), before->done, silent);
  CampaignRunner runner(campaign, prepared, used, setup, progress);
  const DrainOnSignals drain(runner);
  const Result<RunSummary> summary = runner.run_to_end(std::move(frames));
  progress.finish();
  if (!summary) {
    const int code = report(summary.error());
    std::error_code ignored;
    const bool there = std::filesystem::exists(campaign.files.store(), ignored);
    say_aside("seedframe: nothing is lost: 'seedframe resume {}' goes on{}\n",
              there ? campaign.files.root().string() : "DIR",
              there ? "" : ", where the folder is now");
    return runner.is_drained() ? static_cast<int>(kExitInterrupted) : code;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return print_outcome(campaign, before->done, *summary, seconds.count(), runner.is_drained());
}

}  // namespace seedframe
