// The whole program with a fake Blender that misbehaves: nothing wrong is ever committed, and the
// campaign goes on.

#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kFaults = R"(seedframe: 1
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
    // The fake draws rectangles: no twin would agree.
    write_config("faults.yaml", std::string(kFaults) + "labels: {check: false}\n");
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
  for (const char* fault : {"crash", "exit", "hang", "freeze", "ignore_term", "garbage",
                            "wrong_frame", "wrong_attempt", "fail", "no_file", "other_frame",
                            "half_exr", "nan", "wrong_size", "wrong_id", "fractional_id"}) {
    std::filesystem::remove_all(folder_ / "c");
    const Outcome outcome = submit("{\"" + std::string(fault) + "_frames\": [1, 7]}",
                                   {"--frame-timeout", "1.5", "--heartbeat-timeout", "1.2"});
    EXPECT_EQ(outcome.exit_code, 0) << fault << ": " << outcome.errors;
    EXPECT_THAT(outcome.errors,
                testing::ContainsRegex("frame 7, attempt 1 (failed|cost a worker), trying again"))
        << fault;
    EXPECT_EQ(status("c").at("dataset_hash"), expected) << fault;
  }
}

TEST_F(FaultsTest, AFrameThatAlwaysFailsIsNamedAndTheOthersAreDone) {
  const Outcome outcome = submit(R"({"fail_frames": [4], "fail_attempts": 99})");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("frame 4, attempt 3 failed for good"));
  const Json state = status("c");
  EXPECT_EQ(state.at("done"), kFrames - 1);
  EXPECT_EQ(state.at("failed"), 1);
  EXPECT_EQ(state.at("dataset_hash"), "");
  EXPECT_EQ(state.at("recent_failures").at(0).at("message"), "fake: will not render");
  EXPECT_FALSE(exists("c/frames/000/000004"));

  EXPECT_EQ(run({"export", "c", "--format", "coco"}).exit_code, 2) << "incomplete";
  EXPECT_EQ(run({"export", "c", "--format", "coco", "--partial"}).exit_code, 0);

  EXPECT_EQ(resume().exit_code, 0) << "the fault is gone, and a resume tries again";
  EXPECT_EQ(status("c").at("dataset_hash"), undisturbed_hash());
}

TEST_F(FaultsTest, AFrameThatCostsThreeWorkersIsQuarantinedWithItsLogAndCommand) {
  const Outcome outcome = submit(R"({"crash_frames": [4], "crash_attempts": 99})");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("frame 4, attempt 3 cost a worker and is quarantined"));
  EXPECT_THAT(outcome.output, HasSubstr("1 frames are quarantined"));
  const Json state = status("c");
  EXPECT_EQ(state.at("done"), kFrames - 1);
  EXPECT_EQ(state.at("quarantined"), 1);
  EXPECT_EQ(state.at("quarantined_frames").at(0).at("frame"), 4);
  const auto log = read_file(folder_ / "c/logs/crash-000004-3.log");
  ASSERT_TRUE(log);
  EXPECT_THAT(*log, HasSubstr("frame 4 is too much"));
  EXPECT_THAT(*log, HasSubstr("seedframe resume c --frame 4 --workers 1"));
  EXPECT_THAT(run({"status", "c"}).output, HasSubstr("seedframe resume c --frame 4 --workers 1"));

  EXPECT_EQ(resume().exit_code, 3) << "a quarantined frame is left alone";
  EXPECT_EQ(status("c").at("quarantined"), 1);
  EXPECT_EQ(resume({"--frame", "4"}).exit_code, 0) << "unless it is asked for";
  EXPECT_EQ(status("c").at("dataset_hash"), undisturbed_hash());
}

TEST_F(FaultsTest, CrashesAreCountedOverAllRuns) {
  const std::string crashing = R"({"crash_frames": [4], "crash_attempts": 99})";
  EXPECT_EQ(submit(crashing, {"--max-crashes", "1"}).exit_code, 3);
  EXPECT_EQ(status("c").at("quarantined"), 1);
  EXPECT_EQ(resume({"--frame", "4", "--max-crashes", "2"}, crashing).exit_code, 3);
  EXPECT_EQ(status("c").at("quarantined_frames").at(0).at("crashes"), 2)
      << "asked for, it began anew";
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

  // One flipped bit keeps the size, but not the time of modification.
  std::string image = *read_file(folder_ / "c/frames/000/000001/image.png");
  image[image.size() / 2] = static_cast<char>(image[image.size() / 2] ^ 1);
  write("c/frames/000/000001/image.png", image);
  EXPECT_THAT(resume().output, HasSubstr("1 in this run"));
  EXPECT_EQ(status("c").at("dataset_hash"), hash);

  // A failing disk changes no time: --verify reads the contents, and so does export.
  const auto time = std::filesystem::last_write_time(folder_ / "c/frames/000/000001/image.png");
  write("c/frames/000/000001/image.png", image);
  std::filesystem::last_write_time(folder_ / "c/frames/000/000001/image.png", time);
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
  change_store("c", "UPDATE frames SET state = 'running', pixel_hash = '' WHERE frame IN (3, 6)");
  const Outcome outcome = resume();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("2 frames were complete on disk already"));
  EXPECT_THAT(outcome.output, HasSubstr("0 in this run"));
  EXPECT_EQ(status("c").at("dataset_hash"), hash);
}

TEST_F(FaultsTest, OneFrameCanBeRenderedAgain) {
  ASSERT_EQ(submit("{}", {"--threads", "1"}).exit_code, 0);
  const std::string provenance = *read_file(folder_ / "c/provenance.json");
  EXPECT_THAT(provenance, HasSubstr("\"gear\""));
  const auto before = contents("c/frames/000/000006");
  const Outcome outcome = resume({"--frame", "6", "--threads", "1"});
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
  Json provenances[2] = {*parse_json(*read_file(folder_ / "c/provenance.json"), "c"),
                         *parse_json(*read_file(folder_ / "one/provenance.json"), "one")};
  for (Json& provenance : provenances) {
    ASSERT_EQ(provenance.at("attempts").size(), 1u) << "one kind of worker, whatever their number";
    provenance.at("attempts").at(0).erase("threads");
  }
  EXPECT_EQ(provenances[0], provenances[1]);
}

TEST_F(FaultsTest, WhatAFrameWasMadeWithIsToldAndAChangeOfItToo) {
  ASSERT_EQ(submit(R"({"fail_frames": [4], "fail_attempts": 99})").exit_code, 3);
  const Outcome explained = run({"explain", "c", "0", "--json"});
  const Json made_with = Json::parse(explained.output).at("attempts").at(0).at("provenance");
  EXPECT_EQ(made_with.at("kernel"), "avx2");
  EXPECT_EQ(made_with.at("scripts_sha256").get<std::string>().size(), 64u);
  EXPECT_THAT(run({"status", "c"}).output, Not(HasSubstr("made with")));

  const Outcome resumed =
      run({"resume", "c", "--blender", kFakeBlender}, {R"(SEEDFRAME_FAKE={"kernel": "avx"})"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_THAT(resumed.errors, HasSubstr("this run renders with kernel avx instead of avx2"));
  EXPECT_THAT(run({"status", "c"}).output,
              HasSubstr("some attempts were made with kernel avx instead of avx2"));
}

TEST_F(FaultsTest, AWorkerThatCannotKeepThePinEndsTheRunAndChargesNoFrame) {
  const Outcome outcome = run({"submit", "faults.yaml", "-o", "c", "--blender", kFakeBlender,
                               "--set", "determinism={mode: portable, isa: avx}"},
                              {R"(SEEDFRAME_FAKE={"kernel": "avx2"})"});
  EXPECT_EQ(outcome.exit_code, 4) << outcome.errors;
  EXPECT_THAT(outcome.errors,
              HasSubstr("Cycles was to use its kernel avx, and on this machine it uses avx2"));
  EXPECT_EQ(status("c").at("pending"), kFrames);
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

TEST_F(FaultsTest, ACopiedCampaignIsReadOnceAndKept) {
  ASSERT_EQ(submit("{}").exit_code, 0);
  const std::string hash = status("c").at("dataset_hash");
  std::filesystem::copy(folder_ / "c", folder_ / "copy", std::filesystem::copy_options::recursive);
  std::filesystem::rename(folder_ / "copy", folder_ / "c2");
  const Outcome outcome = run({"resume", "c2", "--blender", kFakeBlender});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("0 in this run"));
  EXPECT_EQ(status("c2").at("dataset_hash"), hash);
}

TEST_F(FaultsTest, AChangedConfigIsAnotherDatasetAndMadeAnew) {
  submit("{}", {"--frames", "3"});
  std::string text = *read_file(folder_ / "c/campaign.yaml");
  write("c/campaign.yaml", text.replace(text.find("0.5]"), 4, "0.6]"));
  const Outcome asked = resume();
  EXPECT_EQ(asked.exit_code, 2);
  EXPECT_THAT(asked.errors,
              HasSubstr("3 finished frames would be replaced: 'seedframe resume c --yes'"));
  EXPECT_THAT(asked.errors, HasSubstr("  campaign.yaml\n"));
  EXPECT_EQ(status("c").at("done"), 3) << "nothing was changed";
  const Outcome outcome = resume({"--yes"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("12 frames have become different"));
  EXPECT_THAT(outcome.errors, HasSubstr("  campaign.yaml\n"));
  EXPECT_THAT(outcome.output, HasSubstr("12 in this run"));
  write("faults.yaml", text);
  EXPECT_EQ(status("c").at("dataset_hash"), undisturbed_hash());
}

TEST_F(FaultsTest, AChangedAssetCostsExactlyTheFramesThatShowIt) {
  std::filesystem::create_directories(folder_ / "parts");
  std::filesystem::copy(SEEDFRAME_HOME "/assets/gear", folder_ / "parts/gear",
                        std::filesystem::copy_options::recursive);
  std::string text = *read_file(folder_ / "faults.yaml");
  text.replace(text.find("[1, 3]"), 6, "[0, 1]");
  write("faults.yaml", text + "asset_folders: [parts]\n");
  ASSERT_EQ(submit("{}").exit_code, 0);
  int with_gear = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto spec = read_file(folder_ / fmt::format("c/frames/000/{:06}/frame.json", frame));
    with_gear += spec->find("\"gear\"") != std::string::npos ? 1 : 0;
  }
  ASSERT_GT(with_gear, 0);
  ASSERT_LT(with_gear, kFrames);
  const std::string before = status("c").at("dataset_hash");

  EXPECT_THAT(run({"status", "c"}).output, Not(HasSubstr("changed or gone")));
  ASSERT_EQ(run({"asset", "keypoints", "gear", "hub=0,0,0", "--root", "parts"}).exit_code, 0);
  EXPECT_THAT(run({"status", "c"}).output, HasSubstr("parts/gear/asset.json has changed or gone"));
  const Outcome outcome = resume({"--yes"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr(fmt::format("({} in this run", with_gear)));
  EXPECT_THAT(outcome.errors, HasSubstr("parts/gear/asset.json"));
  EXPECT_NE(status("c").at("dataset_hash"), before);
  EXPECT_EQ(status("c").at("dataset_hash"), undisturbed_hash());
  EXPECT_THAT(resume().output, HasSubstr("0 in this run"));
}

TEST_F(FaultsTest, ASubmissionThatWasKilledLeavesNothingInTheWay) {
  const std::string expected = undisturbed_hash();
  std::filesystem::create_directories(folder_ / "c/frames");
  write("c/campaign.lock", "");
  write("c/campaign.yaml", "half a conf");
  write("c/campaign.sqlite.new", "half a store");
  EXPECT_EQ(submit("{}").exit_code, 0);
  EXPECT_EQ(status("c").at("dataset_hash"), expected);
  EXPECT_FALSE(exists("c/campaign.sqlite.new"));

  std::filesystem::create_directories(folder_ / "mine");
  write("mine/campaign.yaml", "the user's own");
  const Outcome refused = run({"submit", "faults.yaml", "-o", "mine", "--blender", kFakeBlender});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("mine is not empty"));
  EXPECT_EQ(*read_file(folder_ / "mine/campaign.yaml"), "the user's own");
}

TEST_F(FaultsTest, ACampaignThatWillNotFitIsNotStarted) {
  const Outcome large =
      run({"submit", "faults.yaml", "-o", "large", "--blender", kFakeBlender, "--set",
           "render.width=16384", "--set", "render.height=16384", "--set", "scenes=300"});
  EXPECT_EQ(large.exit_code, 4) << large.errors;
  EXPECT_THAT(large.errors, HasSubstr("--no-space-check"));
}

}  // namespace
}  // namespace seedframe
