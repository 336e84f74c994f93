// The main promise: the pixels of a frame follow from its spec and from nothing else.
#include <algorithm>
#include <set>

#include <gmock/gmock.h>

#include "tests/render/blender/real_blender_fixture.h"

namespace seedframe {
namespace {

using Hashes = std::map<std::int64_t, std::map<std::string, std::string>>;

Hashes hashes_of(const std::map<std::int64_t, FramePasses>& passes) {
  Hashes hashes;
  for (const auto& [frame, each] : passes) hashes[frame] = each.pixel_hashes;
  return hashes;
}

TEST_F(RealBlender, PixelsDependOnNeitherHistoryNorThreadsNorWorker) {
  add_texture(200, 90, 160);
  add_texture(128, 128, 255);
  constexpr int kFrames = 14;
  std::vector<std::int64_t> order;
  for (int frame = 0; frame < kFrames; ++frame) {
    order.push_back(frame);
    specs[frame] = varied(frame);
  }
  auto summary = render(order, 1);
  ASSERT_TRUE(summary) << summary.error().message;
  ASSERT_EQ(summary->committed, kFrames) << testing::PrintToString(failures);
  EXPECT_EQ(summary->worker_starts, 1);
  const Hashes hashes = hashes_of(passes);
  for (int frame = 0; frame < kFrames; ++frame) {
    EXPECT_EQ(hashes.at(frame).count("depth"), specs[frame].render.depth ? 1u : 0u);
    EXPECT_EQ(hashes.at(frame).count("normal"), specs[frame].render.normal ? 1u : 0u);
  }

  std::reverse(order.begin(), order.end());
  ASSERT_TRUE(render(order, 2));
  EXPECT_EQ(hashes_of(passes), hashes) << "in reverse, with two threads";

  order.insert(order.begin(), order.begin() + kFrames / 2, order.end());
  std::stable_partition(order.begin(), order.end(),
                        [](std::int64_t frame) { return frame % 3 == 1; });
  order.erase(order.begin() + kFrames, order.end());
  ASSERT_TRUE(render(order, 1));
  for (const auto& [frame, each] : hashes_of(passes)) {
    EXPECT_EQ(each, hashes.at(frame)) << "in another order, some frames twice";
  }

  frames_per_worker = 1;
  summary = render({1, 5, 9}, 2);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->worker_starts, 3);
  for (const auto& [frame, each] : hashes_of(passes)) {
    EXPECT_EQ(each, hashes.at(frame)) << "in a fresh worker";
  }
}

TEST_F(RealBlender, AdaptiveSamplingAndDenoisingChangeThePictureOnlyAndRepeat) {
  FrameSpec plain = ball();
  plain.render.samples = 64;
  plain.render.normal = true;
  plain.materials[0].roughness = 0.2;
  plain.materials[0].metallic = 1.0;
  specs[0] = specs[1] = specs[2] = specs[3] = plain;
  specs[1].render.adaptive = {0.3, 16};
  specs[2].render.denoise = Denoise::kOidn;
  specs[3].render.denoise = Denoise::kOidnFast;
  ASSERT_TRUE(render({0, 1}, 1)) << testing::PrintToString(failures);
  std::vector<std::int64_t> frames = {0, 1};
  if (!ready.denoisers.empty()) frames.insert(frames.end(), {2, 3});
  ASSERT_TRUE(render(frames, 1)) << testing::PrintToString(failures);
  const Hashes hashes = hashes_of(passes);
  std::set<std::string> pictures;
  for (const std::int64_t frame : frames) {
    pictures.insert(hashes.at(frame).at("combined"));
    for (const char* pass : {"index", "depth", "normal"}) {
      // A normal is the mean over a pixel's samples, of which adaptive sampling leaves some out.
      if (frame == 1 && pass == std::string("normal")) continue;
      EXPECT_EQ(hashes.at(frame).at(pass), hashes.at(0).at(pass)) << frame << " " << pass;
    }
  }
  EXPECT_EQ(pictures.size(), frames.size()) << "each has its effect";

  std::reverse(frames.begin(), frames.end());
  ASSERT_TRUE(render(frames, 2));
  EXPECT_EQ(hashes_of(passes), hashes) << "in reverse, with two threads";
  frames_per_worker = 1;
  ASSERT_TRUE(render(frames, 1));
  EXPECT_EQ(hashes_of(passes), hashes) << "in fresh workers";
}

TEST_F(RealBlender, APinnedWorkerSaysSoAndAnotherKernelShowsInThePictureOnly) {
  specs[0] = varied(0);
  conditions.kernels = kernels_of(Isa::kAvx2);
  ASSERT_TRUE(render({0}, 1));
  EXPECT_EQ(ready.kernel, "avx2");
  EXPECT_EQ(ready.embree, "avx2");
  const auto avx2 = passes[0].pixel_hashes;
  const auto blender = probe_blender(test_blender());
  ASSERT_TRUE(blender);
  const bool has_sse42 = std::pair(blender->major, blender->minor) >= std::pair(4, 2);
  conditions.kernels = kernels_of(has_sse42 ? Isa::kSse42 : Isa::kSse41);
  ASSERT_TRUE(render({0}, 2));
  EXPECT_EQ(ready.kernel, has_sse42 ? "sse42" : "sse41");
  EXPECT_EQ(ready.embree, "sse4.2");
  EXPECT_NE(passes[0].pixel_hashes["combined"], avx2.at("combined"));
  EXPECT_EQ(passes[0].pixel_hashes["index"], avx2.at("index"));
}

TEST_F(RealBlender, TheSeedIsRenderersSeed) {
  specs[0] = specs[1] = specs[2] = ball();
  specs[1].render.seed = 2;
  ASSERT_TRUE(render({0, 1, 2}, 1));
  EXPECT_NE(passes[0].pixel_hashes["combined"], passes[1].pixel_hashes["combined"]);
  EXPECT_EQ(passes[0].pixel_hashes["index"], passes[1].pixel_hashes["index"]);
  EXPECT_EQ(passes[0].pixel_hashes["combined"], passes[2].pixel_hashes["combined"]);
}

TEST_F(RealBlender, ABadFrameIsReportedAndTheWorkerGoesOn) {
  std::string cut = sphere_buffer(6, 1, 0.0F);
  cut.resize(cut.size() / 2);
  std::string wild = sphere_buffer(6, 1, 0.0F);
  wild[24 + 12 * 7 * 12 + 3] = '\x7f';  // a corner now names vertex 0x7f……
  for (int frame = 0; frame < 7; ++frame) specs[frame] = ball();
  specs[1].instances[0].mesh = add_mesh(cut);
  specs[2].instances[0].mesh = add_mesh(wild);
  specs[3].instances[0].mesh = std::string(64, '0');
  specs[4].instances[0].materials = {0, 0};
  specs[5].materials[0].textures["color"] = add_texture_file("this is no image");
  const auto summary = render({0, 1, 2, 3, 4, 5, 6}, 1);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->committed, 2);
  EXPECT_EQ(summary->worker_starts, 1);
  EXPECT_THAT(failures[1], testing::HasSubstr("header asks for"));
  EXPECT_THAT(failures[2], testing::HasSubstr("names vertex"));
  EXPECT_THAT(failures[3], testing::HasSubstr("not in the request's table"));
  EXPECT_THAT(failures[4], testing::HasSubstr("2 materials"));
  EXPECT_THAT(failures[5], testing::HasSubstr("no image that Blender can read"));
  EXPECT_EQ(passes[0].pixel_hashes, passes[6].pixel_hashes) << "and nothing of it shows";
}

TEST_F(RealBlender, SaysWhatItIs) {
  specs[0] = ball();
  ASSERT_TRUE(render({0}, 1));
  const auto info = probe_blender(test_blender());
  ASSERT_TRUE(info);
  EXPECT_EQ(ready.blender, info->version);
  EXPECT_TRUE(std::filesystem::exists(ready.ocio_config)) << ready.ocio_config;
  EXPECT_THAT(ready.kernel, testing::AnyOf("avx2", "avx", "sse42", "sse41", "sse3", "sse2"));
  EXPECT_THAT(ready.embree, testing::AnyOf("avx512", "avx2", "avx", "sse4.2", "sse2"));
  EXPECT_EQ(ready.reciprocals.size(), 16u);
  EXPECT_THAT(ready.libc, testing::StartsWith("glibc "));
}

}  // namespace
}  // namespace seedframe
