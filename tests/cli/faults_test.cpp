// The whole program with a fake Blender that misbehaves: nothing wrong is ever committed, and the
// campaign goes on.

#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kConfig = R"(seedframe: 1
name: faults
scenes: 4
frames_per_scene: 3
categories: [gear]
render: {width: 32, height: 24, samples: 1, passes: [depth, normal]}
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
camera: {distance_m: {uniform: [0.2, 0.5]}}
)";
constexpr int kFrames = 12;

/// Dead processes that nobody has reaped do not count.
bool is_running(pid_t pid) {
  const auto stat = read_file("/proc/" + std::to_string(pid) + "/stat");
  return stat && stat->find(") Z") == std::string::npos;
}

class FaultsTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    // The fake draws rectangles: no twin would agree.
    write("faults.yaml",
          kConfig + ("labels: {check: false}\nimage: {ocio_config: " + kOcioConfig + "}\n"));
  }
  Outcome submit(const std::string& fake, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"submit",    "faults.yaml", "-o",        "c",
                                          "--workers", "2",           "--blender", kFakeBlender};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, {"SEEDFRAME_FAKE=" + fake});
  }
  Outcome resume(std::vector<std::string> more = {}, const std::string& fake = "{}") {
    std::vector<std::string> arguments = {"resume", "c", "--blender", kFakeBlender};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, {"SEEDFRAME_FAKE=" + fake});
  }
  /// The dataset hash of a campaign that nothing disturbed.
  std::string undisturbed_hash() {
    run({"submit", "faults.yaml", "-o", "undisturbed", "--blender", kFakeBlender});
    return status("undisturbed").at("dataset_hash").get<std::string>();
  }
};

TEST_F(FaultsTest, AGoodCampaignIsDoneAndResumesToNothing) {
  const Outcome outcome = submit(R"({"starts_log": "starts.txt"})");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("12 of 12 frames are done"));
  EXPECT_THAT(outcome.output, HasSubstr("dataset hash "));
  EXPECT_FALSE(exists("c/work"));
  for (const char* file :
       {"image.png", "instances.png", "semantic.png", "labels.json", "manifest.json", "frame.json",
        "passes.exr", "depth.exr", "normal.exr"}) {
    EXPECT_TRUE(exists(std::string("c/frames/000/000011/") + file)) << file;
  }
  const std::string starts = *read_file(folder_ / "starts.txt");
  EXPECT_EQ(std::count(starts.begin(), starts.end(), '\n'), 2) << "one Blender start per worker";

  const Outcome again = resume({}, R"({"starts_log": "again.txt"})");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.output, HasSubstr("0 in this run"));
  EXPECT_FALSE(exists("again.txt")) << "a complete campaign starts no Blender";
}

TEST_F(FaultsTest, EveryFaultIsRetriedAndTheDatasetIsThatOfAnUndisturbedRun) {
  const std::string expected = undisturbed_hash();
  for (const char* fault :
       {"crash", "exit", "hang", "garbage", "wrong_frame", "wrong_attempt", "fail", "no_file",
        "half_exr", "nan", "wrong_size", "wrong_id", "fractional_id"}) {
    std::filesystem::remove_all(folder_ / "c");
    const Outcome outcome =
        submit("{\"" + std::string(fault) + "_frames\": [1, 7]}", {"--frame-timeout", "1.5"});
    EXPECT_EQ(outcome.exit_code, 0) << fault << ": " << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr("frame 7, attempt 1 failed, trying again")) << fault;
    EXPECT_EQ(status("c").at("dataset_hash"), expected) << fault;
  }
}

TEST_F(FaultsTest, AFrameThatAlwaysFailsIsNamedAndTheOthersAreDone) {
  const Outcome outcome = submit(R"({"crash_frames": [4], "crash_attempts": 99})");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("frame 4, attempt 3 failed for good"));
  const Json state = status("c");
  EXPECT_EQ(state.at("done"), kFrames - 1);
  EXPECT_EQ(state.at("failed"), 1);
  EXPECT_EQ(state.at("dataset_hash"), "");
  EXPECT_THAT(state.at("recent_failures").at(0).at("message").get<std::string>(),
              HasSubstr("frame 4 is too much"))
      << "the end of the worker's log";
  EXPECT_FALSE(exists("c/frames/000/000004"));

  EXPECT_EQ(run({"export", "c", "--format", "coco"}).exit_code, 2) << "incomplete";
  EXPECT_EQ(run({"export", "c", "--format", "coco", "--partial"}).exit_code, 0);

  EXPECT_EQ(resume().exit_code, 0) << "the fault is gone, and a resume tries again";
  EXPECT_EQ(status("c").at("dataset_hash"), undisturbed_hash());
}

TEST_F(FaultsTest, ABlenderThatNeverStartsIsAnErrorOfTheEnvironment) {
  const Outcome outcome = submit(R"({"die_before_ready": true})");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.errors, HasSubstr("cannot open the display of the fake"));
  EXPECT_THAT(outcome.errors, HasSubstr("'seedframe resume c' goes on"));
  EXPECT_EQ(status("c").at("pending"), kFrames);
  EXPECT_EQ(resume().exit_code, 0);
}

TEST_F(FaultsTest, CtrlCDrainsAndResumeGoesOn) {
  const pid_t pid =
      start({"submit", "faults.yaml", "-o", "c", "--workers", "2", "--blender", kFakeBlender},
            {R"(SEEDFRAME_FAKE={"delay_s": 0.3})"});
  while (!exists("c/frames/000/000000")) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(pid, SIGINT);
  const Outcome outcome = wait(pid);
  EXPECT_EQ(outcome.exit_code, 130) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("'seedframe resume c' renders the rest"));
  const Json state = status("c");
  EXPECT_GT(state.at("done"), 0);
  EXPECT_GT(state.at("pending"), 0);
  EXPECT_EQ(state.at("running"), 0) << "frames under way were finished";
  EXPECT_EQ(resume().exit_code, 0);
  EXPECT_EQ(status("c").at("dataset_hash"), undisturbed_hash());
}

TEST_F(FaultsTest, SigkillLosesNothingAndLeavesNoWorker) {
  const std::string expected = undisturbed_hash();
  const pid_t pid =
      start({"submit", "faults.yaml", "-o", "c", "--workers", "2", "--blender", kFakeBlender},
            {R"(SEEDFRAME_FAKE={"delay_s": 0.05, "starts_log": "starts.txt"})"});
  while (!exists("c/frames/000/000003")) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  ::kill(pid, SIGKILL);
  EXPECT_EQ(wait(pid).exit_code, 128 + SIGKILL);
  std::ifstream starts(folder_ / "starts.txt");
  std::this_thread::sleep_for(std::chrono::seconds(1));
  for (pid_t worker = 0; starts >> worker;) {
    EXPECT_FALSE(is_running(worker)) << "worker " << worker << " outlived its scheduler";
  }
  EXPECT_EQ(resume().exit_code, 0);
  EXPECT_EQ(status("c").at("dataset_hash"), expected);
}

TEST_F(FaultsTest, DamagedFramesAreFoundAndRenderedAgain) {
  ASSERT_EQ(submit("{}").exit_code, 0);
  const std::string hash = status("c").at("dataset_hash");
  std::filesystem::remove(folder_ / "c/frames/000/000002/image.png");
  write("c/frames/000/000005/labels.json", "{}");
  std::filesystem::remove_all(folder_ / "c/frames/000/000008");
  const Outcome outcome = resume();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("3 in this run"));
  EXPECT_THAT(outcome.errors, HasSubstr("000002/image.png is missing"));
  EXPECT_EQ(status("c").at("dataset_hash"), hash);

  // One flipped bit keeps the size: --verify reads the contents, and so does export.
  std::string image = *read_file(folder_ / "c/frames/000/000001/image.png");
  image[image.size() / 2] = static_cast<char>(image[image.size() / 2] ^ 1);
  write("c/frames/000/000001/image.png", image);
  EXPECT_THAT(resume().output, HasSubstr("0 in this run"));
  const Outcome refused = run({"export", "c", "--format", "coco"});
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_THAT(refused.errors, HasSubstr("000001/image.png has changed"));
  EXPECT_THAT(resume({"--verify"}).output, HasSubstr("1 in this run"));
  EXPECT_EQ(status("c").at("dataset_hash"), hash);
}

TEST_F(FaultsTest, AFrameThatTheStoreDidNotSeeIsTakenOver) {
  ASSERT_EQ(submit("{}").exit_code, 0);
  const std::string hash = status("c").at("dataset_hash");
  // As a crash between the rename and the row leaves it: complete on disk, unknown to the store.
  ASSERT_EQ(std::system(("/usr/bin/python3 -c \"import sqlite3; c = sqlite3.connect('" +
                         (folder_ / "c/campaign.sqlite").string() +
                         "'); c.execute(\\\"update frames set state='running', pixel_hash='' "
                         "where frame in (3, 6)\\\"); c.commit()\"")
                            .c_str()),
            0);
  const Outcome outcome = resume();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("2 frames were complete on disk already"));
  EXPECT_THAT(outcome.output, HasSubstr("0 in this run"));
  EXPECT_EQ(status("c").at("dataset_hash"), hash);
}

TEST_F(FaultsTest, OneFrameCanBeRenderedAgain) {
  ASSERT_EQ(submit("{}").exit_code, 0);
  const std::string provenance = *read_file(folder_ / "c/provenance.json");
  EXPECT_THAT(provenance, HasSubstr("\"gear\""));
  const auto before = contents("c/frames/000/000006");
  const Outcome outcome = resume({"--frame", "6"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("1 in this run"));
  EXPECT_EQ(contents("c/frames/000/000006"), before);
  EXPECT_EQ(*read_file(folder_ / "c/provenance.json"), provenance);
  EXPECT_EQ(resume({"--frame", "12"}).exit_code, 2);
}

TEST_F(FaultsTest, WorkersAndOrderChangeNoByteOfTheDataset) {
  ASSERT_EQ(submit("{}").exit_code, 0);
  run({"submit", "faults.yaml", "-o", "one", "--workers", "1", "--blender", kFakeBlender});
  EXPECT_EQ(contents("c/frames"), contents("one/frames"));
  for (const char* campaign : {"c", "one"}) {
    const Outcome outcome =
        run({"export", campaign, "--format", "coco", "--format", "coco-polygon", "--format",
             "yolo-detect", "--format", "yolo-segment", "--split", "train=0.5,val=0.5"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  }
  EXPECT_EQ(contents("c/exports"), contents("one/exports"));
  EXPECT_EQ(*read_file(folder_ / "c/provenance.json"), *read_file(folder_ / "one/provenance.json"));
}

TEST_F(FaultsTest, OneSchedulerPerCampaign) {
  const pid_t pid = start({"submit", "faults.yaml", "-o", "c", "--blender", kFakeBlender},
                          {R"(SEEDFRAME_FAKE={"delay_s": 0.3})"});
  while (!exists("c/frames/000/000000")) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  // Its own redirections would overwrite those of the first; a copy of the folder path avoids that.
  const int code =
      std::system((std::string(SEEDFRAME_PROGRAM) + " resume " + (folder_ / "c").string() + " 2>" +
                   (folder_ / "second.txt").string())
                      .c_str());
  EXPECT_EQ(WEXITSTATUS(code), 2);
  EXPECT_THAT(*read_file(folder_ / "second.txt"), HasSubstr("another seedframe is at work"));
  EXPECT_EQ(wait(pid).exit_code, 0);
}

TEST_F(FaultsTest, AChangedConfigIsNotResumed) {
  submit("{}", {"--frames", "3"});
  std::string text = *read_file(folder_ / "c/campaign.yaml");
  write("c/campaign.yaml", text.replace(text.find("0.5]"), 4, "0.6]"));
  const Outcome outcome = resume();
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("would be another image"));
}

}  // namespace
}  // namespace seedframe
