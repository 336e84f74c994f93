#include "report/forecast.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/spread.h"
#include "campaign/campaign_runner.h"
#include "campaign/disk_space.h"
#include "frames/frame_reader.h"

namespace seedframe {
namespace {

/// In the order in which they began.
Result<std::vector<AttemptRow>> attempts_of(const JobStore& store,
                                            const std::vector<std::int64_t>& frames) {
  std::vector<AttemptRow> rows;
  for (const std::int64_t frame : frames) {
    const auto attempts = store.attempts(frame);
    if (!attempts) return forward_error(attempts);
    if (attempts->empty() || attempts->back().outcome != AttemptOutcome::kDone) {
      return fail(ErrorKind::kRender, "frame {} failed{}{}", frame, attempts->empty() ? "" : ": ",
                  attempts->empty() ? "" : attempts->back().message);
    }
    rows.push_back(attempts->back());
  }
  std::sort(rows.begin(), rows.end(),
            [](const AttemptRow& a, const AttemptRow& b) { return a.started < b.started; });
  return rows;
}

/// Of whoever makes frames one after the other: a worker, or a thread that traces.
double seconds_of(const AttemptRow& row) {
  const double rendered_s = row.build_s + row.render_s;
  return rendered_s > 0.0 ? rendered_s : row.finish_s;
}

double mean_of(const std::vector<double>& values) {
  return values.empty() ? 0.0
                        : std::accumulate(values.begin(), values.end(), 0.0) /
                              static_cast<double>(values.size());
}

double standard_error_of(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double mean = mean_of(values);
  const double squares =
      std::accumulate(values.begin(), values.end(), 0.0,
                      [&](double sum, double x) { return sum + (x - mean) * (x - mean); });
  const auto n = static_cast<double>(values.size());
  return std::sqrt(squares / (n - 1.0) / n);
}

/// As far as settings tell.
bool costs_the_same(const FrameSpec& spec, const CampaignSettings& settings) {
  const RenderSettings &one = spec.render, &other = settings.render;
  return spec.labels.source == settings.labels && one.width == other.width &&
         one.height == other.height && one.samples == other.samples &&
         one.adaptive == other.adaptive && one.denoise == other.denoise &&
         one.max_bounces == other.max_bounces;
}

}  // namespace

Forecast told_by(const std::vector<AttemptRow>& pilots, double begin, int workers,
                 std::int64_t frames) {
  std::map<int, int> made;  // frames by worker
  for (const AttemptRow& row : pilots) ++made[row.worker];
  std::vector<double> firsts, others;
  std::map<int, bool> has_begun;
  for (const AttemptRow& row : pilots) {
    const bool is_first = !std::exchange(has_begun[row.worker], true);
    (is_first && made[row.worker] > 1 ? firsts : others).push_back(seconds_of(row));
  }
  Forecast forecast;
  forecast.frames = frames;
  forecast.pilots = static_cast<int>(pilots.size());
  forecast.frame_s = mean_of(others);
  if (forecast.frame_s > 0.0) forecast.spread = standard_error_of(others) / forecast.frame_s;
  const double start_up = std::max(0.0, pilots.front().started - begin);
  const double warm_up = std::max(0.0, mean_of(firsts) - forecast.frame_s);
  const auto at_once = static_cast<double>(std::min<std::int64_t>(workers, frames));
  forecast.wall_s = start_up + (firsts.empty() ? 0.0 : warm_up) +
                    static_cast<double>(frames) * forecast.frame_s / at_once +
                    pilots.back().finish_s;
  return forecast;
}

Result<std::optional<Forecast>> told_by(const Campaign& campaign, const CampaignSettings& settings,
                                        int workers, std::int64_t frames) {
  constexpr int kNewest = 100;
  const auto timings = campaign.store.mean_timings(kNewest);
  if (!timings) return forward_error(timings);
  const auto done = campaign.store.frames_in(FrameState::kDone, kNewest);
  if (!done) return forward_error(done);
  if (!*timings || done->empty()) return std::nullopt;
  const Result<FrameSpec> spec = stored_spec(campaign.files.frame(done->front().frame));
  if (!spec || !costs_the_same(*spec, settings)) return std::nullopt;
  const auto bytes = expected_frame_bytes(campaign, settings);
  if (!bytes) return forward_error(bytes);
  const bool rendered = (*timings)->render_s > 0.0;
  Forecast told;
  told.frames = frames;
  told.pilots = static_cast<int>(done->size());
  told.frame_s = rendered ? (*timings)->build_s + (*timings)->render_s : (*timings)->finish_s;
  told.wall_s = static_cast<double>(frames) * told.frame_s /
                static_cast<double>(std::min<std::int64_t>(workers, frames));
  told.bytes = *bytes * static_cast<std::uint64_t>(frames);
  return told;
}

Result<Forecast> forecast(const PreparedCampaign& prepared, RunSetup setup, std::int64_t frames,
                          int pilots, const std::filesystem::path& folder, RunObserver& observer) {
  setup.cache.clear();
  setup.options.pause_limit_s = 0.0;
  setup.options.pool.begin_together = true;  // all workers have a share of so few frames
  const std::vector<std::int64_t> chosen = spread_over(frames, pilots);
  UsedFiles used;
  Result<Campaign> campaign = create_scratch_campaign(folder, chosen, prepared, used);
  if (!campaign) return forward_error(campaign);
  std::vector<PendingFrame> pending;
  pending.reserve(chosen.size());
  for (const std::int64_t frame : chosen) pending.push_back({frame, 0, 0});
  using Clock = std::chrono::system_clock;  // as the store's
  const double begin = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  CampaignRunner runner(*campaign, prepared, used, setup, observer);
  const Result<RunSummary> summary = runner.run_to_end(std::move(pending));
  if (!summary) return forward_error(summary);
  const auto rows = attempts_of(campaign->store, chosen);
  if (!rows) return forward_error(rows);
  const auto frame_bytes = expected_frame_bytes(*campaign, prepared.settings);
  if (!frame_bytes) return forward_error(frame_bytes);
  Forecast told = told_by(*rows, begin, setup.options.pool.workers, frames);
  told.bytes = *frame_bytes * static_cast<std::uint64_t>(frames);
  return told;
}

}  // namespace seedframe
