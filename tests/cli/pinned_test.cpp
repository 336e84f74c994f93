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
            "3403b9d47bf10747c75595fed05e66c1fc37d65d27d38f7502bf77dc629883d0");
}

TEST_F(PinnedDataset, LabelsOfTheRobocupScene) {
  label("robocup_spl.yaml");
  EXPECT_EQ(hash_of("c/frames"),
            "37985ef3c6b33c997ade5e87b2ef090b2b2f35ee323d4e283953a678c5048f6a");
}

TEST_F(PinnedDataset, LabelsOfTheTyolScene) {
  label("tyol_multi_8_target.yaml");
  EXPECT_EQ(hash_of("c/frames"),
            "d1d9bc22c525277811b56d7af77f3dbe807f0d24e83784e193b9ebb510873e8e");
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
  EXPECT_EQ(dataset_hash(), "a180a8cc3e22ccdb8f9c34bf22bc5fa5dacebd60cacffbe071e477a397af98a0");
  EXPECT_EQ(hash_of("c/frames"),
            "bb188d0bd7a042f5ae3da1907d5c2a53feba6110a686e1a902de571198a7a0d5");
  std::vector<std::string> arguments = {"export", "c", "--split", "train=0.5,val=0.5"};
  for (const char* format : {"coco", "coco-polygon", "coco-panoptic", "yolo-detect", "yolo-segment",
                             "yolo-obb", "voc", "bop", "patches", "webdataset", "statistics"}) {
    arguments.insert(arguments.end(), {"--format", format});
  }
  const Outcome exported = run(arguments);
  ASSERT_EQ(exported.exit_code, 0) << exported.errors;
  EXPECT_EQ(hash_of("c/exports"),
            "6c4547e130b1480ce604d14eb0d8fa1e9034245b223d53ec6a865639bafa25ab");
}

}  // namespace
}  // namespace seedframe
