#include "page/report_file.h"

#include <gmock/gmock.h>

#include "campaign/campaign_runner.h"
#include "frames/campaign_files.h"
#include "tests/campaign/campaign_fixture.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class ReportTest : public CampaignFixture {
 protected:
  void make_frames() {
    RunSetup setup;
    setup.options.pool.workers = 2;
    setup.options.worker.threads = 1;
    CampaignRunner runner(campaign(), *prepared_, used_, setup, observer_);
    const auto summary = runner.run_to_end(all_frames());
    ASSERT_TRUE(summary) << summary.error().message;
  }
  /// The text of the report; empty if there is none.
  std::string report(ReportWish wish = {}, bool with_config = true) {
    if (wish.file.empty()) wish.file = scratch_ / "page.html";
    const auto made =
        write_report(campaign(), with_config ? prepared_.get() : nullptr, "no config here", wish);
    EXPECT_TRUE(made) << made.error().message;
    if (!made) return {};
    written_ = *made;
    return *read_file(wish.file);
  }
  static Json data_of(const std::string& page) {
    const std::string begin = "id=\"data\">";
    const std::size_t from = page.find(begin) + begin.size();
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
  }
  void damage(std::int64_t frame) {
    const fs::path file = campaign().files.frame(frame) / frame_files::kInstances;
    std::string bytes = *read_file(file);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    fs::remove(file);
    ASSERT_TRUE(write_file(file, bytes));
  }

  UsedFiles used_;
  WrittenReport written_;
};

TEST_F(ReportTest, OfANewCampaignSaysThatNothingIsMade) {
  const Json data = data_of(report());
  EXPECT_EQ(data.at("summary").at("pending"), kFrames);
  EXPECT_EQ(data.at("frames").at("count"), kFrames);
  EXPECT_EQ(data.at("objects").at("count"), 0);
  EXPECT_TRUE(data.at("health").empty());
  EXPECT_TRUE(data.at("audit").is_null());
}

TEST_F(ReportTest, HasAllOfAFinishedCampaign) {
  make_frames();
  const std::string page = report();
  const Json data = data_of(page);
  EXPECT_EQ(data.at("summary").at("done"), kFrames);
  EXPECT_EQ(data.at("summary").at("dataset_hash"), *campaign().store.dataset_hash());
  EXPECT_EQ(data.at("campaign").at("categories"), Json({"gear"}));
  EXPECT_FALSE(data.at("campaign").at("has_pictures").get<bool>());
  EXPECT_GT(data.at("objects").at("count").get<int>(), 0);
  EXPECT_EQ(data.at("draws").at("frames"), kFrames);
  EXPECT_FALSE(data.at("health").empty());
  EXPECT_THAT(page, HasSubstr("id=\"part-0\""));
  EXPECT_EQ(written_.bytes, page.size());
  EXPECT_EQ(written_.damaged, 0);
}

TEST_F(ReportTest, IsTheSameAgainWhateverTheThreads) {
  make_frames();
  ReportWish one;
  one.page.threads = 1;
  ReportWish four;
  four.page.threads = 4;
  EXPECT_EQ(report(one), report(four));
}

TEST_F(ReportTest, TellsNoPathOfThisMachine) {
  make_frames();
  damage(3);
  ASSERT_TRUE(campaign().store.reset(5));
  ASSERT_TRUE(campaign().store.attempt_failed(
      5, 2, AttemptOutcome::kError, FrameState::kFailed,
      "cannot read " + (campaign().files.root() / "frames").string()));
  const std::string page = report();
  EXPECT_THAT(page, Not(HasSubstr(scratch_.path().string())));
  EXPECT_THAT(page, HasSubstr("cannot read campaign/frames"));
}

TEST_F(ReportTest, ADamagedFrameIsToldAndTheOthersAreThere) {
  make_frames();
  damage(3);
  const Json data = data_of(report());
  EXPECT_EQ(written_.damaged, 1);
  EXPECT_EQ(data.at("summary").at("damaged"), 1);
  EXPECT_GT(data.at("objects").at("count").get<int>(), 0);
}

TEST_F(ReportTest, AFailedFrameHasItsLastWordsAndItsLog) {
  const fs::path log = campaign().files.crash_log(4, 1);
  fs::create_directories(log.parent_path());
  ASSERT_TRUE(write_file(log, "the first line\n\x1b[31m<b>the last</b> \xff"));
  ASSERT_TRUE(campaign().store.attempt_failed(4, 1, AttemptOutcome::kCrash,
                                              FrameState::kQuarantined, "it crashed"));
  const Json failure = data_of(report()).at("failures").at("frames").at(0);
  EXPECT_EQ(failure.at("frame"), 4);
  EXPECT_EQ(failure.at("state"), "quarantined");
  EXPECT_EQ(failure.at("error"), "it crashed");
  EXPECT_THAT(failure.at("log").get<std::string>(), HasSubstr("?[31m<b>the last</b>"));
}

TEST_F(ReportTest, WithoutTheConfigLeavesOutDrawsAndSaysWhy) {
  make_frames();
  const Json data = data_of(report({}, /*with_config=*/false));
  EXPECT_TRUE(data.at("draws").at("variables").empty());
  EXPECT_EQ(data.at("draws").at("left_out"), "no config here");
  EXPECT_GT(data.at("objects").at("count").get<int>(), 0);
}

TEST_F(ReportTest, OfManyFramesShowsSomeEvenlySpread) {
  make_frames();
  ReportWish wish;
  wish.page.most_frames = 5;
  const Json data = data_of(report(wish));
  EXPECT_EQ(data.at("frames").at("count"), 5);
  EXPECT_EQ(data.at("summary").at("frames"), kFrames);
  EXPECT_EQ(data.at("summary").at("shown"), 5);
}

TEST_F(ReportTest, ThumbnailsOfManyFramesAreInAFolderBesideIt) {
  make_frames();
  ReportWish wish;
  wish.most_inside = 3;
  const std::string page = report(wish);
  EXPECT_EQ(data_of(page).at("parts").at("folder"), "page_files");
  EXPECT_THAT(page, Not(HasSubstr("id=\"part-0\"")));
  const auto part = read_file(scratch_ / "page_files/part-0.js");
  ASSERT_TRUE(part);
  EXPECT_THAT(*part, ::testing::StartsWith("seedframePart(0, {"));
  EXPECT_EQ(report(wish), page) << "an earlier one is replaced";
  EXPECT_FALSE(fs::exists(scratch_ / "page_files.new"));
}

TEST_F(ReportTest, AFolderOfSomebodyElseStays) {
  fs::create_directories(scratch_ / "page_files");
  ASSERT_TRUE(write_file(scratch_ / "page_files/thesis.tex", "all of it"));
  ReportWish wish;
  wish.file = scratch_ / "page.html";
  wish.most_inside = 3;
  const auto written = write_report(campaign(), prepared_.get(), "", wish);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kInput);
  EXPECT_THAT(written.error().message, HasSubstr("thesis.tex"));
  EXPECT_TRUE(fs::exists(scratch_ / "page_files/thesis.tex"));
}

TEST_F(ReportTest, AnAuditIsShownWithItsGrade) {
  fs::create_directories(campaign().files.root() / "audit");
  ASSERT_TRUE(write_file(campaign().files.root() / "audit/report.json",
                         R"({"grade": "rounding", "grades": {"rounding": 1}, "frames":
                             [{"frame": 2, "grade": "rounding", "why": "drawn"}]})"));
  const Json audit = data_of(report()).at("audit");
  EXPECT_EQ(audit.at("grade"), "rounding");
  EXPECT_EQ(audit.at("frames").at(0).at("frame"), 2);
  ASSERT_TRUE(write_file(campaign().files.root() / "audit/report.json", "[1, 2"));
  EXPECT_TRUE(data_of(report()).at("audit").is_null()) << "one that cannot be read is none";
}

TEST_F(ReportTest, LinksToFramesOnlyFromTheirFolder) {
  make_frames();
  EXPECT_FALSE(data_of(report()).at("beside").get<bool>());
  ReportWish wish;
  wish.file = campaign().files.report();
  EXPECT_TRUE(data_of(report(wish)).at("beside").get<bool>());
}

}  // namespace
}  // namespace seedframe
