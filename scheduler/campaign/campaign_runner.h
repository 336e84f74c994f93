// A campaign's run from the first frame to the last, over pauses and other hindrances.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/pauses.h"
#include "campaign/provenance.h"
#include "campaign/run_options.h"

namespace seedframe {

/// What frames will take on the disk, before they are made.
struct RoomForecast {
  std::uint64_t needed = 0;  ///< bytes, about
  std::uint64_t free = 0;
};

/// Sets what a frame takes in `setup`, by those that the campaign has.
Result<RoomForecast> forecast_room(const Campaign& campaign, const CampaignSettings& settings,
                                   std::size_t frames, RunSetup& setup);

/// kEnvironment unless the frames fit, or the options say that this does not matter.
Status check_room(const CampaignFiles& files, const RoomForecast& room, std::size_t frames,
                  const RunOptions& options);

/// Runs frames by one CampaignRun after another. Prints nothing: the observer is told.
class CampaignRunner : private PausableRun {
 public:
  /// `used`: by the frames that were expanded before, for the provenance. All must outlive it;
  /// `campaign` is opened anew after a pause.
  CampaignRunner(Campaign& campaign, const PreparedCampaign& prepared, const UsedFiles& used,
                 const RunSetup& setup, RunObserver& observer);
  ~CampaignRunner() override;

  /// Returns when each of `frames` is done or failed, the run was drained, or waiting for room did
  /// not help. To be called once.
  Result<RunSummary> run_to_end(std::vector<PendingFrame> frames);

  /// No new frames are begun, and no pause is waited for. Async-signal-safe.
  void drain();
  bool is_drained() const override { return drains_ > 0; }

 private:
  class Counting;

  Result<RunSummary> run(const std::vector<PendingFrame>& frames) override;
  std::int64_t frames_done() const override;
  bool has_room() override;
  Result<std::vector<PendingFrame>> reopen(const std::vector<PendingFrame>& wanted) override;
  void tell_pause(const Error& why) override;
  void tell_end_of_pause(std::size_t frames) override;
  std::chrono::steady_clock::time_point now() const override;
  void sleep(std::chrono::milliseconds time) override;

  Campaign& campaign_;
  const PreparedCampaign& prepared_;
  const UsedFiles& used_;
  const RunSetup& setup_;
  std::unique_ptr<Counting> observer_;
  std::optional<Provenance> provenance_;     ///< of the last run
  std::unique_ptr<CampaignRun> last_;        ///< stays: a signal may still look at it
  std::atomic<CampaignRun*> run_ = nullptr;  ///< the one under way
  std::atomic<int> drains_ = 0;
};

}  // namespace seedframe
