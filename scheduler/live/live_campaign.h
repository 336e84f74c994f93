// One campaign as a server shows it: its page, and what changes while it is made.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/canonical_json.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "live/run_control.h"

namespace seedframe {

using LiveClock = std::function<std::chrono::steady_clock::time_point()>;

/// Not for use from several threads at once.
class LiveCampaign {
 public:
  /// kInput or kCorrupt as open_campaign.
  static Result<LiveCampaign> open(const std::filesystem::path& folder,
                                   const std::filesystem::path& home, LiveClock clock);

  const Campaign& campaign() const { return campaign_; }
  std::string name() const;

  /// How far it is: docs/report.md has the keys. The store is only asked again when somebody has
  /// written to it.
  Result<Json> state(RunControl& control);

  /// The page, as HTML; `others` are links to the other campaigns' pages, by name. An earlier one
  /// is given again while nothing has changed, or while making one anew would take more than a
  /// tenth of the time.
  Result<std::string> page(const Json& others);

  /// A WebP of a finished frame, at most 320 pixels wide: its picture, or its mask where it has
  /// none. kInput: there is no such frame.
  Result<std::string> thumbnail(std::int64_t frame);

 private:
  LiveCampaign(Campaign campaign, std::filesystem::path home, LiveClock clock)
      : campaign_(std::move(campaign)), home_(std::move(home)), clock_(std::move(clock)) {}
  Status read_store();
  void note_progress(bool at_work);
  double rate_per_s() const;
  Result<std::string> page_version() const;

  struct Progress {
    std::chrono::steady_clock::time_point when;
    std::int64_t done = 0;
  };
  struct MadePage {
    std::string html;
    std::string version;
    std::chrono::steady_clock::time_point when;
    std::chrono::steady_clock::duration took{};
  };

  Campaign campaign_;
  std::filesystem::path home_;
  LiveClock clock_;
  std::optional<std::int64_t> version_;  ///< of the store, when it was read last
  FrameCounts counts_;
  std::vector<FrameRow> running_;
  std::vector<AttemptRow> running_attempts_;
  std::vector<AttemptRow> newest_;
  std::vector<AttemptRow> failures_;
  std::string dataset_hash_;
  std::deque<Progress> progress_;  ///< since the run that is at work was first seen
  std::optional<MadePage> page_;
};

}  // namespace seedframe
