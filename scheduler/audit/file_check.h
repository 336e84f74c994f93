// Whether the files of a campaign are still what was written, without rendering anything.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"

namespace seedframe {

struct FileCheck {
  struct Problem {
    std::int64_t frame = 0;
    std::string text;
  };
  struct Duplicates {
    std::vector<std::int64_t> frames;  ///< with the same pixels
    bool same_spec = false;            ///< and the same was asked for
  };
  std::int64_t frames = 0;  ///< that are done; all were read
  std::uint64_t bytes = 0;
  std::vector<Problem> problems;           ///< in the order of frames
  std::vector<std::string> of_no_frame;    ///< problems of the campaign as a whole
  std::vector<std::int64_t> other_inputs;  ///< done frames for which something else is asked today
  std::vector<Duplicates> duplicates;      ///< in the order of their first frames
};

/// What a campaign's files are held against, beside each other.
struct FileReference {
  const std::vector<std::string>& categories;
  /// What the config makes today, used from several threads; null where it cannot be read: then
  /// ids, labels and what frames were made from are not made again.
  const PreparedCampaign* prepared = nullptr;
};

/// Reads every file of every frame that is done, on all cores, and compares it with its manifest,
/// with what follows from the frame's spec and its other files (frame_contents.h), and the manifest
/// with the store; the store with what the config makes; provenance.json with both. Files below
/// frames/ that belong to nothing are problems, too.
Result<FileCheck> check_files(const Campaign& campaign, const FileReference& reference);

}  // namespace seedframe
