// What a stream renders and keeps, by the real Blender: to the last bit what submit makes.

#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/cli/stream_program.h"
#include "tests/fixtures/real_blender.h"

namespace seedframe {
namespace {

constexpr const char* kKeepConfig = R"(seedframe: 1
name: line
seed: 5
scenes: 3
categories: [gear, hex_bolt]
render: {width: 97, height: 71, samples: 3, passes: [depth], max_bounces: 3}
variables: {scene: {turn: {uniform: [0deg, 90deg]}}}
objects:
  gears: {asset: gear, count: 2, rotation_deg: [0, 0, turn], scatter: {x: [-0.09, 0.09], y: [-0.09, 0.09]}, material: brass}
  bolt: {asset: hex_bolt, position: [0.02, 0.03, 0.02], rotation_deg: [90, 0, 30], material: steel}
ground: {width_m: 2, depth_m: 2, material: Concrete01}
lights: {key: {type: area, position: [0.3, -0.4, 0.8], power: 8}}
camera: {target: [0.03, 0.02, 0], distance_m: {uniform: [0.4, 0.6]}, azimuth_deg: {uniform: [0, 360]}}
)";

class RealBlenderKeep : public ProgramTest {
 protected:
  Json manifest(const std::string& campaign, std::int64_t frame) const {
    return Json::parse(*read_file(folder_ / campaign / "frames/000" / fmt::format("{:06}", frame) /
                                  "manifest.json"));
  }
};

TEST_F(RealBlenderKeep, FramesAreThoseOfACampaignOfTheSameGraphs) {
  write("line.yaml", kKeepConfig);
  const std::vector<std::string> requests = {
      R"("values": {"turn": 10}, "scene": 3)", R"("scene": 1)", R"("scene": 1, "samples": 7)",
      R"("scene": 2, "crop": [20, 10, 40, 30])", R"("scene": 1, "denoise": true)"};
  Stream stream(folder_, {"--keep", "k", "--blender", test_blender(), "--workers", "2"});
  ASSERT_FALSE(stream.hear().is_null());
  for (std::size_t i = 0; i < requests.size(); ++i) {
    stream.say(R"({"fidelity": "render", "id": )" + std::to_string(i) + ", " + requests[i] + "}");
  }
  std::map<std::int64_t, Json> kept;
  std::map<int, std::string> hashes;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const Json answer = stream.hear();
    const int id = answer["id"].get<int>();
    if (answer.contains("error")) {  // a Blender without a denoiser
      EXPECT_EQ(id, 4) << answer;
      continue;
    }
    kept[answer["kept"].get<std::int64_t>()] = answer;
    hashes[id] = answer["pixel_hashes"]["image"].get<std::string>();
  }
  stream.close_input();
  ASSERT_EQ(stream.wait(), 0);
  ASSERT_GE(kept.size(), 4U);
  EXPECT_NE(hashes[1], hashes[2]) << "more samples are another picture";
  if (hashes.contains(4)) {
    EXPECT_NE(hashes[1], hashes[4]) << "so is a denoised one";
  }

  const Outcome submitted = run({"submit", "line.yaml", "--set", "graphs=k/graphs.jsonl", "-o", "s",
                                 "--blender", test_blender(), "--quiet"});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.errors;
  for (const auto& [number, answer] : kept) {
    EXPECT_EQ(manifest("s", number), manifest("k", number));
    EXPECT_EQ(answer["pixel_hashes"], manifest("s", number)["pixels"]);
  }
  for (const std::vector<std::string>& verb : std::vector<std::vector<std::string>>{
           {"audit", "k", "--blender", test_blender(), "--frames", "2"},
           {"export", "k", "--format", "coco"},
           {"export", "k", "--format", "yolo-segment"},
           {"compare", "k", "s"},
           {"resume", "k", "--blender", test_blender()}}) {
    const Outcome outcome = run(verb);
    EXPECT_EQ(outcome.exit_code, 0) << verb.front() << outcome.output << outcome.errors;
  }
}

}  // namespace
}  // namespace seedframe
