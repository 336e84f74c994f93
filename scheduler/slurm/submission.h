// A submission: an array of tasks, each of which makes a batch of frames on one node. Head and
// tasks talk by files in a folder that both see (docs/cluster.md):
//
//     slurm/0001/submission.json   what is to be done; written before sbatch is called
//                task.sh           what Slurm starts
//                job               the array's job, once it is known
//                claims/17         batch 17 belongs to whoever could make this file (O_EXCL)
//                claims/17.node    where its task was started, said before anything can go wrong
//                claims/17.over    the head has closed the batch: what comes now is not looked at
//                17/               made by the task: a folder and a record for each frame
//                17.over/          the same, closed
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "spec/campaign_source.h"
#include "spec/quality_wish.h"

namespace seedframe {

struct RunOptions;

/// The names of all these files.
class SubmissionFiles {
 public:
  explicit SubmissionFiles(std::filesystem::path root) : root_(std::move(root)) {}

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path submission() const { return root_ / "submission.json"; }
  std::filesystem::path script() const { return root_ / "task.sh"; }
  std::filesystem::path job() const { return root_ / "job"; }
  std::filesystem::path claims() const { return root_ / "claims"; }
  std::filesystem::path claim(int batch) const { return claims() / std::to_string(batch); }
  std::filesystem::path node(int batch) const {
    return claims() / (std::to_string(batch) + ".node");
  }
  std::filesystem::path over(int batch) const {
    return claims() / (std::to_string(batch) + ".over");
  }
  std::filesystem::path results(int batch) const { return root_ / std::to_string(batch); }
  std::filesystem::path closed_results(int batch) const {
    return root_ / (std::to_string(batch) + ".over");
  }

 private:
  std::filesystem::path root_;
};

/// What tasks need to make frames without the campaign's store.
// NOLINTNEXTLINE(bugprone-exception-escape): Json's move asserts, and throws nothing
struct Submission {
  std::string token;                               ///< that no other submission of anybody has
  std::vector<std::vector<std::int64_t>> batches;  ///< frames, by the index of the task
  std::map<std::int64_t, int> crashes;             ///< that frames have cost so far, if any
  CampaignSource source;                           ///< with absolute paths
  std::shared_ptr<const RenderChoices> choices;    ///< of a campaign that promises an error
  std::filesystem::path node_folder;               ///< see SlurmOptions
  Json run;                                        ///< see options_for_tasks
};

Json to_json(const Submission& submission);
/// Reads what to_json wrote. kCorrupt: it is not that. kEnvironment: another version of Seedframe
/// wrote it.
Result<Submission> read_submission(const SubmissionFiles& files);

/// What of the options of a run its tasks follow; the rest is chosen on the node.
Json options_for_tasks(const RunOptions& asked);
Result<RunOptions> options_of_tasks(const Json& run, const std::string& what);

/// Who has a batch.
struct Claim {
  std::string node = {};
  std::string task = {};  ///< "<job>_<index>" as Slurm calls it
  bool by_head = false;
};

enum class ClaimOutcome { kOurs, kTaken };

/// Takes a batch, for ever; one caller at most gets it. Written and on the disk.
Result<ClaimOutcome> claim_batch(const SubmissionFiles& files, int batch, const Claim& claim);
/// None: nobody has taken it.
std::optional<Claim> read_claim(const SubmissionFiles& files, int batch);

/// Closes a batch for its task: what the task still writes finds no folder, and nobody looks at it.
Status close_batch(const SubmissionFiles& files, int batch);
bool is_closed(const SubmissionFiles& files, int batch);

}  // namespace seedframe
