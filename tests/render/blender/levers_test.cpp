// Levers of the path tracer: each has its effect on the picture, on nothing else, and repeats.

#include <functional>

#include <gmock/gmock.h>

#include "tests/render/blender/real_blender_fixture.h"

namespace seedframe {
namespace {

class RealBlenderLevers : public RealBlender {
 protected:
  /// Pixels black and white by turns.
  std::string add_chequers() {
    constexpr std::uint32_t kSide = 256;
    return add_picture(kSide, [](std::uint32_t i) { return (i + i / kSide) % 2 * 0xffffff; });
  }

  /// Balls of four materials that light and mirror each other, under a lamp.
  FrameSpec balls() {
    FrameSpec spec = ball();
    spec.render.samples = 8;
    spec.render.max_bounces = 6;
    spec.world.strength = 0.3;
    spec.materials.assign(4, spec.materials[0]);
    spec.materials[1].metallic = 1.0;
    spec.materials[1].roughness = 0.1;
    spec.materials[2].transmission = 1.0;
    spec.materials[2].roughness = 0.0;
    spec.materials[3].textures["color"] = add_chequers();
    spec.instances = {instance("ball/0", 1, smooth, {0}, placed(-1, 0, -4, 0.9)),
                      instance("ball/1", 2, smooth, {1}, placed(0.8, 0, -4, 0.9)),
                      instance("ball/2", 3, smooth, {2}, placed(0, 0.7, -3, 0.4)),
                      instance("ball/3", 4, smooth, {3}, placed(0, -0.9, -3.5, 0.5))};
    LightSpec lamp;
    lamp.kind = LightKind::kPoint;
    lamp.camera_from_light = placed(1, 2, -2);
    lamp.color = {1, 1, 1};
    lamp.power = 200;
    lamp.radius_m = 0.1;
    spec.lights = {lamp};
    return spec;
  }
};

TEST_F(RealBlenderLevers, ChangeThePictureOnlyAndRepeat) {
  using Change = std::function<void(RenderLevers&)>;
  const std::vector<std::pair<const char*, Change>> changes = {
      {"nothing", [](RenderLevers&) {}},
      {"diffuse bounces", [](RenderLevers& levers) { levers.bounces.diffuse = 0; }},
      {"glossy bounces", [](RenderLevers& levers) { levers.bounces.glossy = 0; }},
      {"transmission bounces", [](RenderLevers& levers) { levers.bounces.transmission = 0; }},
      {"light_threshold", [](RenderLevers& levers) { levers.light_threshold = 1.0; }},
      {"clamp_direct", [](RenderLevers& levers) { levers.clamp_direct = 0.2; }},
      {"filter_glossy", [](RenderLevers& levers) { levers.filter_glossy = 1.0; }},
      {"texture_limit_px", [](RenderLevers& levers) { levers.texture_limit_px = 128; }},
      {"nothing again", [](RenderLevers&) {}},
  };
  std::vector<std::int64_t> order;
  for (const auto& [name, change] : changes) {
    const auto frame = static_cast<std::int64_t>(order.size());
    specs[frame] = balls();
    change(specs[frame].render.levers);
    order.push_back(frame);
  }
  ASSERT_TRUE(render(order, 1)) << testing::PrintToString(failures);
  std::map<std::int64_t, std::map<std::string, std::string>> hashes;
  for (const auto& [frame, each] : passes) hashes[frame] = each.pixel_hashes;
  const auto last = static_cast<std::int64_t>(changes.size()) - 1;
  EXPECT_EQ(hashes[last], hashes[0]) << "nothing stays of what other frames had";
  for (std::int64_t frame = 1; frame < last; ++frame) {
    const char* name = changes[static_cast<std::size_t>(frame)].first;
    // With its light tree, Blender 3.5 knows better which lamps matter, and ignores the threshold.
    const bool ignored = name == std::string("light_threshold") && ready.blender >= "3.5";
    EXPECT_EQ(hashes[frame]["combined"] == hashes[0]["combined"], ignored) << name;
    EXPECT_EQ(hashes[frame]["index"], hashes[0]["index"]) << name;
    EXPECT_EQ(hashes[frame]["depth"], hashes[0]["depth"]) << name;
  }

  std::reverse(order.begin(), order.end());
  ASSERT_TRUE(render(order, 2)) << testing::PrintToString(failures);
  for (const auto& [frame, each] : passes) {
    EXPECT_EQ(each.pixel_hashes, hashes[frame]) << changes[static_cast<std::size_t>(frame)].first;
  }
}

TEST_F(RealBlenderLevers, SampleCountsAreOnePassMoreAndChangeNoOther) {
  specs[0] = balls();
  specs[0].render.samples = 256;
  specs[0].render.adaptive = {0.02, 16};
  specs[1] = specs[2] = specs[0];
  specs[2].render.adaptive = {};
  counted = {1, 2};
  ASSERT_TRUE(render({0, 1, 2, 0}, 1)) << testing::PrintToString(failures);
  EXPECT_EQ(passes[1].pixel_hashes, passes[0].pixel_hashes);
  ASSERT_TRUE(passes[1].sample_shares && passes[2].sample_shares);
  const std::vector<float>& adaptive = passes[1].sample_shares->values;
  EXPECT_EQ(*std::max_element(adaptive.begin(), adaptive.end()), 1.0F);
  EXPECT_LE(*std::min_element(adaptive.begin(), adaptive.end()), 0.5F);
  const std::vector<float>& plain = passes[2].sample_shares->values;
  EXPECT_EQ(*std::min_element(plain.begin(), plain.end()), 1.0F);
}

TEST_F(RealBlenderLevers, HolesNeedTransparentBounces) {
  FrameSpec spec = ball();
  spec.materials[0].textures["alpha"] = add_texture(0, 0, 0);  // all of it is a hole
  specs[0] = specs[1] = spec;
  specs[1].render.levers.bounces.transparent = 0;
  ASSERT_TRUE(render({0, 1}, 1)) << testing::PrintToString(failures);
  EXPECT_GT(passes[0].combined.at(18, 24, 0), 0.9F) << "the world shines through";
  EXPECT_LT(passes[1].combined.at(18, 24, 0), 0.1F);
}

TEST_F(RealBlenderLevers, PathGuidingIsRenderedWhereThereIsIt) {
  specs[0] = balls();
  specs[0].render.levers.path_guiding = true;
  const auto summary = render({0}, 1);
  ASSERT_TRUE(summary) << summary.error().message;
  if (summary->committed == 0) {
    EXPECT_THAT(failures[0], testing::HasSubstr("has no path guiding"));
  }
}

}  // namespace
}  // namespace seedframe
