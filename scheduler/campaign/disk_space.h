// Whether a campaign's disk has room, and takes what is written.
#pragma once

#include <cstdint>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/run_options.h"

namespace seedframe {

/// The mean of some frames that the campaign has already; typical_frame_bytes if there are none.
Result<std::uint64_t> expected_frame_bytes(const Campaign& campaign,
                                           const CampaignSettings& settings);

struct DiskRoom {
  std::uint64_t bytes = 0;
  std::uint64_t files = 0;
};

/// What the attempts of a run under way may still take.
DiskRoom room_for_attempts(const RunSetup& setup);

/// Bytes that we may still write to the file system of `folder`.
Result<std::uint64_t> free_bytes(const std::filesystem::path& folder);

/// kExhausted unless at least what is needed is free.
Status check_room(const std::filesystem::path& folder, const DiskRoom& needed);

/// The same; also unless a file can be opened, and what is written to it arrives on the disk.
Status check_disk(const CampaignFiles& files, const DiskRoom& needed);

/// "1.2 GB".
std::string bytes_text(std::uint64_t bytes);

}  // namespace seedframe
