#include "campaign/finish_stage.h"

#include <atomic>

#include <gmock/gmock.h>

#include "tests/campaign/campaign_fixture.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class Client : public FinishClient {
 public:
  void frame_written(const FrameJob& job, const Status& status) override {
    (status ? written : lost).push_back(job.frame);
  }
  void failure_written(const FrameJob& job) override { failures.push_back(job.frame); }
  void ends() override { ++ended; }

  std::vector<std::int64_t> written, lost, failures;
  std::atomic<int> ended = 0;
};

class FinishStageTest : public CampaignFixture {
 protected:
  void finish(FinishStage& stage, const FrameJob& job) {
    stage.begin(job, 0, "{}");
    stage.push([this, &stage, job] {
      const auto folder = campaign().files.attempt(job.frame, job.attempt);
      ASSERT_TRUE(make_folders(folder));
      ASSERT_TRUE(write_file_unsynced(folder / "file", "bytes"));
      stage.commit({job, "hash", {}, {}});
    });
  }
  Client client_;
};

TEST_F(FinishStageTest, CommitsWhatIsFinishedAndTellsRunAndObserver) {
  FinishStage stage(campaign(), observer_, client_, 2);
  ASSERT_TRUE(stage.open());
  finish(stage, {3, 1});
  finish(stage, {5, 1});
  ASSERT_TRUE(stage.close());
  EXPECT_EQ(counts().done, 2);
  EXPECT_EQ(client_.written.size(), 2u);
  EXPECT_EQ(observer_.done, client_.written);
  EXPECT_EQ(client_.ended, 0);
  EXPECT_TRUE(std::filesystem::exists(campaign().files.frame(3) / "file"));
  EXPECT_FALSE(std::filesystem::exists(campaign().files.work()));
}

TEST_F(FinishStageTest, AFailureIsWrittenAndItsFolderGoes) {
  FinishStage stage(campaign(), observer_, client_, 1);
  ASSERT_TRUE(stage.open());
  const auto folder = campaign().files.attempt(4, 1);
  ASSERT_TRUE(make_folders(folder));
  stage.begin({4, 1}, 0, "{}");
  stage.fail({4, 1}, {Failure::kAnswered, Consequence::kFailed, "no", {}});
  EXPECT_FALSE(std::filesystem::exists(folder));
  ASSERT_TRUE(stage.close());
  EXPECT_THAT(client_.failures, ElementsAre(4));
  EXPECT_THAT(observer_.messages, ElementsAre("no"));
  EXPECT_EQ(counts().failed, 1);
}

TEST_F(FinishStageTest, TheFirstErrorIsTheOneThatCounts) {
  FinishStage stage(campaign(), observer_, client_, 1);
  ASSERT_TRUE(stage.open());
  stage.end({ErrorKind::kExhausted, "full"});
  stage.end({ErrorKind::kEnvironment, "a consequence"});
  const Status outcome = stage.close();
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().message, "full");
  EXPECT_GE(client_.ended, 1);
}

TEST_F(FinishStageTest, AStoreThatAnotherRunHasTakenEndsTheRun) {
  FinishStage stage(campaign(), observer_, client_, 1);
  ASSERT_TRUE(stage.open());
  Result<Campaign> other = open_campaign(campaign().files.root());
  ASSERT_TRUE(other);
  ASSERT_TRUE(begin_run(*other));
  finish(stage, {3, 1});
  EXPECT_FALSE(stage.close());
  EXPECT_THAT(client_.written, IsEmpty());
  EXPECT_THAT(client_.lost, ElementsAre(3));
  EXPECT_THAT(observer_.done, IsEmpty());
  EXPECT_GE(client_.ended, 1);
}

TEST_F(FinishStageTest, CanBeOpenedAgain) {
  FinishStage stage(campaign(), observer_, client_, 1);
  for (const std::int64_t frame : {1, 2}) {
    ASSERT_TRUE(stage.open());
    finish(stage, {frame, 1});
    ASSERT_TRUE(stage.close());
  }
  EXPECT_THAT(observer_.done, ElementsAre(1, 2));
}

}  // namespace
}  // namespace seedframe
