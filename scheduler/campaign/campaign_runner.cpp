#include "campaign/campaign_runner.h"

#include <set>
#include <thread>

#include "campaign/disk_space.h"
#include "campaign/make_run.h"

namespace seedframe {

/// Hands on what a run tells, and counts.
class CampaignRunner::Counting : public RunObserver {
 public:
  explicit Counting(RunObserver& observer) : observer_(observer) {}

  void frame_done(std::int64_t frame) override {
    ++done_;
    observer_.frame_done(frame);
  }
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override {
    observer_.attempt_failed(job, failure);
  }
  void noted(const std::string& text) override { observer_.noted(text); }
  void paused(const Error& why, double limit_s) override { observer_.paused(why, limit_s); }
  void goes_on(std::int64_t frames) override { observer_.goes_on(frames); }
  std::int64_t done() const { return done_; }

 private:
  RunObserver& observer_;
  std::int64_t done_ = 0;
};

Result<RoomForecast> forecast_room(const Campaign& campaign, const CampaignSettings& settings,
                                   std::size_t frames, RunSetup& setup) {
  const Result<std::uint64_t> frame_bytes = expected_frame_bytes(campaign, settings);
  if (!frame_bytes) return forward_error(frame_bytes);
  setup.frame_bytes = *frame_bytes;
  const Result<std::uint64_t> free = free_bytes(campaign.files.root());
  if (!free) return forward_error(free);
  return RoomForecast{*frame_bytes * frames, *free};
}

Status check_room(const CampaignFiles& files, const RoomForecast& room, std::size_t frames,
                  const RunOptions& options) {
  if (options.no_space_check || room.needed <= room.free) return {};
  return fail(ErrorKind::kEnvironment,
              "{}: {} frames take about {}, and {} are free: make room, or start with "
              "--no-space-check, which pauses when the disk is full",
              files.root().string(), frames, bytes_text(room.needed), bytes_text(room.free));
}

CampaignRunner::CampaignRunner(Campaign& campaign, const PreparedCampaign& prepared,
                               const UsedFiles& used, const RunSetup& setup, RunObserver& observer)
    : campaign_(campaign),
      prepared_(prepared),
      used_(used),
      setup_(setup),
      observer_(std::make_unique<Counting>(observer)) {}

CampaignRunner::~CampaignRunner() = default;

Result<RunSummary> CampaignRunner::run_to_end(std::vector<PendingFrame> frames) {
  return run_with_pauses(*this, std::move(frames),
                         std::chrono::duration<double>(setup_.options.pause_limit_s));
}

void CampaignRunner::drain() {
  ++drains_;
  if (CampaignRun* run = run_.load()) run->drain();
}

Result<RunSummary> CampaignRunner::run(const std::vector<PendingFrame>& frames) {
  Result<Provenance> provenance = Provenance::load(campaign_.files, prepared_, used_, setup_);
  if (!provenance) return forward_error(provenance);
  if (Status written = provenance->write(); !written) return forward_error(written);
  last_.reset();  // looks at the provenance
  provenance_ = std::move(*provenance);
  const MakeRun& make = setup_.make ? setup_.make : make_run;
  last_ = make(campaign_, prepared_, *provenance_, setup_, *observer_);
  run_ = last_.get();
  for (int drain = drains_; drain > 0; --drain) last_->drain();  // that came between two runs
  Result<RunSummary> summary = last_->run(frames);
  run_ = nullptr;
  return summary;
}

std::int64_t CampaignRunner::frames_done() const { return observer_->done(); }

bool CampaignRunner::has_room() {
  return check_disk(campaign_.files, room_for_attempts(setup_)).has_value();
}

Result<std::vector<PendingFrame>> CampaignRunner::reopen(const std::vector<PendingFrame>& wanted) {
  Result<Campaign> reopened = open_campaign(campaign_.files.root());
  if (!reopened) return forward_error(reopened);
  campaign_ = std::move(*reopened);
  if (Status begun = begin_run(campaign_); !begun) return forward_error(begun);
  const Result<Reconciliation> state = reconcile(campaign_, /*verify=*/false);
  if (!state) return forward_error(state);
  std::set<std::int64_t> asked;
  for (const PendingFrame& frame : wanted) asked.insert(frame.frame);
  std::vector<PendingFrame> missing;
  for (const PendingFrame& frame : state->to_render) {
    if (asked.contains(frame.frame)) missing.push_back(frame);
  }
  return missing;
}

void CampaignRunner::tell_pause(const Error& why) {
  observer_->paused(why, setup_.options.pause_limit_s);
}

void CampaignRunner::tell_end_of_pause(std::size_t frames) {
  observer_->goes_on(static_cast<std::int64_t>(frames));
}

std::chrono::steady_clock::time_point CampaignRunner::now() const {
  return std::chrono::steady_clock::now();
}

void CampaignRunner::sleep(std::chrono::milliseconds time) { std::this_thread::sleep_for(time); }

}  // namespace seedframe
