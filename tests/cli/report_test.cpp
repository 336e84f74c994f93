// seedframe report and serve: what they print, where they write, and what they refuse.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ReportVerb : public ProgramTest {
 protected:
  void SetUp() override {
    write("small.yaml",
          "seedframe: 1\nname: small\nscenes: 2\ncategories: [gear]\nrender: {width: 32, height: "
          "24}\n"
          "objects: {gears: {asset: gear}}\ncamera: {distance_m: {uniform: [0.2, 0.5]}}\n"
          "labels: geometry\n");
    ASSERT_EQ(run({"submit", "small.yaml", "-o", "c", "--quiet"}).exit_code, 0);
  }
};

TEST_F(ReportVerb, WritesIntoTheCampaignsFolderAndSaysSo) {
  const Outcome outcome = run({"report", "c"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("c/report.html: 2 frames"));
  EXPECT_THAT(outcome.output, HasSubstr("warning"));
  EXPECT_TRUE(exists("c/report.html"));
  EXPECT_EQ(run({"resume", "c"}).exit_code, 0) << "it is in nobody's way";
  EXPECT_EQ(run({"audit", "c", "--frames", "0"}).exit_code, 0);
}

TEST_F(ReportVerb, OfAMovedCampaignIsThatOfTheCampaignWithoutDraws) {
  std::filesystem::rename(folder_ / "c", folder_ / "moved");
  write("small.yaml", "gone");
  std::string store = "moved/campaign.yaml";
  write(store, "not: a config\n");
  const Outcome outcome = run({"report", "moved", "-o", "page.html"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("draws and constraints are left out"));
  EXPECT_TRUE(exists("page.html"));
  EXPECT_THAT(*read_file(folder_ / "page.html"), Not(HasSubstr(folder_.string())));
}

TEST_F(ReportVerb, RefusesWhatIsNoCampaignAndPlacesThatAreNotThere) {
  EXPECT_EQ(run({"report", "nothing"}).exit_code, 2);
  EXPECT_EQ(run({"report"}).exit_code, 2);
  EXPECT_NE(run({"report", "c", "-o", "no/such/folder/page.html"}).exit_code, 0);
  EXPECT_FALSE(exists("c/report.html"));
}

TEST_F(ReportVerb, ServeRefusesWhatIsNoCampaignAndPortsThatAreNone) {
  EXPECT_EQ(run({"serve", "c", "nothing"}).exit_code, 2);
  EXPECT_EQ(run({"serve", "c", "--port", "70000"}).exit_code, 2);
  EXPECT_EQ(run({"serve"}).exit_code, 2);
}

TEST_F(ReportVerb, ServePrintsItsAddressAndEndsWithASignal) {
  const pid_t server = start({"serve", "c"});
  std::string printed;
  for (int i = 0; i < 1000 && printed.find("token=") == std::string::npos; ++i) {
    ::usleep(10'000);
    printed = read_file(folder_ / "out.txt").value_or("");  // of the run before, at first
  }
  EXPECT_THAT(printed, ::testing::ContainsRegex("http://127.0.0.1:[0-9]+/\\?token=[0-9a-f]{32}"));
  ::kill(server, SIGTERM);
  EXPECT_EQ(wait(server).exit_code, 0);
}

}  // namespace
}  // namespace seedframe
