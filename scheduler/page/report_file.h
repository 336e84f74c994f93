// The page of a campaign as a file, and beside it a folder where one file would be too large.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "page/campaign_page.h"

namespace seedframe {

struct ReportWish {
  PageWish page;
  std::filesystem::path file;
  /// From so many frames on thumbnails are in a folder beside the file: "report_files".
  std::int64_t most_inside = 20'000;
};

struct WrittenReport {
  std::uint64_t bytes = 0;       ///< of the file
  std::filesystem::path folder;  ///< empty: all is in the file
  std::int64_t frames = 0;       ///< of the campaign
  std::int64_t shown = 0;        ///< of them
  std::int64_t damaged = 0;      ///< of them, on the disk
  std::int64_t warnings = 0;     ///< of its health
};

/// Replaces a file, and a folder that an earlier report left there; kInput error for a folder that
/// holds anything else. See campaign_page for the rest.
Result<WrittenReport> write_report(const Campaign& campaign, const PreparedCampaign* prepared,
                                   const std::string& why_not, const ReportWish& wish);

}  // namespace seedframe
