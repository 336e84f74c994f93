// Campaigns and their twins: labels without Blender, and frames that are not what they should be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kTwins = R"(seedframe: 1
name: twins
scenes: 3
frames_per_scene: 2
categories: [gear, hex_bolt]
render: {width: 64, height: 48, samples: 1, passes: [depth, normal]}
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
  bolts: {asset: hex_bolt, position: [0, 0.05, {uniform: [-0.02, 0.02]}]}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.2, 0.5]}}
)";

class TwinCampaign : public ProgramTest {
 protected:
  void SetUp() override { write_config("twins.yaml", kTwins); }
  Outcome label(const std::string& folder, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"submit", "twins.yaml",      "-o",        folder,
                                          "--set",  "labels=geometry", "--blender", "/no/blender"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(TwinCampaign, LabelsByGeometryNeedNoBlender) {
  const Outcome outcome = label("c");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("without Blender"));
  EXPECT_THAT(outcome.output, HasSubstr("6 of 6 frames are done"));
  for (const char* file : {"instances.png", "semantic.png", "labels.json", "manifest.json",
                           "frame.json", "depth.exr", "normal.exr"}) {
    EXPECT_TRUE(exists(std::string("c/frames/000/000005/") + file)) << file;
  }
  EXPECT_FALSE(exists("c/frames/000/000005/image.png"));
  EXPECT_FALSE(exists("c/work"));
  EXPECT_EQ(status("c").at("done"), 6);
}

TEST_F(TwinCampaign, LabelsByGeometryAreTheSameWhateverTheThreads) {
  label("one", {"--workers", "1"});
  label("two", {"--workers", "2", "--threads", "3"});
  EXPECT_EQ(contents("one/frames"), contents("two/frames"));
  EXPECT_EQ(status("one").at("dataset_hash"), status("two").at("dataset_hash"));
}

TEST_F(TwinCampaign, LabelsByGeometryAreResumedLikeAnyOther) {
  EXPECT_EQ(label("c", {"--frames", "2"}).exit_code, 0);
  EXPECT_EQ(status("c").at("done"), 2);
  const Outcome resumed = run({"resume", "c"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_THAT(resumed.output, HasSubstr("6 of 6 frames are done (4 in this run"));
  label("whole");
  EXPECT_EQ(status("c").at("dataset_hash"), status("whole").at("dataset_hash"));
  EXPECT_THAT(run({"resume", "c"}).output, HasSubstr("0 in this run"));
}

TEST_F(TwinCampaign, LabelsByGeometryAreExportedWithoutImages) {
  label("c");
  const Outcome outcome =
      run({"export", "c", "--format", "coco", "--format", "yolo-segment", "-o", "x"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("no images were written"));
  const auto files = contents("x");
  EXPECT_TRUE(files.contains("coco/annotations/instances_train.json"));
  EXPECT_TRUE(files.contains("yolo-segment/labels/train/000005.txt"));
  EXPECT_FALSE(files.contains("coco/images/train/000005.png"));
}

TEST_F(TwinCampaign, AnOpacityTextureIsNotForTheTwin) {
  std::filesystem::create_directories(folder_ / "m/Leaf");
  const auto png = read_file(SEEDFRAME_HOME "/tests/twin/data/opacity.png");
  ASSERT_TRUE(png);
  write("m/Leaf/Leaf_Color.png", *png);
  write("m/Leaf/Leaf_Opacity.png", *png);
  write("leaf.yaml", R"(seedframe: 1
categories: [gear]
material_folders: [m]
objects: {gears: {asset: gear, material: Leaf}}
camera: {distance_m: 0.4}
labels: geometry
)");
  const Outcome outcome = run({"check", "leaf.yaml"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("leaf.yaml:6"));
  EXPECT_THAT(outcome.errors, HasSubstr("opacity texture"));
}

TEST_F(TwinCampaign, AFrameThatIsNotAsItsTwinSeesItFailsAndIsKept) {
  // The fake Blender draws rectangles where gears should be.
  const Outcome outcome = run({"submit", "twins.yaml", "-o", "c", "--blender", kFakeBlender,
                               "--max-attempts", "2", "--frames", "1"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("not what the twin sees"));
  EXPECT_THAT(outcome.errors, HasSubstr("c/rejected/000000"));
  EXPECT_FALSE(exists("c/frames/000/000000"));
  for (const char* file : {"rendered.exr", "instances.png", "twin.png", "difference.png",
                           "frame.json", "reason.txt"}) {
    EXPECT_TRUE(exists(std::string("c/rejected/000000/") + file)) << file;
  }
  const Json told = status("c");
  EXPECT_EQ(told.at("failed"), 1);
  EXPECT_THAT(told.at("recent_failures").dump(), HasSubstr("twin"));
}

TEST_F(TwinCampaign, TheCheckCanBeTurnedOff) {
  const Outcome outcome = run({"submit", "twins.yaml", "-o", "c", "--blender", kFakeBlender,
                               "--set", "labels.check=false"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(status("c").at("twin").at("frames"), 0);
  EXPECT_EQ(run({"export", "c", "--format", "coco"}).exit_code, 0)
      << "labels can be read though twin and picture differ";
}

TEST_F(TwinCampaign, MistakesInTheLabelSectionAreNamed) {
  const auto error_of = [&](const std::string& change) {
    return run({"check", "twins.yaml", "--set", change}).errors;
  };
  EXPECT_THAT(error_of("labels=blender"), HasSubstr("'render' or 'geometry'"));
  EXPECT_THAT(error_of("labels.tolerance=2"), HasSubstr("a share from 0 to 1, found 2"));
  EXPECT_THAT(error_of("labels.tolerence=0"), HasSubstr("tolerance"));
  EXPECT_THAT(error_of("labels.check=maybe"), HasSubstr("labels.check"));
}

}  // namespace
}  // namespace seedframe
