#include "twin/twin_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/twin/scenes.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Ids = Image<std::uint16_t>;

constexpr TwinTolerance kDefault;

FrameSpec spec_of_two() {
  const CubeBuffer cube;
  FrameSpec spec = empty_spec();
  spec.instances = {cube_at(cube, 3, 0, 0, -10), cube_at(cube, 7, 0, 0, -10)};
  return spec;
}

/// 160 × 120 with a rectangle of one id.
Ids with_rectangle(int x, int y, int width, int height, std::uint16_t id, Ids ids = Ids(160, 120)) {
  for (int row = y; row < y + height; ++row) {
    for (int column = x; column < x + width; ++column) ids.at(row, column) = id;
  }
  return ids;
}

TEST(TwinComparison, EqualImagesAgree) {
  const Ids ids = with_rectangle(20, 20, 60, 50, 3);
  const TwinVerdict verdict = compare_with_twin(spec_of_two(), ids, ids, kDefault);
  EXPECT_THAT(verdict.complaint, IsEmpty());
  EXPECT_EQ(verdict.tally, (TwinTally{160 * 120, 0, 0}));
}

TEST(TwinComparison, AFewPixelsAtAnOutlineAreCountedAndAllowed) {
  const Ids twin = with_rectangle(20, 20, 60, 50, 3);
  Ids rendered = twin;
  rendered.at(20, 30) = 0;
  rendered.at(19, 40) = 3;
  const TwinVerdict verdict = compare_with_twin(spec_of_two(), rendered, twin, kDefault);
  EXPECT_THAT(verdict.complaint, IsEmpty());
  EXPECT_EQ(verdict.tally, (TwinTally{160 * 120, 0, 2}));
}

TEST(TwinComparison, AGlimpseOfSomethingSmallerThanAPixelIsAnEdge) {
  const Ids twin = with_rectangle(20, 20, 60, 50, 3);
  Ids rendered = twin;
  rendered.at(40, 40) = 7;  // and nowhere else in either
  rendered.at(50, 50) = 7;
  const auto grazes = [](int row, int column, std::uint16_t id) {
    return row == 40 && column == 40 && id == 7;
  };
  EXPECT_EQ(compare_with_twin(spec_of_two(), rendered, twin, kDefault,
                              {.grazes = grazes, .coincides = {}})
                .tally,
            (TwinTally{160 * 120, 1, 1}));
  EXPECT_EQ(difference_image(rendered, twin, {.grazes = grazes, .coincides = {}}).at(40, 40), 128);
  EXPECT_EQ(difference_image(rendered, twin, {.grazes = grazes, .coincides = {}}).at(50, 50), 255);
}

TEST(TwinComparison, WhereSurfacesCoincideEitherIsRight) {
  const Ids twin = with_rectangle(40, 40, 20, 20, 7, with_rectangle(20, 20, 60, 50, 3));
  const Ids rendered = with_rectangle(20, 20, 60, 50, 3);
  const auto coincides = [](int row, int column, std::uint16_t id) {
    return id == 3 && row >= 40 && row < 60 && column >= 40 && column < 60;
  };
  const Rounding rounding = {.grazes = {}, .coincides = coincides};
  EXPECT_FALSE(compare_with_twin(spec_of_two(), rendered, twin, kDefault).complaint.empty());
  const TwinVerdict verdict = compare_with_twin(spec_of_two(), rendered, twin, kDefault, rounding);
  EXPECT_THAT(verdict.complaint, IsEmpty());
  EXPECT_EQ(verdict.tally, (TwinTally{160 * 120, 0, 400}));
  EXPECT_EQ(difference_image(rendered, twin, rounding).at(45, 45), 64);
  const Ids other = with_rectangle(40, 40, 20, 20, 0, twin);  // a hole is none of the two
  EXPECT_FALSE(compare_with_twin(spec_of_two(), other, twin, kDefault, rounding).complaint.empty());
}

TEST(TwinComparison, AHoleInAnInstanceIsInside) {
  const Ids twin = with_rectangle(20, 20, 60, 50, 3);
  const Ids rendered = with_rectangle(40, 40, 2, 1, 0, twin);
  const TwinVerdict verdict = compare_with_twin(spec_of_two(), rendered, twin, kDefault);
  EXPECT_EQ(verdict.tally, (TwinTally{160 * 120, 2, 0}));
  EXPECT_THAT(verdict.complaint, HasSubstr("2 of 19200 pixels"));
  EXPECT_THAT(verdict.complaint, HasSubstr("'cube/3' (id 3)"));
  const TwinVerdict loose = compare_with_twin(spec_of_two(), rendered, twin, {2e-4, 0.1});
  EXPECT_THAT(loose.complaint, IsEmpty()) << "3.84 pixels are allowed";
}

TEST(TwinComparison, AMissingObjectIsCaught) {
  const Ids twin = with_rectangle(90, 20, 30, 30, 7, with_rectangle(20, 20, 60, 50, 3));
  const Ids rendered = with_rectangle(20, 20, 60, 50, 3);
  const TwinVerdict verdict = compare_with_twin(spec_of_two(), rendered, twin, kDefault);
  EXPECT_THAT(verdict.complaint, HasSubstr("'cube/7' (id 7)"));
  EXPECT_THAT(verdict.complaint, HasSubstr("missing from the picture"));
}

TEST(TwinComparison, AThingThatTheTwinDoesNotSeeIsCaught) {
  const Ids twin = with_rectangle(20, 20, 60, 50, 3);
  const Ids rendered = with_rectangle(90, 20, 30, 30, 7, twin);
  const TwinVerdict verdict = compare_with_twin(spec_of_two(), rendered, twin, kDefault);
  EXPECT_THAT(verdict.complaint, HasSubstr("the twin does not see it"));
}

TEST(TwinComparison, AnObjectOnePixelOutOfPlaceIsCaughtThoughOnlyEdgesDiffer) {
  const Ids twin = with_rectangle(20, 20, 60, 50, 3);
  const Ids rendered = with_rectangle(21, 20, 60, 50, 3);
  const TwinVerdict verdict = compare_with_twin(spec_of_two(), rendered, twin, kDefault);
  EXPECT_EQ(verdict.tally, (TwinTally{160 * 120, 0, 100}));
  EXPECT_THAT(verdict.complaint, HasSubstr("outline"));
  EXPECT_THAT(verdict.complaint, HasSubstr("'cube/3'"));
}

TEST(TwinComparison, ATinyObjectOutOfPlaceIsWithinWhatIsAlwaysAllowed) {
  const Ids twin = with_rectangle(20, 20, 3, 3, 3);
  const Ids rendered = with_rectangle(21, 20, 3, 3, 3);
  EXPECT_THAT(compare_with_twin(spec_of_two(), rendered, twin, kDefault).complaint, IsEmpty());
}

TEST(TwinComparison, TwoInstancesThatSwappedIdsAreCaught) {
  const Ids twin = with_rectangle(90, 20, 30, 30, 7, with_rectangle(20, 20, 60, 50, 3));
  const Ids rendered = with_rectangle(90, 20, 30, 30, 3, with_rectangle(20, 20, 60, 50, 7));
  EXPECT_FALSE(compare_with_twin(spec_of_two(), rendered, twin, kDefault).complaint.empty());
}

TEST(TwinComparison, BordersOfTheImageAreNotAnOutline) {
  const Ids twin = with_rectangle(0, 0, 160, 120, 3);
  Ids rendered = twin;
  rendered.at(0, 0) = 7;  // the twin has no 7 next to it: not an outline that rounds
  EXPECT_EQ(compare_with_twin(spec_of_two(), rendered, twin, kDefault).tally,
            (TwinTally{160 * 120, 1, 0}));
}

TEST(TwinComparison, TheDifferenceImageShowsWhere) {
  const Ids twin = with_rectangle(20, 20, 60, 50, 3);
  Ids rendered = twin;
  rendered.at(20, 30) = 0;
  rendered.at(45, 45) = 0;
  const Image<std::uint8_t> difference = difference_image(rendered, twin);
  EXPECT_EQ(difference.at(20, 30), 128);
  EXPECT_EQ(difference.at(45, 45), 255);
  EXPECT_EQ(std::count(difference.values.begin(), difference.values.end(), 0), 160 * 120 - 2);
}

}  // namespace
}  // namespace seedframe
