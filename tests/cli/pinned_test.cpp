// Datasets that are what they have always been: the values stand for every byte. Who changes one on
// purpose raises the version of the format that changed, and says so.

#include <gtest/gtest.h>

#include "base/sha256.h"
#include "tests/cli/program.h"

namespace seedframe {
namespace {

class PinnedDataset : public ProgramTest {
 protected:
  std::string hash_of(const std::string& folder) const {
    std::string lines;
    for (const auto& [path, bytes] : contents(folder)) {
      lines += path + " " + sha256_hex(bytes) + "\n";
    }
    return sha256_hex(lines);
  }
  void label(const std::string& config) {
    const Outcome outcome =
        run({"submit", std::string(SEEDFRAME_HOME) + "/configs/" + config, "-o", "c", "--set",
             "labels=geometry", "--set", "render.passes=[depth, normal]", "--frames", "3"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  }
  std::string dataset_hash() { return status("c").at("dataset_hash").get<std::string>(); }
};

TEST_F(PinnedDataset, LabelsOfTheParts) {
  label("parts.yaml");
  EXPECT_EQ(hash_of("c/frames"),
            "cf9f0d690ff05069843b37a7ae8b8b714ea88c7c21d7d337cfc4219ba635661d");
}

TEST_F(PinnedDataset, LabelsOfTheRobocupScene) {
  label("robocup_spl.yaml");
  EXPECT_EQ(hash_of("c/frames"),
            "afa8865ae7f8a74b059b37d12492a5efe770b37459ffaa1f9bd0ced7764f8d07");
}

TEST_F(PinnedDataset, LabelsOfTheTyolScene) {
  label("tyol_multi_8_target.yaml");
  EXPECT_EQ(hash_of("c/frames"),
            "3b64b4417a809a509679b2eb26e670244d5935a6dd4d8d934529944a2a7231f0");
}

TEST_F(PinnedDataset, ExportsInAllFormats) {
  write("pinned.yaml", R"(seedframe: 1
name: pinned
seed: 11
scenes: 4
frames_per_scene: 2
categories: [gear, hex_bolt]
render: {width: 96, height: 64, samples: 1, passes: [depth, normal]}
labels: {check: false}
image: {ocio_config: )" + kOcioConfig +
                           R"(}
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
  bolts: {asset: hex_bolt, position: [0, 0.05, {uniform: [-0.02, 0.02]}]}
lights: {sun: {type: sun, power: {uniform: [1, 3]}}}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.2, 0.5]}}
)");
  const Outcome made = run({"submit", "pinned.yaml", "-o", "c", "--blender", kFakeBlender});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_EQ(dataset_hash(), "f68c33477f330be584855c0d55b929778de70941c66270a31408327c120e506e");
  EXPECT_EQ(hash_of("c/frames"),
            "989e59b2970ff014a832cbe1a4b4f813f6c9c57f3bec6a6866f54f78b75ee7fc");
  std::vector<std::string> arguments = {"export", "c", "--split", "train=0.5,val=0.5"};
  for (const char* format : {"coco", "coco-polygon", "coco-panoptic", "yolo-detect", "yolo-segment",
                             "yolo-obb", "voc", "bop", "patches", "webdataset", "statistics"}) {
    arguments.insert(arguments.end(), {"--format", format});
  }
  const Outcome exported = run(arguments);
  ASSERT_EQ(exported.exit_code, 0) << exported.errors;
  EXPECT_EQ(hash_of("c/exports"),
            "d082cb092cdddbc352287ef6ac3acf85cd2ab06bd5a3e1579d260a51ff960f8d");
}

}  // namespace
}  // namespace seedframe
