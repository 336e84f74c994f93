#include "quality/error_record.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "tests/campaign/campaign_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class ErrorRecordTest : public CampaignFixture {
 protected:
  /// Of one frame, in rmse8.
  static ErrorCheck check_of(std::int64_t frame, double rmse8) {
    ErrorCheck check;
    check.reference_samples = 256;
    CheckedFrame checked{frame, "id", "pixels", {}};
    checked.error.display.mse = rmse8 * rmse8;
    check.frames = {checked};
    return check;
  }
};

TEST_F(ErrorRecordTest, IsReadBackAsItWasWritten) {
  const ErrorRecord record = {{3, {"a", "b", 1024, {{"flip", 0.25}, {"rmse8", 4.5}}}},
                              {12, {"c", "d", 64, {}}}};
  const auto read = error_record_from_json(to_json(record), "the store");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, record);
}

TEST_F(ErrorRecordTest, KeepsWhatIsNoNumber) {
  const ErrorRecord record = {
      {3, {"a", "b", 1024, {{"rmse8", std::numeric_limits<double>::infinity()}}}}};
  const auto read =
      error_record_from_json(*parse_json(canonical_json(to_json(record)), "json"), "");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(std::isnan(read->at(3).errors.at("rmse8")));
}

TEST_F(ErrorRecordTest, RefusesWhatItNeverWrites) {
  for (const char* text :
       {"[]", "{}", R"({"version": 1})", R"({"version": 1, "frames": {"x": {}}})",
        R"({"version": 1, "frames": {"1": {}}})", R"({"version": 1, "frames": {"1x": {}}})"}) {
    const auto read = error_record_from_json(Json::parse(text), "the store");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().kind, ErrorKind::kCorrupt) << text;
  }
  EXPECT_THAT(
      error_record_from_json(Json::parse(R"({"version": 2, "frames": {}})"), "s").error().message,
      HasSubstr("s has measured errors of version 2"));
}

TEST_F(ErrorRecordTest, GrowsByWhatIsMeasuredAndTakesTheNewer) {
  EXPECT_TRUE(read_error_record(campaign())->empty());
  Campaign opened = *open_campaign(campaign().files.root());
  locked_.reset();  // and its lock
  ASSERT_TRUE(keep_errors(opened, check_of(2, 5.0)));
  ASSERT_TRUE(keep_errors(opened, check_of(7, 1.0)));
  ASSERT_TRUE(keep_errors(opened, check_of(2, 3.0)));
  const auto record = read_error_record(opened);
  ASSERT_TRUE(record) << record.error().message;
  EXPECT_EQ(record->size(), 2u);
  EXPECT_DOUBLE_EQ(record->at(2).errors.at("rmse8"), 3.0);
  EXPECT_EQ(record->at(7).reference_samples, 256);
  EXPECT_EQ(record->at(7).errors.size(), measures().size());
}

TEST_F(ErrorRecordTest, IsNotWrittenWhileAnotherWorksOnTheCampaign) {
  Campaign opened = *open_campaign(campaign().files.root());
  const Status kept = keep_errors(opened, check_of(2, 5.0));
  ASSERT_FALSE(kept);
  EXPECT_THAT(kept.error().message, HasSubstr("another seedframe is at work on"));
  EXPECT_TRUE(read_error_record(opened)->empty());
}

TEST(RecordedErrors, AreOfTheFrameThatWasMeasured) {
  const RecordedError recorded{"id", "pixels", 64, {}};
  FrameRow row;
  row.state = FrameState::kDone;
  row.frame_id = "id";
  row.pixel_hash = "pixels";
  EXPECT_TRUE(is_of(recorded, row));
  row.pixel_hash = "others";
  EXPECT_FALSE(is_of(recorded, row)) << "rendered again, otherwise";
  row.pixel_hash = "pixels";
  row.frame_id = "another";
  EXPECT_FALSE(is_of(recorded, row));
  row.frame_id = "id";
  row.state = FrameState::kPending;
  EXPECT_FALSE(is_of(recorded, row));
}

}  // namespace
}  // namespace seedframe
