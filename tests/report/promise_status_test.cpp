#include "report/promise_status.h"

#include <gmock/gmock.h>

#include "quality/error_record.h"
#include "tests/campaign/campaign_fixture.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class PromiseStatusTest : public CampaignFixture {
 protected:
  void SetUp() override {
    CampaignFixture::SetUp();
    const QualityWish wish = {QualityMetric::kRmse8, 4.0, 0.75, false};
    ASSERT_TRUE(store().set_meta(kQualityKey, canonical_json(to_json(wish))));
    for (std::int64_t frame = 0; frame < kFrames; ++frame) {
      ASSERT_TRUE(store().adopt(frame, {"pixels", "", {}}));
    }
  }
  JobStore& store() { return campaign().store; }

  /// Of frames as they are in the store now.
  void measure(const std::map<std::int64_t, double>& errors) {
    for (const auto& [frame, error] : errors) {
      record_[frame] = {(*store().frame(frame))->frame_id, "pixels", 512, {{"rmse8", error}}};
    }
    ASSERT_TRUE(store().set_meta("errors", canonical_json(to_json(record_))));
  }
  void raise(const std::vector<std::int64_t>& frames) {
    for (const std::int64_t frame : frames) {
      raises_.push_back({{"frame", frame}});
      ASSERT_TRUE(store().renew(frame, "raised"));
      ASSERT_TRUE(store().adopt(frame, {"pixels", "", {}}));
    }
    const Json json = {{"version", 1}, {"raises", raises_}};
    ASSERT_TRUE(store().set_meta("raises", canonical_json(json)));
  }
  PromiseStatus status() {
    const auto read = read_promise_status(campaign());
    EXPECT_TRUE(read && *read);
    return read && *read ? **read : PromiseStatus();
  }
  std::string first_line() { return lines_of(status(), "c").front(); }

  ErrorRecord record_;
  Json raises_ = Json::array();
};

TEST_F(PromiseStatusTest, WhoPromisesNothingHasNone) {
  ASSERT_TRUE(store().set_meta(kQualityKey, ""));
  const auto read = read_promise_status(campaign());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_FALSE(*read);
}

TEST_F(PromiseStatusTest, SaysHowToCheck) {
  EXPECT_EQ(first_line(),
            "75 % of the frames within rmse8 of 4: promised; not checked yet: 'seedframe "
            "verify-error c'");
  EXPECT_FALSE(to_json(status()).contains("kept"));
}

TEST_F(PromiseStatusTest, IsOfTheFramesThatWereMeasured) {
  measure({{1, 3.0}, {4, 4.0}, {7, 4.5}, {9, 0.0}});
  const PromiseStatus now = status();
  EXPECT_EQ(now.checked, 4);
  EXPECT_EQ(now.reference_samples, 512);
  EXPECT_DOUBLE_EQ(now.as_chosen.value, 0.75);
  EXPECT_TRUE(now.is_kept);
  EXPECT_THAT(lines_of(now, "c"),
              ElementsAre("75 % of the frames within rmse8 of 4: promised; checked on 4 frames: "
                          "75 % (between 30 and 95 %): kept",
                          "beyond it: 7 (4.5); 'seedframe resume c --raise' gives them more "
                          "samples"));
  EXPECT_EQ(to_json(now).at("beyond"), Json({{{"frame", 7}, {"error", 4.5}}}));
}

TEST_F(PromiseStatusTest, FramesThatWereRenderedAgainCountNoMore) {
  measure({{1, 3.0}, {7, 4.5}});
  ASSERT_TRUE(store().reset(7));
  EXPECT_EQ(status().checked, 1) << "it is pending";
  ASSERT_TRUE(store().adopt(7, {"other pixels", "", {}}));
  EXPECT_EQ(status().checked, 1);
  ASSERT_TRUE(store().adopt(7, {"pixels", "", {}}));
  EXPECT_EQ(status().checked, 2) << "bit-identical, so it is as wrong as it was";
}

TEST_F(PromiseStatusTest, ARaisedFrameIsBeyondUntilItIsMeasured) {
  measure({{1, 3.0}, {4, 4.0}, {7, 4.5}, {9, 6.0}});
  EXPECT_THAT(first_line(), HasSubstr("50 % (between 15 and 85 %): BROKEN"));
  raise({7, 9});
  PromiseStatus now = status();
  EXPECT_EQ(now.checked, 4);
  EXPECT_THAT(now.beyond, IsEmpty());
  EXPECT_THAT(now.raised_unmeasured, ElementsAre(7, 9));
  EXPECT_DOUBLE_EQ(now.share_now, 0.5);
  EXPECT_EQ(lines_of(now, "c").back(),
            "raised and not checked since: 'seedframe verify-error c --frame 7 --frame 9'");
  measure({{7, 3.9}, {9, 4.1}});
  now = status();
  ASSERT_EQ(now.beyond.size(), 1u);
  EXPECT_EQ(now.beyond.front().frame, 9);
  EXPECT_THAT(now.raised_unmeasured, IsEmpty());
}

// Raising what was looked at mends nothing of what was not.
TEST_F(PromiseStatusTest, OtherFramesAreAsThoseWereThatWereChosenLikeThem) {
  measure({{1, 3.0}, {4, 4.0}, {7, 4.5}, {9, 6.0}});
  raise({7, 9});
  measure({{7, 2.0}, {9, 2.0}});
  const PromiseStatus now = status();
  EXPECT_DOUBLE_EQ(now.as_chosen.value, 0.5);
  EXPECT_DOUBLE_EQ(now.share_now, (4.0 + 8.0 * 0.5) / 12.0);
  EXPECT_FALSE(now.is_kept);
  EXPECT_THAT(first_line(), HasSubstr("50 % (between 15 and 85 %) as they were chosen; 2 of them "
                                      "raised since, which makes 67 % of all: BROKEN"));
  for (std::int64_t frame = 0; frame < kFrames; ++frame) measure({{frame, 2.0}});
  EXPECT_DOUBLE_EQ(status().share_now, 1.0);
  EXPECT_TRUE(status().is_kept);
}

TEST_F(PromiseStatusTest, OfADamagedStoreIsAnError) {
  ASSERT_TRUE(store().set_meta("errors", "{}"));
  EXPECT_FALSE(read_promise_status(campaign()));
  ASSERT_TRUE(store().set_meta("errors", ""));
  ASSERT_TRUE(store().set_meta("raises", R"({"version": 9, "raises": []})"));
  EXPECT_FALSE(read_promise_status(campaign()));
}

}  // namespace
}  // namespace seedframe
