#include "picture/stored_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "picture/frame_picture.h"
#include "picture/pixel_layers.h"
#include "tests/export/synthetic_dataset.h"
#include "tests/fixtures/message_of.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/scene/scene_fixture.h"
#include "twin/twin.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

class StoredFrameTest : public ::testing::Test {
 protected:
  StoredFrameTest() : campaign_(scratch_.path()) {
    campaign_.add_frame(8, 4, SyntheticDataset::crossed_bolts());
  }
  Result<FrameContent> content(const LayerSet& layers) {
    return read_content(campaign_.frames().at(0), campaign_.dataset(), layers,
                        [](std::int64_t) -> Result<ExpandedFrame> {
                          return fail(ErrorKind::kInput, "there is no config");
                        });
  }

  ScratchFolder scratch_;
  SyntheticDataset campaign_;
};

TEST_F(StoredFrameTest, HasWhatItsLayersNeedAndNoMore) {
  const auto labels = content({Layer::kBoxes});
  ASSERT_TRUE(labels) << labels.error().message;
  EXPECT_FALSE(labels->image);
  EXPECT_EQ(labels->instance_ids.values, campaign_.truth(8).ids.values);
  const auto image = content({Layer::kImage, Layer::kNames});
  ASSERT_TRUE(image);
  ASSERT_TRUE(image->image);
  EXPECT_EQ(image->image->width, 160);
  EXPECT_TRUE(image->absent.contains(Layer::kDepth));
}

TEST_F(StoredFrameTest, SaysWhyItLacksALayer) {
  const auto all = content({Layer::kDepth, Layer::kNormals, Layer::kDisagreement});
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_THAT(all->absent.at(Layer::kDepth), HasSubstr("passes: [depth]"));
  EXPECT_THAT(all->absent.at(Layer::kNormals), HasSubstr("passes: [normal]"));
  EXPECT_THAT(all->absent.at(Layer::kDisagreement), HasSubstr("there is no config"));
  EXPECT_FALSE(all->absent.contains(Layer::kKeypoints));
  campaign_.dataset().has_images = false;
  const auto labels_only = content({Layer::kImage, Layer::kDisagreement});
  ASSERT_TRUE(labels_only);
  EXPECT_THAT(labels_only->absent.at(Layer::kImage), HasSubstr("nothing was rendered"));
  EXPECT_THAT(labels_only->absent.at(Layer::kDisagreement), HasSubstr("nothing to compare"));
}

TEST_F(StoredFrameTest, ThatIsDamagedIsAnErrorOfItsOwn) {
  const fs::path folder = campaign_.frame_folder(8);
  const std::string whole = *read_file(folder / "image.png");
  ASSERT_TRUE(write_quickly(folder / "image.png", whole.substr(0, whole.size() / 2)));
  const auto cut = content({Layer::kImage});
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(cut.error().message, HasSubstr("frame 8"));
  ASSERT_TRUE(write_quickly(folder / "image.png", whole));
  EXPECT_TRUE(content({Layer::kImage}));
  fs::remove_all(folder);
  EXPECT_EQ(content({Layer::kBoxes}).error().kind, ErrorKind::kCorrupt);
}

TEST_F(StoredFrameTest, WithPicturesOfAnotherSizeIsDamaged) {
  const fs::path folder = campaign_.frame_folder(8);
  ASSERT_TRUE(write_quickly(folder / "image.png", encode_png(Image<std::uint8_t>(5, 4, 3))));
  SyntheticDataset::write_manifest(campaign_.frames().at(0));
  EXPECT_THAT(message_of(content({Layer::kImage})), HasSubstr("picture has 5 × 4 pixels"));
}

TEST_F(StoredFrameTest, DisagreesWhereTheTwinSeesAnotherInstance) {
  const auto expander = expander_of(
      "seedframe: 1\nrender: {width: 64, height: 48}\nobjects: {o: {asset: cube}}\n"
      "camera: {distance_m: 0.5}\n");
  ASSERT_TRUE(expander) << expander.error().message;
  const ExpandedFrame frame = frame_of(*expander);
  const auto twin = TwinTracer().trace(frame.spec, frame.meshes, TwinTracer::Passes::kIdsOnly);
  ASSERT_TRUE(twin) << twin.error().message;
  IdImage ids = twin->instance_ids;
  ASSERT_EQ(ids.at(24, 32), 1) << "the cube is in the middle";
  ids.at(24, 32) = 0;
  campaign_.add_frame(9, 4, ids);
  const CommittedFrame& committed = campaign_.frames().at(1);
  std::string id = committed.frame_id;
  const auto expand = [&](std::int64_t) -> Result<ExpandedFrame> {
    ExpandedFrame today = frame;
    today.id = id;
    return today;
  };
  const auto content = read_content(committed, campaign_.dataset(), {Layer::kDisagreement}, expand);
  ASSERT_TRUE(content) << content.error().message;
  ASSERT_TRUE(content->disagreement) << content->absent.at(Layer::kDisagreement);
  EXPECT_EQ(content->disagreement->at(24, 32), 255);
  EXPECT_EQ(count_disagreement(*content->disagreement).inside_px, 1);
  EXPECT_EQ(count_disagreement(*content->disagreement).edge_px, 0);
  id = "another";
  EXPECT_THAT(read_content(committed, campaign_.dataset(), {Layer::kDisagreement}, expand)
                  ->absent.at(Layer::kDisagreement),
              HasSubstr("have changed since"));
}

TEST_F(StoredFrameTest, SkeletonsAreTheDatasetsByName) {
  const Skeletons skeletons = skeletons_of(campaign_.dataset());
  ASSERT_EQ(skeletons.size(), 4U);
  EXPECT_EQ(skeletons[0], (std::vector<std::array<std::string, 2>>{{"head", "tip"}}));
  EXPECT_TRUE(skeletons[1].empty());
}

TEST_F(StoredFrameTest, CanBeDrawnInAllItsLayers) {
  const auto all = content({Layer::kImage});
  ASSERT_TRUE(all);
  for (const Layer layer : {Layer::kInstances, Layer::kSemantic, Layer::kBoxes, Layer::kAmodal,
                            Layer::kKeypoints, Layer::kNames}) {
    const FramePicture picture =
        draw_frame(*all, LayerSet{Layer::kImage}.with({layer}), tile_size(160, 120, 320, 320),
                   skeletons_of(campaign_.dataset()));
    EXPECT_NE(picture.pixels.values,
              draw_frame(*all, {Layer::kImage}, tile_size(160, 120, 320, 320)).pixels.values)
        << kLayerNames[static_cast<std::size_t>(layer)];
  }
}

}  // namespace
}  // namespace seedframe
