#include "report/campaign_status.h"

#include <gmock/gmock.h>

#include "tests/campaign/campaign_fixture.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class CampaignStatusTest : public CampaignFixture {
 protected:
  CampaignStatus status() {
    Result<CampaignStatus> read = read_status(campaign());
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : CampaignStatus();
  }
};

TEST_F(CampaignStatusTest, OfANewCampaignEverythingIsPending) {
  const CampaignStatus now = status();
  EXPECT_EQ(now.counts.pending, kFrames);
  EXPECT_EQ(now.dataset_hash, "");
  EXPECT_FALSE(now.timings);
  EXPECT_THAT(now.failures, IsEmpty());
}

TEST_F(CampaignStatusTest, WhoeverHoldsTheLockIsAtWork) {
  EXPECT_TRUE(status().running);
  const CampaignFiles files = campaign().files;
  locked_.reset();
  const Result<Campaign> opened = open_campaign(files.root());
  ASSERT_TRUE(opened);
  EXPECT_FALSE(read_status(*opened)->running);
}

TEST_F(CampaignStatusTest, TellsOfFailuresAndOfWhatIsQuarantined) {
  ASSERT_TRUE(campaign().store.attempt_failed(3, 1, AttemptOutcome::kError, FrameState::kFailed,
                                              "no such thing"));
  ASSERT_TRUE(campaign().store.attempt_failed(5, 1, AttemptOutcome::kCrash,
                                              FrameState::kQuarantined, "it crashed"));
  const Json json = to_json(status());
  EXPECT_EQ(json.at("failed"), 1);
  EXPECT_EQ(json.at("quarantined"), 1);
  EXPECT_EQ(json.at("recent_failures").size(), 2u);
  EXPECT_EQ(json.at("quarantined_frames").at(0).at("frame"), 5);
}

TEST_F(CampaignStatusTest, TellsOfEachWorkerAndWhenAllWillBeDone) {
  JobStore& store = campaign().store;
  EXPECT_FALSE(status().left_s) << "nothing is done yet";
  for (const std::int64_t frame : {0, 1}) {
    ASSERT_TRUE(store.attempt_started(frame, 1, 0, 100.0 + 5.0 * static_cast<double>(frame)));
    ASSERT_TRUE(store.frame_done(frame, 1, {"hash", "", {}}, {.build_s = 1.0, .render_s = 3.0}));
  }
  ASSERT_TRUE(store.attempt_started(2, 1, 0, 110.0));
  const Result<CampaignStatus> now = read_status(campaign(), 112.0);
  ASSERT_TRUE(now) << now.error().message;
  ASSERT_EQ(now->workers.size(), 1U);
  EXPECT_EQ(now->workers[0].row.done, 2);
  EXPECT_DOUBLE_EQ(now->workers[0].row.frame_s, 4.0);
  EXPECT_DOUBLE_EQ(now->workers[0].frame_for_s, 2.0);
  ASSERT_TRUE(now->left_s);
  EXPECT_DOUBLE_EQ(*now->left_s, 10.0 * 12.0 / 2.0) << "ten are left, two took 12 s";
  const Json json = to_json(*now);
  EXPECT_EQ(json.at("workers").at(0).at("frame"), 2);
  EXPECT_EQ(json.at("left_s"), 60.0);
}

TEST_F(CampaignStatusTest, OfACampaignThatNobodyWorksOnThereAreNoWorkers) {
  ASSERT_TRUE(campaign().store.attempt_started(0, 1, 0, 100.0));
  const CampaignFiles files = campaign().files;
  locked_.reset();
  const Result<Campaign> opened = open_campaign(files.root());
  ASSERT_TRUE(opened);
  EXPECT_TRUE(read_status(*opened)->workers.empty());
  EXPECT_FALSE(read_status(*opened)->left_s);
}

TEST_F(CampaignStatusTest, AMixtureIsNamedByWhatDiffers) {
  CampaignStatus mixed;
  mixed.provenances = {R"({"kernel":"avx2","threads":1})", R"({"kernel":"avx2","threads":2})"};
  EXPECT_THAT(mixed_provenances(mixed), IsEmpty()) << "threads change no pixel";
  mixed.provenances.emplace_back(R"({"kernel":"avx","threads":1})");
  EXPECT_THAT(mixed_provenances(mixed), ElementsAre(HasSubstr("kernel avx instead of avx2")));
}

}  // namespace
}  // namespace seedframe
