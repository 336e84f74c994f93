// Exports as a user makes them: every format, interrupted, partial, verified, and read by decoders
// that know nothing of the exporter (tests/export/decoders).

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "store/job_store.h"
#include "tests/cli/program.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

// Overlapping objects of every kind, some beyond the image's edge; bolts have keypoints.
constexpr const char* kParts = R"(seedframe: 1
name: parts
scenes: 8
frames_per_scene: 3
categories: [gear, hex_bolt, never_seen, washer]
render: {width: 160, height: 120, samples: 1, passes: [depth]}
objects:
  gears: {asset: gear, count: 3, position: [{uniform: [-0.1, 0.1]}, {uniform: [-0.1, 0.1]}, 0]}
  bolts: {asset: hex_bolt, count: 4, rotation_deg: [{uniform: [0, 360]}, 0, {uniform: [0, 360]}],
          position: [{uniform: [-0.15, 0.15]}, {uniform: [-0.1, 0.1]}, 0.02]}
  washers: {asset: washer, count: 2, position: [{uniform: [-0.1, 0.1]}, 0, 0.03]}
  stones: {asset: cube, category: none, count: 2, scale: 0.3,
           position: [{uniform: [-0.1, 0.1]}, {uniform: [-0.1, 0.1]}, 0.05]}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.3, 0.5]}}
)";
// Without those that need an image.
const std::vector<std::string> kFormats = {"coco",          "coco-polygon", "coco-keypoints",
                                           "coco-panoptic", "yolo-detect",  "yolo-segment",
                                           "yolo-obb",      "yolo-pose",    "voc",
                                           "bop",           "webdataset",   "statistics"};

class ExportTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("parts.yaml", kParts);
    ASSERT_EQ(
        run({"submit", "parts.yaml", "-o", "c", "--set", "labels=geometry", "--quiet"}).exit_code,
        0);
  }
  static std::vector<std::string> export_all(const std::string& output,
                                             std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"export", "c", "-o", output};
    for (const std::string& format : kFormats) {
      arguments.emplace_back("--format");
      arguments.push_back(format);
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  Outcome decoders(const std::string& output, const std::string& more = {}) const {
    return python("decoders/agreement.py " + (folder_ / "c").string() + " " +
                  (folder_ / output).string() + " " + more);
  }
};

TEST_F(ExportTest, IndependentDecodersFindWhatWasTraced) {
  const Outcome outcome = run(export_all("out", {"--split", "train=0.6,val=0.2,test=0.2"}));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const Outcome found = decoders("out");
  EXPECT_EQ(found.exit_code, 0) << found.output << found.errors;
  for (const std::string& format : kFormats) EXPECT_THAT(found.output, HasSubstr(format + ": "));
}

TEST_F(ExportTest, ThePagesTellHowToLoadIt) {
  ASSERT_EQ(run(export_all("out")).exit_code, 0);
  const Outcome read = python("run_pages.py " + (folder_ / "out").string());
  EXPECT_EQ(read.exit_code, 0) << read.output;
  for (const char* page : {"coco.md", "yolo.md", "voc.md", "bop.md", "webdataset.md"}) {
    EXPECT_THAT(read.output, HasSubstr(page));
  }
}

TEST(ExportDecoders, KnowTheirFormats) {
  const std::string folder = std::string(SEEDFRAME_HOME) + "/tests/export/decoders";
  const std::string command =
      "cd " + folder + " && PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -m unittest -q";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(ExportTest, IndependentDecodersAgreeWithTheFilters) {
  const std::vector<std::string> filters = {"--min-pixels", "40", "--min-visible", "0.4"};
  ASSERT_EQ(run(export_all("out", filters)).exit_code, 0);
  const Outcome found = decoders("out", "--min-pixels 40 --min-visible 0.4");
  EXPECT_EQ(found.exit_code, 0) << found.output << found.errors;
}

TEST_F(ExportTest, IndependentDecodersFindWholeSilhouettes) {
  const Outcome outcome = run(export_all("out", {"--amodal"}));
  EXPECT_EQ(outcome.exit_code, 3);  // what is possible is written
  for (const char* format : {"coco-panoptic", "voc"}) {
    EXPECT_THAT(outcome.errors, HasSubstr(std::string(format) + " was not written: "));
    EXPECT_FALSE(exists(std::string("out/") + format));
  }
  EXPECT_THAT(outcome.errors, HasSubstr("silhouettes overlap"));
  EXPECT_TRUE(exists("out/bop"));
  const Outcome found = decoders("out", "--amodal");
  EXPECT_EQ(found.exit_code, 0) << found.output << found.errors;
}

TEST_F(ExportTest, VerifyComparesWhatIsThere) {
  ASSERT_EQ(run(export_all("out")).exit_code, 0);
  Outcome verified = run({"export", "c", "--verify", "-o", "out"});
  EXPECT_EQ(verified.exit_code, 0) << verified.errors;
  for (const std::string& format : kFormats) {
    EXPECT_THAT(verified.output, HasSubstr(format + ": 24 frames"));
  }
  EXPECT_THAT(verified.output, Not(HasSubstr("differences")));
  const std::string path = "out/yolo-detect/labels/train/000004.txt";
  std::string rows = *read_file(folder_ / path);
  rows[4] = rows[4] == '1' ? '2' : '1';
  write(path, rows);
  verified = run({"export", "c", "--verify", "-o", "out"});
  EXPECT_EQ(verified.exit_code, 5);
  EXPECT_THAT(verified.errors, HasSubstr("yolo-detect: frame 4: "));
  EXPECT_EQ(run({"export", "c", "--verify", "-o", "out", "--format", "coco"}).exit_code, 0);
  write("out/coco/annotations/notes.txt", "mine");
  verified = run({"export", "c", "--verify", "-o", "out", "--format", "coco"});
  EXPECT_EQ(verified.exit_code, 5);
  EXPECT_THAT(verified.errors, HasSubstr("coco: annotations/notes.txt belongs to no frame"));
  EXPECT_THAT(run({"export", "c", "--verify", "-o", "nowhere"}).errors,
              HasSubstr("holds no export of Seedframe"));
}

TEST_F(ExportTest, FramesThatAreGoneAreAllNamed) {
  fs::remove_all(folder_ / "c/frames/000/000007");
  fs::remove(folder_ / "c/frames/000/000011/labels.json");
  const Outcome outcome = run({"export", "c", "-o", "out", "--format", "coco", "--partial"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.errors, HasSubstr("frame 7: "));
  EXPECT_THAT(outcome.errors, HasSubstr("frame 11: "));
  EXPECT_THAT(outcome.errors, HasSubstr("resume"));
  EXPECT_FALSE(exists("out/coco"));
}

TEST_F(ExportTest, AnIncompleteCampaignIsExportedOnRequestOnly) {
  {
    auto store = JobStore::open(folder_ / "c/campaign.sqlite");
    ASSERT_TRUE(store);
    ASSERT_TRUE(store->reset(7));
    ASSERT_TRUE(store->reset(11));
  }
  const Outcome refused = run({"export", "c", "-o", "out", "--format", "coco"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("2 frames are not done"));
  EXPECT_FALSE(exists("out/coco"));
  const Outcome partial = run({"export", "c", "-o", "out", "--format", "coco", "--partial"});
  EXPECT_EQ(partial.exit_code, 0) << partial.errors;
  EXPECT_THAT(partial.output, HasSubstr("train 22 images"));
  EXPECT_THAT(partial.errors, HasSubstr("2 frames are missing"));
}

TEST_F(ExportTest, AddedScenesAddToTheExport) {
  ASSERT_EQ(run(export_all("out", {"--split", "train=0.8,val=0.2"})).exit_code, 0);
  ASSERT_EQ(run({"submit", "parts.yaml", "-o", "more", "--set", "labels=geometry", "--set",
                 "scenes=10", "--quiet"})
                .exit_code,
            0);
  fs::rename(folder_ / "c", folder_ / "before");
  fs::rename(folder_ / "more", folder_ / "c");
  const Outcome again = run(export_all("out", {"--split", "train=0.8,val=0.2"}));
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_THAT(again.output, HasSubstr("24 of 30 frames are unchanged"));
  EXPECT_EQ(run(export_all("fresh", {"--split", "train=0.8,val=0.2"})).exit_code, 0);
  EXPECT_EQ(contents("out"), contents("fresh"));
}

TEST_F(ExportTest, AClassThatTheCampaignLostIsNamed) {
  Json inputs = *parse_json(*read_file(folder_ / "c/inputs/inputs.json"), "inputs.json");
  auto& classes = inputs.at("categories");
  classes.erase(std::find(classes.begin(), classes.end(), "never_seen"));
  write("c/inputs/inputs.json", readable_json(inputs));
  const Outcome outcome = run({"export", "c", "-o", "out", "--format", "voc"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.errors, HasSubstr("class 'never_seen'"));
  EXPECT_FALSE(exists("out/voc"));
}

TEST_F(ExportTest, ScaledInstancesHaveNoRigidPose) {
  ASSERT_EQ(run({"submit", "parts.yaml", "-o", "scaled", "--set", "labels=geometry", "--set",
                 "objects.gears.scale=1.5", "--quiet"})
                .exit_code,
            0);
  const Outcome outcome = run({"export", "scaled", "-o", "out", "--format", "bop"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("'gears/0') is scaled by 1.5, 1.5, 1.5"));
  const Outcome others =
      run({"export", "scaled", "-o", "out", "--format", "bop", "--format", "coco"});
  EXPECT_EQ(others.exit_code, 3);
  EXPECT_THAT(others.output, HasSubstr("24 images"));
  EXPECT_THAT(others.errors, HasSubstr("bop was not written: frame "));
  EXPECT_FALSE(exists("out/bop"));
  EXPECT_TRUE(exists("out/coco"));
}

// Killed at any moment, an export leaves the old one or the new one, whole.
TEST_F(ExportTest, AKilledExportLeavesTheOldOneOrTheNew) {
  const std::vector<std::vector<std::string>> options = {{}, {"--min-pixels", "50"}};
  const auto by_format = [&](const std::string& output) {
    std::vector<std::map<std::string, std::string>> files;
    for (const std::string& format : kFormats) files.push_back(contents(output + "/" + format));
    return files;
  };
  ASSERT_EQ(run(export_all("some", options[0])).exit_code, 0);
  ASSERT_EQ(run(export_all("fewer", options[1])).exit_code, 0);
  const auto some = by_format("some");
  const auto fewer = by_format("fewer");
  ASSERT_EQ(run(export_all("out", options[0])).exit_code, 0);
  std::mt19937_64 random(7);
  int killed = 0;
  for (std::size_t round = 1; round <= 60; ++round) {
    const pid_t child = start(export_all("out", options[round % 2]));
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 400));
    ::kill(child, SIGKILL);
    killed += wait(child).exit_code == 128 + SIGKILL;
    const auto found = by_format("out");
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_TRUE(found[i] == some[i] || found[i] == fewer[i])
          << kFormats[i] << " after round " << round;
    }
  }
  EXPECT_GE(killed, 20);
  ASSERT_EQ(run(export_all("out", options[1])).exit_code, 0);
  EXPECT_EQ(by_format("out"), fewer);
  for (const auto& entry : fs::directory_iterator(folder_ / "out")) {
    EXPECT_NE(entry.path().filename().string().front(), '.') << "left over: " << entry.path();
  }
}

}  // namespace
}  // namespace seedframe
