// Which frames of a campaign an audit renders again.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "store/job_store.h"

namespace seedframe {

struct SampleWish {
  std::int64_t frames = 12;
  double share = 0.0;  ///< of the frames that are done, if that is more
  std::uint64_t seed = 0;
  std::vector<std::int64_t> only;  ///< just these, if there are any
};

struct SampledFrame {
  FrameRow row;
  std::string why;  ///< "asked for", "was tried 3 times", …, or "drawn"
};

struct AuditSample {
  std::vector<SampledFrame> frames;  ///< in order
  std::vector<FrameRow> failed;      ///< frames that failed or are quarantined: there is no picture
  std::int64_t done = 0;             ///< frames of the campaign that can be audited
  std::int64_t total = 0;
};

/// Frames that something was odd about come first: that were tried more than once, that cost a
/// worker, or that their twins saw otherwise inside of objects. The rest are drawn, one of each
/// scene in turn. The same store and wish give the same sample. kInput: a frame that is wished for
/// is not there, or not done.
Result<AuditSample> choose_sample(const JobStore& store, const SampleWish& wish);

}  // namespace seedframe
