#include "cli/run_campaign.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <set>
#include <thread>

#include "campaign/disk_space.h"
#include "campaign/make_run.h"
#include "cli/exit_code.h"
#include "cli/progress.h"

namespace seedframe {
namespace {

using Clock = std::chrono::steady_clock;

std::atomic<CampaignRun*> g_run = nullptr;
volatile std::sig_atomic_t g_interrupted = 0;

extern "C" void drain_on_signal(int) {
  g_interrupted = 1;
  if (CampaignRun* run = g_run.load()) run->drain();
}

/// While this lives, SIGINT and SIGTERM drain the run of the moment, and end a pause.
class DrainOnSignals {
 public:
  DrainOnSignals() {
    g_interrupted = 0;
    struct sigaction action = {};
    action.sa_handler = drain_on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, &interrupt_);
    sigaction(SIGTERM, &action, &terminate_);
  }
  ~DrainOnSignals() {
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGTERM, &terminate_, nullptr);
  }
  DrainOnSignals(const DrainOnSignals&) = delete;
  DrainOnSignals& operator=(const DrainOnSignals&) = delete;
  static bool interrupted() { return g_interrupted != 0; }

 private:
  struct sigaction interrupt_ = {};
  struct sigaction terminate_ = {};
};

/// The run that signals drain.
class RunUnderWay {
 public:
  explicit RunUnderWay(CampaignRun& run) {
    g_run = &run;
    if (DrainOnSignals::interrupted()) run.drain();  // between two runs
  }
  ~RunUnderWay() { g_run = nullptr; }
  RunUnderWay(const RunUnderWay&) = delete;
  RunUnderWay& operator=(const RunUnderWay&) = delete;
};

/// "rendering 24 frames of 320 × 240 at 32 samples"
std::string describe_work(const CampaignSettings& settings, std::size_t frames) {
  const RenderSettings& render = settings.render;
  if (settings.labels == LabelSource::kTwin) {
    return fmt::format("tracing the labels of {} frames of {} × {}", frames, render.width,
                       render.height);
  }
  return fmt::format("rendering {} frames of {} × {} at {} samples", frames, render.width,
                     render.height, render.samples);
}

Status check_room(const Campaign& campaign, const RunSetup& setup, std::size_t frames) {
  const Result<std::uint64_t> free = free_bytes(campaign.files.root());
  if (!free) return forward_error(free);
  const std::uint64_t needed = setup.frame_bytes * frames;
  if (!setup.options.quiet && frames > 0) {
    std::fprintf(stderr, "they take about %s; %s are free\n", bytes_text(needed).c_str(),
                 bytes_text(*free).c_str());
  }
  if (setup.options.no_space_check || needed <= *free) return {};
  return fail(ErrorKind::kEnvironment,
              "{}: {} frames take about {}, and {} are free: make room, or start with "
              "--no-space-check, which pauses when the disk is full",
              campaign.files.root().string(), frames, bytes_text(needed), bytes_text(*free));
}

Result<RunSummary> run_once(Campaign& campaign, PreparedCampaign& prepared, const UsedFiles& used,
                            const RunSetup& setup, const std::vector<PendingFrame>& frames,
                            Progress& progress) {
  Result<Provenance> provenance = Provenance::load(campaign.files, prepared, used, setup);
  if (!provenance) return forward_error(provenance);
  if (Status written = provenance->write(); !written) return forward_error(written);
  const auto run = make_run(campaign, prepared, *provenance, setup, progress);
  const RunUnderWay under_way(*run);
  return run->run(frames);
}

/// Opens the campaign anew, since nothing in memory can be trusted after a failed write; the frames
/// that are missing.
Result<std::vector<PendingFrame>> take_up_again(Campaign& campaign,
                                                const std::vector<PendingFrame>& wanted) {
  Result<Campaign> reopened = open_campaign(campaign.files.root());
  if (!reopened) return forward_error(reopened);
  campaign = std::move(*reopened);
  if (Status begun = begin_run(campaign); !begun) return forward_error(begun);
  const Result<Reconciliation> state = reconcile(campaign, /*verify=*/false);
  if (!state) return forward_error(state);
  std::set<std::int64_t> asked;
  for (const PendingFrame& frame : wanted) asked.insert(frame.frame);
  std::vector<PendingFrame> missing;
  for (const PendingFrame& frame : state->to_render) {
    if (asked.contains(frame.frame)) missing.push_back(frame);
  }
  return missing;
}

/// Waits until the disk takes data again; false when that took too long, or a signal came.
bool wait_for_room(const Campaign& campaign, const RunSetup& setup, double limit_s) {
  constexpr auto kLook = std::chrono::milliseconds(500);
  const auto limit =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
  const auto deadline = Clock::now() + limit;
  const std::uint64_t needed = room_for_attempts(setup);
  while (Clock::now() < deadline && !DrainOnSignals::interrupted()) {
    std::this_thread::sleep_for(kLook);
    if (check_disk(campaign.files, needed)) return !DrainOnSignals::interrupted();
  }
  return false;
}

/// A pause: from the error that made it to the frames that are still to be done, or an error when
/// it is not to be waited for any longer.
Result<std::vector<PendingFrame>> pause(Campaign& campaign, const RunSetup& setup,
                                        const std::vector<PendingFrame>& frames, const Error& why) {
  const double limit_s = setup.options.pause_limit_s;
  std::fprintf(stderr, "seedframe: paused: %s\n", why.message.c_str());
  std::fprintf(stderr, "seedframe: waiting up to %s for it to pass; Ctrl-C ends\n",
               duration_text(limit_s).c_str());
  Result<std::vector<PendingFrame>> left = tl::unexpected(why);
  const auto start = std::chrono::steady_clock::now();
  while (true) {
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
    if (!wait_for_room(campaign, setup, limit_s - waited.count())) break;
    left = take_up_again(campaign, frames);
    if (left || left.error().kind != ErrorKind::kExhausted) break;
  }
  if (left) std::fprintf(stderr, "seedframe: going on with %zu frames\n", left->size());
  return left;
}

int print_outcome(Campaign& campaign, std::int64_t done_before, std::int64_t from_cache,
                  double seconds) {
  const std::string folder = campaign.files.root().string();
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return report(counts.error());
  fmt::print("{} of {} frames are done ({} in this run{}, {})\n", counts->done, counts->total(),
             std::max<std::int64_t>(0, counts->done - done_before),
             from_cache > 0 ? fmt::format(", {} of them found on this machine", from_cache) : "",
             duration_text(seconds));
  if (counts->quarantined > 0) {
    fmt::print(
        "{} frames are quarantined, each has cost too many workers: 'seedframe status {}' "
        "names them and how to see it again\n",
        counts->quarantined, folder);
  }
  if (counts->failed > 0) {
    fmt::print(
        "{} frames failed: 'seedframe status {}' names them, 'seedframe resume {}' tries "
        "them again\n",
        counts->failed, folder, folder);
  }
  if (counts->failed + counts->quarantined > 0) return kExitSomeFailed;
  if (counts->done < counts->total()) {
    fmt::print("'seedframe resume {}' renders the rest\n", folder);
    return DrainOnSignals::interrupted() ? kExitInterrupted : kExitOk;
  }
  const Result<std::string> hash = campaign.store.dataset_hash();
  if (!hash) return report(hash.error());
  fmt::print("dataset hash {}\n'seedframe export {} --format coco' writes annotations\n", *hash,
             folder);
  return kExitOk;
}

}  // namespace

int run_campaign(Campaign& campaign, PreparedCampaign& prepared, const UsedFiles& used,
                 RunSetup& setup, std::vector<PendingFrame> frames) {
  const RunOptions& options = setup.options;
  const Result<FrameCounts> before = campaign.store.counts();
  if (!before) return report(before.error());
  const Result<std::uint64_t> frame_bytes = expected_frame_bytes(campaign, prepared.settings);
  if (!frame_bytes) return report(frame_bytes.error());
  setup.frame_bytes = *frame_bytes;
  if (!options.quiet && !frames.empty()) {
    std::fprintf(stderr, "%s into %s: %s\n",
                 describe_work(prepared.settings, frames.size()).c_str(),
                 campaign.files.root().c_str(), describe(setup).c_str());
  }
  if (Status room = check_room(campaign, setup, frames.size()); !room) {
    return report(room.error());
  }
  const auto start = std::chrono::steady_clock::now();
  Progress progress(static_cast<std::int64_t>(frames.size()), before->done,
                    options.quiet || frames.empty());
  const DrainOnSignals drain;
  Result<RunSummary> summary = run_once(campaign, prepared, used, setup, frames, progress);
  int fruitless = 0;  // pauses in a row after which nothing was done: waiting does not help
  constexpr int kMostFruitless = 3;
  while (!summary && summary.error().kind == ErrorKind::kExhausted && options.pause_limit_s > 0.0 &&
         fruitless < kMostFruitless) {
    progress.finish();
    const std::int64_t done = progress.done();
    auto left = pause(campaign, setup, frames, summary.error());
    if (!left) {
      summary = forward_error(left);
      break;
    }
    frames = std::move(*left);
    summary = run_once(campaign, prepared, used, setup, frames, progress);
    fruitless = progress.done() > done ? 0 : fruitless + 1;
  }
  progress.finish();
  if (!summary) {
    const int code = report(summary.error());
    std::fprintf(stderr, "seedframe: nothing is lost: 'seedframe resume %s' goes on\n",
                 campaign.files.root().c_str());
    return DrainOnSignals::interrupted() ? static_cast<int>(kExitInterrupted) : code;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return print_outcome(campaign, before->done, summary->from_cache, seconds.count());
}

}  // namespace seedframe
