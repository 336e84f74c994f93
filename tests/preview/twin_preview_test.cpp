#include "preview/twin_preview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "preview/preview_sheet.h"
#include "preview/twin_shading.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::SizeIs;

/// A ball of a colour before a dark sky, lit from the left.
std::string ball(const std::string& color, const std::string& more = "") {
  return "seedframe: 1\nscenes: 3\ncategories: [ball]\n"
         "render: {width: 640, height: 480}\n"
         "materials: {paint: {base_color: " +
         color +
         "}}\n"
         "objects: {b: {asset: sphere, category: ball, material: paint}}\n"
         "lights: {key: {type: sun, power: 3, position: [-5, 0, 0], target: [0, 0, 0]}}\n"
         "world: {color: [0.02, 0.02, 0.02]}\n"
         "camera: {position: [0, -1, 0], target: [0, 0, 0]}\n" +
         more;
}

std::vector<PreviewedFrame> preview_of(const std::string& text,
                                       const std::vector<std::int64_t>& frames = {0},
                                       int width = 160) {
  const auto expander = expander_of(text);
  EXPECT_TRUE(expander) << expander.error().message;
  auto previewed = preview_by_twin(*expander, {"ball"}, frames, width);
  EXPECT_TRUE(previewed) << previewed.error().message;
  return previewed ? std::move(*previewed) : std::vector<PreviewedFrame>(1);
}

TEST(TwinPreview, HasTheLabelsAndAnImageOfTheSameSize) {
  const std::vector<PreviewedFrame> frames = preview_of(ball("[0.8, 0.1, 0.1]"), {0, 2});
  ASSERT_THAT(frames, SizeIs(2));
  EXPECT_EQ(frames[1].index, 2);
  const FrameContent& content = frames[0].content;
  EXPECT_EQ(content.instance_ids.width, 160);
  EXPECT_EQ(content.image->width, 160);
  EXPECT_EQ(content.image->height, content.instance_ids.height);
  EXPECT_EQ(frames[0].scale, 4.0);
  ASSERT_THAT(content.labels.instances, SizeIs(1));
  EXPECT_GT(content.labels.instances[0].area_px, 50);
}

TEST(TwinPreview, ShowsColoursAndWhereTheLightComesFrom) {
  const FrameContent content = preview_of(ball("[0.8, 0.1, 0.1]"))[0].content;
  const PixelRect& box = content.labels.instances[0].box;
  const int row = box.y + box.height / 2;
  const int left = box.x + box.width / 4, right = box.end_x() - box.width / 4;
  EXPECT_GT(content.image->at(row, left, 0), content.image->at(row, left, 1) + 20) << "it is red";
  EXPECT_GT(content.image->at(row, left, 0), content.image->at(row, right, 0) + 20)
      << "and lit from the left";
  EXPECT_LT(content.image->at(0, 0, 0), 90) << "the sky is dark";
}

TEST(TwinPreview, LooksTheSameWhateverTheUnitOfLight) {
  const auto image = [](const std::string& power) {
    std::string text = ball("[0.5, 0.5, 0.5]");
    text.replace(text.find("power: 3"), 8, "power: " + power);
    text.replace(text.find("[0.02, 0.02, 0.02]"), 18, "[0, 0, 0]");
    return *preview_of(text)[0].content.image;
  };
  const Image<std::uint8_t> dim = image("0.001"), bright = image("5000");
  for (std::size_t i = 0; i < dim.values.size(); ++i) {
    ASSERT_NEAR(dim.values[i], bright.values[i], 1) << i;
  }
}

TEST(TwinPreview, OfASceneWithoutLightIsDarkAndWhole) {
  std::string text = ball("[0.5, 0.5, 0.5]");
  text.replace(text.find("power: 3"), 8, "power: 0");
  text.replace(text.find("[0.02, 0.02, 0.02]"), 18, "[0, 0, 0]");
  const FrameContent content = preview_of(text)[0].content;
  EXPECT_EQ(*std::max_element(content.image->values.begin(), content.image->values.end()), 0);
  EXPECT_GT(content.labels.instances[0].area_px, 50);
}

TEST(TwinPreview, IsTheSameAgainAndSmallFramesStayAsTheyAre) {
  const auto twice = [](int width) {
    return preview_of(ball("[0.1, 0.5, 0.1]"), {0, 1, 2}, width);
  };
  const auto first = twice(100), second = twice(100);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(first[i].content.image->values, second[i].content.image->values);
  }
  EXPECT_EQ(twice(5000)[0].content.image->width, 640);
  EXPECT_EQ(twice(1)[0].content.image->width, 1);
}

TEST(TwinPreview, TellsWhichFrameIsImpossible) {
  const auto expander =
      expander_of("seedframe: 1\ncategories: []\ncamera: {distance_m: {normal: [-5, 0.001]}}\n");
  ASSERT_TRUE(expander);
  EXPECT_FALSE(preview_by_twin(*expander, {}, {0}, 100));
}

TEST(ExposureFor, NothingIsOne) { EXPECT_EQ(exposure_for({}), 1.0); }

TEST(PreviewSheet, HasAFrameATileAndSaysSizesAndRemarks) {
  const std::vector<PreviewedFrame> frames = preview_of(ball("[0.8, 0.1, 0.1]"), {0, 1, 2});
  ObjectSizes sizes({"ball", "cube"});
  for (const PreviewedFrame& frame : frames) sizes.add(frame.content.labels, frame.scale);
  const ContactSheet sheet =
      preview_sheet(frames, sizes.by_class(), {"parts", "shaded", {"Warning: nothing"}});
  ASSERT_THAT(sheet.tiles, SizeIs(3));
  EXPECT_EQ(sheet.tiles[1].caption, "frame 1");
  EXPECT_EQ(sheet.tiles[1].note, "1 object");
  ASSERT_THAT(sheet.legend, SizeIs(2));
  EXPECT_TRUE(sheet.legend[0].text.ends_with(" px")) << sheet.legend[0].text;
  EXPECT_EQ(sheet.legend[1].text, "cube: none is seen");
  const ContactSheet one_size = preview_sheet(frames, {{"ball", 3, 31.6, 31.8, 32.4, 0}}, {});
  EXPECT_EQ(one_size.legend[0].text, "ball: 32 px");
  EXPECT_EQ(preview_sheet(frames, {{"ball", 3, 3.0, 9.0, 32.0, 0}}, {}).legend[0].text,
            "ball: 3 to 32 px");
  const auto with_remark = draw_sheet(sheet);
  ASSERT_TRUE(with_remark);
  ContactSheet without = sheet;
  without.remarks.clear();
  EXPECT_GT(with_remark->height, draw_sheet(without)->height);
}

}  // namespace
}  // namespace seedframe
