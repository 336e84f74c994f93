// The errors that were measured of a campaign's frames, as its job store keeps them
// (docs/formats/job-store.md).
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "base/canonical_json.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "quality/error_check.h"

namespace seedframe {

/// Of one frame, and of which pixels of it.
struct RecordedError {
  std::string frame_id;
  std::string pixel_hash;
  int reference_samples = 0;
  std::map<std::string, double> errors;  ///< by Measure::key

  bool operator==(const RecordedError&) const = default;
};

/// By frame.
using ErrorRecord = std::map<std::int64_t, RecordedError>;

/// What is no number there is null here.
Json to_json(const ErrorRecord& record);
/// Reads what to_json wrote; the error (kCorrupt) names `what`.
Result<ErrorRecord> error_record_from_json(const Json& json, const std::string& what);

/// All that is kept, also of frames that have become others since.
Result<ErrorRecord> read_error_record(const Campaign& campaign);

/// Whether the frame still is what was measured.
bool is_of(const RecordedError& recorded, const FrameRow& row);

/// Keeps what was measured; of a frame that was measured before, the newer. Takes the campaign's
/// lock for it: kInput error when another process works on the campaign, kEnvironment or kExhausted
/// when it can only be read.
Status keep_errors(Campaign& campaign, const ErrorCheck& check);

}  // namespace seedframe
