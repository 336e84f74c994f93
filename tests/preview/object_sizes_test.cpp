#include "preview/object_sizes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

FrameLabels labels_of(const std::vector<std::pair<int, PixelRect>>& objects) {
  FrameLabels labels;
  for (const auto& [category, box] : objects) {
    InstanceLabel& label = labels.instances.emplace_back();
    label.category = category;
    label.box = box;
    label.area_px = box.area();
  }
  return labels;
}

TEST(ObjectSizes, AreOfTheLongerSideInPixelsOfTheFullImage) {
  ObjectSizes sizes({"gear", "bolt"});
  sizes.add(labels_of({{1, {0, 0, 10, 4}}, {1, {0, 0, 3, 6}}, {0, {0, 0, 99, 99}}}), 2.0);
  sizes.add(labels_of({{1, {0, 0, 7, 7}}, {2, {}}}), 1.0);
  const std::vector<ClassSizes> by_class = sizes.by_class();
  ASSERT_THAT(by_class, SizeIs(2));
  EXPECT_EQ(by_class[0].objects, 3);
  EXPECT_EQ(by_class[0].least_px, 7.0);
  EXPECT_EQ(by_class[0].median_px, 12.0);
  EXPECT_EQ(by_class[0].most_px, 20.0);
  EXPECT_EQ(by_class[1].objects, 0) << "nothing is seen of it";
  EXPECT_EQ(by_class[1].hidden, 1);
}

TEST(ObjectSizes, AreATableOfEightyColumns) {
  ObjectSizes sizes({"gear", std::string(200, 'n')});
  sizes.add(labels_of({{1, {0, 0, 10'000, 4}}}), 1.0);
  const std::vector<std::string> lines = lines_of(sizes.by_class(), 2);
  ASSERT_THAT(lines, SizeIs(3));
  EXPECT_THAT(lines[0], HasSubstr("px"));
  EXPECT_THAT(lines[1], HasSubstr("0.5     10000     10000     10000"));
  EXPECT_THAT(lines[2], HasSubstr("none"));
  for (const std::string& line : lines) EXPECT_LE(line.size(), 80U) << line;
}

TEST(ObjectSizes, OfNothingHaveTheirHeadingOnly) {
  EXPECT_THAT(lines_of(ObjectSizes({}).by_class(), 0), SizeIs(1));
}

}  // namespace
}  // namespace seedframe
