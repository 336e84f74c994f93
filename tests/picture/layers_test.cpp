#include "picture/layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/message_of.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Layers, AreReadAsTilesOfLayersOverEachOther) {
  const auto tiles = parse_layers("image+boxes+names,instances");
  ASSERT_TRUE(tiles) << tiles.error().message;
  EXPECT_THAT(*tiles, ElementsAre(LayerSet{Layer::kImage, Layer::kBoxes, Layer::kNames},
                                  LayerSet{Layer::kInstances}));
}

TEST(Layers, HaveANameThatIsReadAsThem) {
  for (const std::string text : {"image+amodal+boxes+keypoints+names", "depth", "semantic"}) {
    EXPECT_EQ(parse_layers(text)->front().name(), text);
  }
  EXPECT_EQ(parse_layers("names+image")->front().name(), "image+names") << "as they are painted";
}

TEST(Layers, ThatAreMisspeltAreNamedWithWhatWasMeant) {
  EXPECT_THAT(message_of(parse_layers("image+boxs")),
              HasSubstr("there is no layer 'boxs' (did you mean 'boxes'?)"));
  for (const char* text : {"", ",", "image,", "image++boxes", " image"}) {
    EXPECT_FALSE(parse_layers(text)) << text;
  }
}

TEST(Layers, ThatCoverEachOtherAreRefused) {
  EXPECT_THAT(message_of(parse_layers("image+depth")), HasSubstr("a comma"));
  EXPECT_THAT(message_of(parse_layers("image,depth+normals")), HasSubstr("'depth+normals' has 2"));
}

}  // namespace
}  // namespace seedframe
