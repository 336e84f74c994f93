// Frames of which only a part is rendered: what is rendered is, to the last bit, what it would be
// in the whole image, and labels are the same. Patches, which have a resolution of their own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/pixel_rect.h"
#include "image/pass_reader.h"
#include "image/png_file.h"
#include "tests/cli/program.h"
#include "tests/fixtures/real_blender.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

constexpr const char* kRegionConfig = R"(seedframe: 1
name: region
seed: 5
scenes: 3
categories: [gear, hex_bolt]
render: {width: 97, height: 71, samples: 3, passes: [depth, normal], max_bounces: 3}
objects:
  gears: {asset: gear, count: 2, scatter: {x: [-0.09, 0.09], y: [-0.09, 0.09]}, material: brass}
  bolt: {asset: hex_bolt, position: [0.02, 0.03, 0.02], rotation_deg: [90, 0, 30], material: steel}
ground: {width_m: 2, depth_m: 2, material: Concrete01}
lights: {key: {type: area, position: [0.3, -0.4, 0.8], power: 8}}
camera: {target: [0.03, 0.02, 0], distance_m: {uniform: [0.4, 0.6]}, azimuth_deg: {uniform: [0, 360]}}
)";

class RealBlenderRegion : public ProgramTest {
 protected:
  void submit(const std::string& campaign, const std::vector<std::string>& settings) {
    std::vector<std::string> arguments = {"submit", "region.yaml", "-o",
                                          campaign, "--blender",   test_blender()};
    for (const std::string& each : settings) {
      arguments.emplace_back("--set");
      arguments.push_back(each);
    }
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  }
  void SetUp() override { write("region.yaml", kRegionConfig); }

  std::filesystem::path frame(const std::string& campaign, int index) const {
    return folder_ / campaign / "frames/000" / fmt::format("{:06}", index);
  }
  static FramePasses passes(const std::filesystem::path& frame, int width, int height) {
    const auto read = read_passes(frame / "passes.exr", {.width = width,
                                                         .height = height,
                                                         .depth = true,
                                                         .normal = true,
                                                         .max_instance_id = 32767});
    EXPECT_TRUE(read) << read.error().message;
    return read ? *read : FramePasses{};
  }
};

template <class T>
void expect_part(const Image<T>& part, const Image<T>& whole, const PixelRect& region,
                 const char* what) {
  ASSERT_EQ(part.width, region.width);
  ASSERT_EQ(part.height, region.height);
  int differing = 0;
  for (int row = 0; row < part.height; ++row) {
    for (int column = 0; column < part.width; ++column) {
      for (int channel = 0; channel < part.channels; ++channel) {
        differing +=
            part.at(row, column, channel) != whole.at(region.y + row, region.x + column, channel);
      }
    }
  }
  EXPECT_EQ(differing, 0) << what;
}

TEST_F(RealBlenderRegion, IsBitIdenticalToThatPartOfTheWholeFrame) {
  submit("whole", {});
  submit("objects", {"render.region=objects"});
  submit("box", {"render.region={x: 31, y: 17, width: 41, height: 37}"});
  for (const std::string campaign : {"objects", "box"}) {
    for (int i = 0; i < 3; ++i) {
      const std::filesystem::path folder = frame(campaign, i);
      const Json spec = *parse_json(*read_file(folder / "frame.json"), "spec");
      const auto box = spec.at("render").at("region").get<std::array<int, 4>>();
      const PixelRect region{box[0], box[1], box[2], box[3]};
      const FramePasses part = passes(folder, region.width, region.height);
      const FramePasses whole = passes(frame("whole", i), 97, 71);
      expect_part(part.combined, whole.combined, region, "combined");
      expect_part(part.instance_ids, whole.instance_ids, region, "index");
      expect_part(*part.depth, *whole.depth, region, "depth");
      expect_part(*part.normal, *whole.normal, region, "normal");
      const auto picture = read_png8(folder / "image.png");
      const auto original = read_png8(frame("whole", i) / "image.png");
      ASSERT_TRUE(picture && original);
      for (int row = 0; row < 71; ++row) {
        for (int column = 0; column < 97; ++column) {
          const bool inside = region.contains(column, row);
          ASSERT_EQ(picture->at(row, column), inside ? original->at(row, column) : 0);
        }
      }
      if (campaign != "objects") continue;
      for (const char* file : {"labels.json", "instances.png", "semantic.png"}) {
        EXPECT_EQ(*read_file(folder / file), *read_file(frame("whole", i) / file)) << file;
      }
    }
  }
  EXPECT_EQ(run({"audit", "objects", "--blender", test_blender(), "--frames", "2"}).exit_code, 0);
  EXPECT_THAT(run({"explain", "box", "1"}).output,
              HasSubstr("left out   78 % of the pixels: all but 41 × 37 from (31, 17)"));
  EXPECT_THAT(run({"submit", "region.yaml", "--dry-run", "--blender", test_blender(), "--set",
                   "render.region={x: 31, y: 17, width: 41, height: 37}"})
                  .output,
              HasSubstr("left out: 78.0 % of the pixels (render.region)"));
}

TEST_F(RealBlenderRegion, PatchesAreCheckedAndExported) {
  submit("patches", {"patches.size=32", "scenes=6", "render.width=640", "render.height=480"});
  ASSERT_EQ(run({"export", "patches", "--format", "patches", "-o", "out"}).exit_code, 0);
  std::size_t exported = 0;
  for (const auto& [name, bytes] : contents("out/patches/train")) {
    const auto patch = decode_png8(bytes, name);
    ASSERT_TRUE(patch);
    EXPECT_EQ(patch->width, 32);
    const int index = std::stoi(std::filesystem::path(name).filename().string());
    EXPECT_EQ(patch->values, read_png8(frame("patches", index) / "image.png")->values)
        << "the whole frame, as it is";
    ++exported;
  }
  EXPECT_EQ(exported, 6U) << "of each frame its target, whatever else it shows";
}

}  // namespace
}  // namespace seedframe
