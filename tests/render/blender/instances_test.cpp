// Instances share the mesh that Cycles builds, and each still wears its own materials.
#include <algorithm>

#include <gmock/gmock.h>
#include <sys/resource.h>

#include "tests/render/blender/real_blender_fixture.h"

namespace seedframe {
namespace {

/// Small balls beside each other, which neither see nor shade one another.
class RealBlenderInstances : public RealBlender {
 protected:
  FrameSpec empty() const {
    FrameSpec spec = ball();
    spec.render.width = 192;
    spec.render.height = 144;
    spec.camera.focal_px = {240.0, 240.0};
    spec.camera.center_px = {95.5, 71.5};
    spec.instances.clear();
    spec.materials.clear();
    return spec;
  }
  static Affine place(int index) {
    return placed(0.25 * (index % 7 - 3), 0.25 * (index / 7 - 2), -4, 0.07);
  }
  static void add(FrameSpec& spec, const std::string& mesh, std::vector<MaterialSpec> materials) {
    const int index = static_cast<int>(spec.instances.size());
    std::vector<int> indices;
    for (MaterialSpec& material : materials) {
      indices.push_back(static_cast<int>(spec.materials.size()));
      spec.materials.push_back(std::move(material));
    }
    spec.instances.push_back(
        instance(fmt::format("ball/{}", index), index + 1, mesh, indices, place(index)));
    spec.instances.back().hidden_from = {false, true, true, true, true};
  }
  /// A frame with that instance only.
  static FrameSpec alone(FrameSpec spec, std::size_t index) {
    spec.instances = {spec.instances[index]};
    return spec;
  }
};

MaterialSpec painted(double red, double green, double blue) {
  MaterialSpec material;
  material.base_color = {red, green, blue};
  return material;
}

TEST_F(RealBlenderInstances, LookTogetherAsTheyLookAlone) {
  const std::string red = add_texture(255, 60, 60);
  const std::string blue = add_texture(40, 80, 255);
  const std::string grey = add_texture(128, 128, 128);
  const std::string slanted = add_texture(180, 128, 220);
  FrameSpec spec = empty();
  MaterialSpec mirror = painted(0.9, 0.7, 0.2);
  mirror.metallic = 1.0;
  mirror.roughness = 0.1;
  MaterialSpec glass = painted(1, 1, 1);
  glass.transmission = 0.9;
  glass.ior = 1.3;
  glass.clearcoat = 0.5;
  MaterialSpec red_paper = painted(0.8, 0.9, 1.0);
  red_paper.textures = {{"color", red}};
  MaterialSpec blue_paper = painted(1, 1, 1);
  blue_paper.textures = {{"color", blue}};
  blue_paper.texture_repeat = 3.0;
  MaterialSpec rough = painted(0.5, 0.6, 0.7);
  rough.textures = {{"roughness", grey}, {"normal", slanted}};
  MaterialSpec metal = painted(0.5, 0.6, 0.7);
  metal.textures = {{"metallic", grey}, {"color", blue}};
  for (const MaterialSpec& material :
       {painted(0.8, 0.1, 0.1), mirror, red_paper, glass, blue_paper, rough, metal, red_paper}) {
    add(spec, smooth, {material});
  }
  for (const auto& [upper, lower] : {std::pair(red_paper, mirror), std::pair(mirror, blue_paper),
                                     std::pair(rough, painted(0, 1, 0))}) {
    add(spec, halves, {upper, lower});
  }
  const auto count = static_cast<std::int64_t>(spec.instances.size());
  specs[count] = spec;
  std::vector<std::int64_t> frames = {count};
  for (std::int64_t i = 0; i < count; ++i) {
    specs[i] = alone(spec, static_cast<std::size_t>(i));
    frames.push_back(i);
  }
  const auto summary = render(frames, 1);
  ASSERT_TRUE(summary) << summary.error().message;
  ASSERT_EQ(summary->committed, count + 1) << testing::PrintToString(failures);
  const FramePasses& together = passes[count];
  for (std::int64_t i = 0; i < count; ++i) {
    int pixels = 0;
    for (int y = 0; y < together.instance_ids.height; ++y) {
      for (int x = 0; x < together.instance_ids.width; ++x) {
        if (together.instance_ids.at(y, x) != i + 1) continue;
        ++pixels;
        EXPECT_EQ(passes[i].instance_ids.at(y, x), i + 1);
        for (int channel = 0; channel < 3; ++channel) {
          EXPECT_NEAR(together.combined.at(y, x, channel), passes[i].combined.at(y, x, channel),
                      2e-3)
              << "ball " << i << " at " << x << ", " << y;
        }
      }
    }
    EXPECT_GT(pixels, 30) << "ball " << i;
  }
}

TEST_F(RealBlenderInstances, OfOneMeshMayHaveAsManySetsOfImagesAsThereAre) {
  constexpr int kBalls = 35;
  FrameSpec spec = empty();
  std::vector<int> shades;
  for (int i = 0; i < kBalls; ++i) {
    const int shade = 40 + 6 * ((i * 11) % kBalls);
    shades.push_back(shade);
    MaterialSpec material = painted(1, 1, 1);
    material.specular = 0.0;
    material.roughness = 1.0;
    material.textures = {{"color", add_texture(static_cast<std::uint8_t>(shade), 128, 0)}};
    add(spec, smooth, {material});
  }
  const FramePasses picture = render_one(spec);
  std::vector<std::pair<int, float>> seen;  // shade of the texture, red in the picture
  for (int i = 0; i < kBalls; ++i) {
    const Eigen::Vector3d at = place(i).translation();
    const int x = static_cast<int>(std::lround(95.5 + 240 * at.x() / 4));
    const int y = static_cast<int>(std::lround(71.5 - 240 * at.y() / 4));
    ASSERT_EQ(picture.instance_ids.at(y, x), i + 1);
    seen.emplace_back(shades[static_cast<std::size_t>(i)], picture.combined.at(y, x, 0));
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end(), [](const auto& a, const auto& b) {
    return a.second < b.second;
  })) << testing::PrintToString(seen);
  EXPECT_GT(seen.back().second, 10 * seen.front().second);
}

TEST_F(RealBlenderInstances, AThousandOfAHundredThousandTrianglesFitInto1500Megabytes) {
  const std::string large = add_mesh(sphere_buffer(159, 1, 3.2F));  // 100,488 triangles
  FrameSpec spec = empty();
  spec.render.samples = 1;
  for (int i = 0; i < 1000; ++i) {
    spec.materials.push_back(painted(0.001 * i, 0.5, 0.5));
    spec.instances.push_back(
        instance(fmt::format("ball/{}", i), i + 1, large, {i},
                 placed(0.05 * (i % 40 - 20), 0.05 * (i / 40 - 12), -4, 0.02)));
  }
  render_one(spec);
  rusage children = {};
  ASSERT_EQ(getrusage(RUSAGE_CHILDREN, &children), 0);
  RecordProperty("megabytes", static_cast<int>(children.ru_maxrss / 1024));
  EXPECT_LT(children.ru_maxrss, 1'500'000);  // kilobytes
  EXPECT_GT(children.ru_maxrss, 50'000) << "of a Blender at all";
}

}  // namespace
}  // namespace seedframe
