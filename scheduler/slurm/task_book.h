// The head's account of what it has submitted: on the disk, so that the next head can go on.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "frames/campaign_files.h"
#include "slurm/frame_ledger.h"
#include "slurm/slurm_commands.h"
#include "slurm/submission.h"

namespace seedframe {

struct HeadBatch {
  std::vector<std::int64_t> frames;
  bool claimed = false;  ///< its task has begun
  bool closed = false;
  int looks_absent = 0;   ///< looks at the queue in a row that did not find it
  std::string node = {};  ///< that it runs or ran on, if we saw it
};

struct HeadSubmission {
  int number = 0;
  SubmissionFiles files{{}};
  std::string token;
  std::vector<HeadBatch> batches;
  ArrayOrder order;
  std::optional<std::int64_t> job;  ///< none: not submitted, or the answer was lost
  bool asked = false;               ///< sbatch was called, and the queue was not looked at since
  bool queued = false;              ///< tasks of it were in the queue when that was looked at
  int tries = 0;
  std::chrono::steady_clock::time_point next_try{};

  bool all_closed() const;
  /// A controller that was killed gives an id out again: what bears another comment is not ours.
  bool owns(const QueuedTask& task) const;
  std::string comment() const { return "seedframe " + token; }
};

class TaskBook {
 public:
  explicit TaskBook(const CampaignFiles& files) : files_(files) {}

  /// What an earlier head has left. A submission that cannot be read is named in `notes`, and left
  /// alone.
  Status load(std::vector<std::string>& notes);

  /// Writes the intent of a new submission, of `prototype` with these batches; from here on the
  /// frames are its.
  Result<HeadSubmission*> create(Submission prototype, ArrayOrder order, FrameLedger& ledger);

  std::vector<std::unique_ptr<HeadSubmission>>& submissions() { return submissions_; }
  std::int64_t open_batches() const;

  /// Which batches have begun, by their claims.
  void look_for_claims();
  /// Notes which submissions are in the queue, and the jobs of those whose answer was lost: by
  /// their comments there, or by what their tasks have claimed. What is known of neither may be
  /// submitted (again) then.
  Status find_jobs(const std::vector<QueuedTask>& queue);
  Status set_job(HeadSubmission& submission, std::int64_t job);

  /// Removes submissions that are closed, and all of it if nothing is left and `tidy`.
  void remove_closed(bool tidy);

 private:
  Result<std::unique_ptr<HeadSubmission>> load_one(const std::filesystem::path& folder) const;

  const CampaignFiles& files_;
  std::vector<std::unique_ptr<HeadSubmission>> submissions_;
  int last_number_ = 0;
};

}  // namespace seedframe
