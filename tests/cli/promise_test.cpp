// A promised error from submit to verify-error, status and resume --raise, with the fake Blender.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The fake's noise is one pixel, which is less than 10 codes of all; a reference that is brighter
/// is more than 25 away from black.
class PromiseTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("gears.yaml", R"(seedframe: 1
name: gears
scenes: 6
categories: [gear]
render: {width: 32, height: 24, samples: 256}
quality: {metric: rmse8, max_error: 25}
labels: {check: false}
world: {color: [0, 0, 0]}
objects: {gears: {asset: gear, position: [{uniform: [-0.1, 0.1]}, 0, 0]}}
camera: {position: [0, 0, 0.4], target: [0, 0, 0]}
)");
  }

  Outcome with_fake(std::vector<std::string> arguments, const std::string& fake = "{}") {
    arguments.insert(arguments.end(), {"--blender", kFakeBlender});
    return run(arguments, {"SEEDFRAME_FAKE=" + fake});
  }
  void submit() {
    const Outcome outcome = with_fake({"submit", "gears.yaml", "-o", "c", "--quiet"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  }
  /// Of all frames; the references of frame 1 are its jobs 2 and 3, and its pixels are not theirs.
  Outcome find_frame_1_beyond() {
    return with_fake({"verify-error", "c", "--quiet"}, R"({"brighter_frames": [2, 3]})");
  }

  std::string spec_of(int frame) {
    return *read_file(folder_ / fmt::format("c/frames/000/{:06}/frame.json", frame));
  }
  int samples_of(int frame) {
    return parse_json(spec_of(frame), "frame.json")->at("render").at("samples").get<int>();
  }
};

TEST_F(PromiseTest, IsToldByStatusBeforeAndAfterItIsChecked) {
  submit();
  EXPECT_THAT(run({"status", "c"}).output,
              HasSubstr("95 % of the frames within rmse8 of 25: promised; not checked yet: "
                        "'seedframe verify-error c'\n"));
  ASSERT_EQ(with_fake({"verify-error", "c", "--frames", "3", "--quiet"}).exit_code, 0);
  EXPECT_THAT(run({"status", "c"}).output,
              HasSubstr("checked on 3 frames: 100 % (between 44 and 100 %): kept\n"));
  const Json quality = status("c")["quality"];
  EXPECT_EQ(quality["measure"], "rmse8");
  EXPECT_EQ(quality["reference_samples"], 1024);
  EXPECT_EQ(quality["kept"], true);
}

TEST_F(PromiseTest, FramesBeyondItAreRaisedAndNoOthersRenderedAgain) {
  submit();
  ASSERT_EQ(find_frame_1_beyond().exit_code, 10);
  const Outcome told = run({"status", "c"});
  EXPECT_THAT(told.output, HasSubstr("checked on 6 frames: 83 % (between 44 and 97 %): BROKEN"));
  EXPECT_THAT(told.output, HasSubstr("beyond it: 1 ("));
  const int before = samples_of(1);
  std::map<std::string, std::string> others = contents("c/frames");
  const Outcome raised = with_fake({"resume", "c", "--raise"});
  ASSERT_EQ(raised.exit_code, 0) << raised.errors;
  EXPECT_THAT(raised.output, HasSubstr("1 in this run"));
  EXPECT_THAT(raised.output, HasSubstr("'seedframe verify-error c --frame 1'"));
  EXPECT_GT(samples_of(1), before);
  for (const auto& [path, bytes] : contents("c/frames")) {
    const bool is_other = path.find("000001") == std::string::npos;
    EXPECT_TRUE(!is_other || bytes == others[path]) << path;
  }
  EXPECT_THAT(run({"status", "c"}).output, HasSubstr("raised and not checked since"));

  ASSERT_EQ(with_fake({"verify-error", "c", "--frame", "1", "--quiet"}).exit_code, 0);
  EXPECT_THAT(run({"status", "c"}).output,
              HasSubstr("1 of them raised since, which makes 100 % of all: kept"));
  const Outcome again = with_fake({"resume", "c", "--raise"});
  EXPECT_THAT(again.errors, HasSubstr("no frame that was measured is beyond rmse8 of 25"));
  EXPECT_THAT(again.output, HasSubstr("0 in this run"));
  const Outcome audited = with_fake({"audit", "c", "--frames", "6", "--quiet"});
  EXPECT_EQ(audited.exit_code, 0) << "as it was raised, so it is rendered: " << audited.output;
}

TEST_F(PromiseTest, NobodyIsRaisedAboveAllSamples) {
  const Outcome submitted =
      with_fake({"submit", "gears.yaml", "-o", "c", "--quiet", "--set", "render.samples=1"});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.errors;
  ASSERT_EQ(find_frame_1_beyond().exit_code, 10);
  const Outcome raised = with_fake({"resume", "c", "--raise"});
  EXPECT_EQ(raised.exit_code, 0) << raised.errors;
  EXPECT_THAT(raised.errors, HasSubstr("with all render.samples (1): it cannot be raised"));
  EXPECT_THAT(raised.output, HasSubstr("0 in this run"));
}

TEST_F(PromiseTest, RaisingNeedsAPromiseAndACheck) {
  submit();
  const Outcome unchecked = with_fake({"resume", "c", "--raise"});
  EXPECT_EQ(unchecked.exit_code, 2);
  EXPECT_THAT(unchecked.errors, HasSubstr("no frame of c has been measured"));
  const Outcome plain =
      with_fake({"submit", "gears.yaml", "-o", "plain", "--quiet", "--set", "quality=null"});
  ASSERT_EQ(plain.exit_code, 0) << plain.errors;
  EXPECT_EQ(status("plain")["quality"], Json());
  EXPECT_THAT(with_fake({"resume", "plain", "--raise"}).errors,
              HasSubstr("has no section 'quality'"));
  EXPECT_EQ(with_fake({"resume", "c", "--raise", "--frame", "1"}).exit_code, 2);
}

TEST_F(PromiseTest, ACheckBesideAnotherSeedframeIsReportedAndNotKept) {
  submit();
  const int lock = ::open((folder_ / "c/campaign.lock").c_str(), O_RDWR);
  ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
  const Outcome outcome = with_fake({"verify-error", "c", "--quiet", "--json"});
  ::close(lock);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("the campaign does not keep what was measured: another "
                                        "seedframe is at work on c"));
  EXPECT_EQ(parse_json(outcome.output, "json")->at("recorded"), false);
  EXPECT_EQ(status("c")["quality"]["checked"], 0);
}

TEST_F(PromiseTest, ABoundOfTheCommandLineIsNotTheCampaigns) {
  submit();
  const Outcome strict = with_fake({"verify-error", "c", "--max-error", "1e-6", "--quiet"});
  EXPECT_EQ(strict.exit_code, 10);
  EXPECT_THAT(run({"status", "c"}).output, HasSubstr("within rmse8 of 25: promised; checked on 6"));
  EXPECT_EQ(status("c")["quality"]["kept"], true);
}

}  // namespace
}  // namespace seedframe
