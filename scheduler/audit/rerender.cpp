#include "audit/rerender.h"

#include <algorithm>
#include <iterator>

#include "base/cores.h"
#include "base/files.h"
#include "campaign/campaign_runner.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kMostBefore = 8;

/// Other kernels than Cycles takes by itself on any CPU of the last decade.
constexpr Isa kOtherIsa = Isa::kAvx;

}  // namespace

Result<MadeWith> made_with(const JobStore& store, std::int64_t frame) {
  MadeWith made;
  const auto attempts = store.attempts(frame);
  if (!attempts) return forward_error(attempts);
  const auto attempt =
      std::find_if(attempts->rbegin(), attempts->rend(), [](const AttemptRow& row) {
        return row.outcome == AttemptOutcome::kDone && !row.provenance.empty();
      });
  if (attempt == attempts->rend()) return made;
  Result<Json> provenance = parse_json(attempt->provenance, "the job store's provenance");
  if (!provenance) return forward_error(provenance);
  made.provenance = std::move(*provenance);
  made.threads = made.provenance.value("threads", 1);
  made.persistent_data = made.provenance.value("persistent_data", false);
  const std::string embree = made.provenance.value("embree", "");
  if (!embree.empty()) made.kernels = Kernels{made.provenance.value("kernel", ""), embree};
  auto before = store.done_by_worker_before(*attempt, kMostBefore);
  if (!before) return forward_error(before);
  made.before = std::move(*before);
  return made;
}

RunOptions vary(RunOptions options, const Conditions& varied, bool portable,
                const fs::path& temporary) {
  constexpr int kWorkers = 3;
  for (const Condition condition : varied) {
    switch (condition) {
      case Condition::kThreads:
        options.worker.threads = options.worker.threads == 1 ? std::max(2, core_count()) : 1;
        break;
      case Condition::kWorkers:
        options.pool.workers = options.pool.workers == kWorkers ? kWorkers - 1 : kWorkers;
        break;
      case Condition::kFreshWorker:
        options.pool.frames_per_worker = 1;
        break;
      case Condition::kTmpdir:
        options.worker.environment["TMPDIR"] = temporary.string();
        break;
      case Condition::kLocale:
        options.worker.environment["LC_ALL"] = "de_DE.UTF-8";
        options.worker.environment["LANGUAGE"] = "de";
        break;
      case Condition::kTimezone:
        options.worker.environment["TZ"] = "Pacific/Chatham";
        break;
      case Condition::kIsa:
        if (portable) {
          options.worker.environment["GLIBC_TUNABLES"] =
              "glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-FMA,-AVX";
        } else {
          // Not as what a worker must have: Blender 4 has no kernel for AVX, and takes the next.
          options.worker.environment.merge(
              environment_of({.kernels = kernels_of(kOtherIsa)}, options.worker.preload));
        }
        break;
      case Condition::kOrder:    // of the frames, and
      case Condition::kHistory:  // which come first, and
      case Condition::kNode:     // where: whoever renders says
        break;
    }
  }
  return options;
}

Arrangement arrange(std::vector<std::int64_t> frames, const Conditions& varied,
                    const std::vector<std::int64_t>& companions, int workers) {
  constexpr std::size_t kBeforePerWorker = 2;
  auto at_once = static_cast<std::size_t>(workers);
  if (varied.contains(Condition::kOrder)) std::reverse(frames.begin(), frames.end());
  std::vector<std::int64_t> others;
  std::copy_if(companions.begin(), companions.end(), std::back_inserter(others),
               [&](std::int64_t frame) {
                 return std::find(frames.begin(), frames.end(), frame) == frames.end();
               });
  if (varied.contains(Condition::kHistory)) {
    at_once = std::clamp<std::size_t>(others.size(), 1, at_once);
    others.resize(std::min(others.size(), kBeforePerWorker * at_once));
    frames.insert(frames.begin(), others.begin(), others.end());
  } else if (varied.contains(Condition::kWorkers) && frames.size() < at_once) {
    others.resize(std::min(others.size(), at_once - frames.size()));
    frames.insert(frames.end(), others.begin(), others.end());
  }
  return {std::move(frames), static_cast<int>(at_once), varied.contains(Condition::kNode)};
}

Result<Campaign> Rerenderer::render(const Arrangement& arrangement, RunOptions options,
                                    const fs::path& folder) {
  const std::vector<std::int64_t>& frames = arrangement.frames;
  RunSetup setup = setup_;
  setup.options = std::move(options);
  setup.options.pool.workers = arrangement.workers;
  setup.options.pause_limit_s = 0.0;
  // Or a worker that was slow to start would have no history, and frames not their arrangement.
  setup.options.pool.begin_together = true;
  setup.cache.clear();  // what is audited is never taken from anywhere
  if (arrangement.other_nodes) {
    Result<MakeRun> make = on_other_nodes_(frames, setup.options);
    if (!make) return forward_error(make);
    setup.make = std::move(*make);
  }
  UsedFiles used;
  Result<Campaign> campaign = create_scratch_campaign(folder, frames, prepared_, used);
  if (!campaign) return forward_error(campaign);
  std::vector<PendingFrame> pending;
  pending.reserve(frames.size());
  for (const std::int64_t frame : frames) pending.push_back({frame, 0, 0});
  CampaignRunner runner(*campaign, prepared_, used, setup, observer_);
  const Result<RunSummary> summary = runner.run_to_end(std::move(pending));
  if (!summary) return forward_error(summary);
  return campaign;
}

}  // namespace seedframe
