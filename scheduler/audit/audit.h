// Whether a campaign would come out as it did: its files, its inputs, and a sample rendered again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "audit/cause.h"
#include "audit/condition.h"
#include "audit/file_check.h"
#include "audit/frame_difference.h"
#include "audit/rerender.h"
#include "audit/sample.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "image/color_management.h"

namespace seedframe {

struct AuditOptions {
  SampleWish sample;
  Conditions vary;
  Tolerance tolerance;
  OnOtherNodes on_other_nodes;  ///< where that is varied
  int most_causes = 4;          ///< frames whose causes are looked for by more renderings
  /// Holds the renderings, which are campaigns of the sample, and pictures of differences.
  std::filesystem::path folder;
};

struct AuditedFrame {
  std::int64_t frame = 0;
  std::string why;                            ///< it is in the sample
  Grade grade = Grade::kIdentical;            ///< the worst of its renderings
  std::optional<FrameDifference> difference;  ///< of that one, if it has a picture
  std::string error;                          ///< why it has none
  std::vector<std::string> inputs;            ///< what is asked for today, if it is not what was
  Cause cause;
  std::filesystem::path picture;  ///< of the difference; empty if there is none
};

struct Audit {
  FileCheck files;
  AuditSample sample;
  std::vector<Conditions> rounds;  ///< the sample was rendered once in each
  std::vector<AuditedFrame> frames;
  /// Why only files were read, and held against nothing but each other; empty: they were not.
  std::string why_alone;

  std::int64_t count(Grade grade) const;
  /// The worst; of a frame that failed, or for which something else is asked today,
  /// kNotReproducible.
  Grade grade() const;
};

/// Only reads the campaign. Frames whose inputs have changed are rendered as they would be today.
/// An error is one of the audit itself: Blender that does not start, a disk that is full.
class Auditor {
 public:
  /// `setup` is that of a resume. All must outlive it.
  Auditor(const Campaign& campaign, PreparedCampaign& prepared, const RunSetup& setup,
          const AuditOptions& options);

  /// Files, duplicates, and which frames are in the sample.
  Status look();
  /// How many frames render() renders.
  std::int64_t renderings() const;
  /// Renders the sample in each round of conditions.
  Status render(RunObserver& observer);
  /// Frames that differ for no reason that is known without more renderings.
  std::int64_t unexplained() const;
  /// Looks for their causes.
  Status explain(RunObserver& observer);

  const Audit& result() const { return audit_; }

 private:
  std::vector<Conditions> rounds() const;
  /// How a round is rendered, and what in it.
  RunOptions options_of(const Conditions& varied) const;
  Arrangement arrangement_of(const Conditions& varied) const;
  Status compare_inputs(AuditedFrame& frame);
  Status render_round(const Conditions& varied, std::size_t number, Rerenderer& rerenderer);
  Status judge(const Campaign& rendered, AuditedFrame& frame);

  const Campaign& campaign_;
  PreparedCampaign& prepared_;
  const RunSetup& setup_;
  const AuditOptions& options_;
  bool portable_;
  std::vector<std::int64_t> companions_;  ///< see arrange
  int threads_ = 1;                       ///< with which the sample was rendered
  Audit audit_;
  /// By frame: the first round in which it differed, and what it was made with there.
  struct Departure {
    Conditions round;
    Json provenance;
  };
  std::map<std::int64_t, Departure> departures_;
};

}  // namespace seedframe
