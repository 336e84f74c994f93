#include "slurm/task_book.h"

#include <gtest/gtest.h>

#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

class TaskBookTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Submission prototype;
    prototype.batches = {{0, 1}, {2}};
    const auto created = book_.create(std::move(prototype), {}, ledger_);
    ASSERT_TRUE(created);
    submission_ = *created;
  }
  /// What squeue lists: a task of the job, with this comment.
  void list(std::int64_t job, const std::string& comment) {
    const QueuedTask task{job, /*index=*/0, /*waits=*/true, /*node=*/"", comment};
    ASSERT_TRUE(book_.find_jobs({task}));
  }

  const ScratchFolder scratch_;
  const CampaignFiles files_{scratch_.path()};
  FrameLedger ledger_{AttemptLimits{}};
  TaskBook book_{files_};
  HeadSubmission* submission_ = nullptr;
};

TEST_F(TaskBookTest, AJobWhoseAnswerWasLostIsFoundByItsComment) {
  list(7, "seedframe another");
  EXPECT_FALSE(submission_->job);
  EXPECT_FALSE(submission_->queued);
  list(8, submission_->comment());
  EXPECT_EQ(submission_->job, 8);
  EXPECT_TRUE(submission_->queued);
}

// A controller that was killed forgets the last ids that it gave, and gives them again.
TEST_F(TaskBookTest, AJobThatBearsItsIdButNotItsCommentIsNotItsOwn) {
  ASSERT_TRUE(book_.set_job(*submission_, 8));
  list(8, submission_->comment());
  EXPECT_TRUE(submission_->queued);
  list(8, "somebody else's");
  EXPECT_EQ(submission_->job, 8);
  EXPECT_FALSE(submission_->queued);
  list(8, "(null)");  // of a cluster that keeps no comments
  EXPECT_TRUE(submission_->queued);
  ASSERT_TRUE(book_.find_jobs({}));
  EXPECT_FALSE(submission_->queued);
}

}  // namespace
}  // namespace seedframe
