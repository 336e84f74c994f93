// Frames of a campaign rendered once more, in conditions that are chosen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "audit/condition.h"
#include "base/canonical_json.h"
#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "campaign/run_options.h"

namespace seedframe {

/// How a frame came to be, as far as the job store knows.
struct MadeWith {
  Json provenance = Json::object();  ///< of its attempt
  int threads = 1;
  std::optional<Kernels> kernels;
  bool persistent_data = false;
  std::vector<std::int64_t> before;  ///< that its worker had rendered, oldest first; the last few
};
Result<MadeWith> made_with(const JobStore& store, std::int64_t frame);

/// `options` with conditions varied, each as condition.h says. `portable`: the kernels are pinned
/// and stay so, and kIsa hides instructions from the C library instead. `temporary` is a folder.
RunOptions vary(RunOptions options, const Conditions& varied, bool portable,
                const std::filesystem::path& temporary);

/// A folder for temporary files as no other is named, below an audit's.
inline constexpr const char* kElsewhere = "elsewhere für später";

struct Arrangement {
  std::vector<std::int64_t> frames;  ///< in the order in which they are handed out
  int workers = 1;
  bool other_nodes = false;  ///< on other nodes than those that made them
};

/// A run of frames on other nodes of a cluster than those that made them, with these options.
using OnOtherNodes =
    std::function<Result<MakeRun>(const std::vector<std::int64_t>& frames, const RunOptions&)>;

/// What to render to get `frames`: with kHistory some companions before them for each worker, with
/// kOrder the last frame first, and with kWorkers companions beside them if there are fewer frames
/// than workers. With too few companions for a history, there are fewer workers.
Arrangement arrange(std::vector<std::int64_t> frames, const Conditions& varied,
                    const std::vector<std::int64_t>& companions, int workers);

/// Renders frames anew, finished as those of the campaign; which is only read.
class Rerenderer {
 public:
  /// All must outlive it.
  Rerenderer(PreparedCampaign& prepared, const RunSetup& setup, RunObserver& observer,
             OnOtherNodes on_other_nodes)
      : prepared_(prepared),
        setup_(setup),
        observer_(observer),
        on_other_nodes_(std::move(on_other_nodes)) {}

  /// Into a folder that becomes a campaign of these frames alone. What was there is removed. With
  /// `options` instead of the setup's; the number of workers is the arrangement's. A frame that
  /// failed is no error: its row says why.
  Result<Campaign> render(const Arrangement& arrangement, RunOptions options,
                          const std::filesystem::path& folder);

 private:
  PreparedCampaign& prepared_;
  const RunSetup& setup_;
  RunObserver& observer_;
  OnOtherNodes on_other_nodes_;
};

}  // namespace seedframe
