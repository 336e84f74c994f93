// Why a frame comes out otherwise than it did: by rendering it again with one thing changed after
// another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "audit/condition.h"
#include "audit/rerender.h"
#include "base/error.h"

namespace seedframe {

struct Cause {
  enum class Kind {
    kNone,            ///< nothing differs
    kInputs,          ///< config, seed, assets or textures are not those of then
    kFiles,           ///< the stored frame is not as it was written
    kCondition,       ///< a condition that the audit varied
    kHistory,         ///< the frames that its worker had rendered before
    kPersistentData,  ///< the same, since Cycles kept data from frame to frame
    kKernels,         ///< the instructions of the CPU
    kProvenance,      ///< another program or library
    kUnstable,        ///< it differs from time to time in the same conditions
    kNotRendered,     ///< it could not be rendered
    kUnknown,
  };
  Kind kind = Kind::kNone;
  std::string text;  ///< a sentence without a full stop
};
const char* to_string(Cause::Kind kind);

/// What of the inputs that provenance.json lists has changed; otherwise which files were written
/// since the submission, or which values of the frame spec differ. `spec` are the differences.
Cause cause_of_inputs(const Campaign& campaign, const PreparedCampaign& prepared,
                      const UsedFiles& used, const std::vector<std::string>& spec);

class CauseFinder {
 public:
  /// `run` is as in the audit, `scratch` a folder for renderings. `companions` are frames to render
  /// before or beside. All must outlive it.
  CauseFinder(const Campaign& campaign, Rerenderer& rerenderer, const RunOptions& run,
              bool portable, std::vector<std::int64_t> companions, std::filesystem::path scratch);

  /// Of a frame that differed from `expected` (a pixel hash) when `varied` was varied, and was made
  /// with `provenance` then. An error only when nothing can be rendered at all.
  Result<Cause> find(std::int64_t frame, const std::string& expected, const Conditions& varied,
                     const Json& provenance);

 private:
  /// One rendering of the frame; `kernels` and `persistent_data` as recorded unless changed.
  struct Trial {
    Conditions varied;
    std::optional<Kernels> kernels;
    bool persistent_data = false;
    std::vector<std::int64_t> before;
  };
  /// The pixel hash; empty if it failed.
  Result<std::string> hash_of(const Trial& trial);
  Result<bool> is_as_expected(const Trial& trial);
  Result<Cause> bisect(const Conditions& varied, const Json& provenance);
  Result<Cause> name(const Conditions& culprits, const Json& provenance);
  Result<Cause> without_condition(const std::string& alone, const Json& provenance);

  const Campaign& campaign_;
  Rerenderer& rerenderer_;
  const RunOptions& run_;
  bool portable_;
  std::vector<std::int64_t> companions_;
  std::filesystem::path scratch_;
  // Of the frame that is looked at:
  std::int64_t frame_ = 0;
  std::string expected_;
  MadeWith made_;
  Trial as_recorded_;
  std::optional<Kernels> kernels_here_;  ///< that the audit rendered with
};

}  // namespace seedframe
