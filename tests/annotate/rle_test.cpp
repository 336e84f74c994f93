#include "annotate/rle.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/annotate/coco_decoder.h"
#include "tests/annotate/mask_cases.h"

namespace seedframe {
namespace {

Rle encode(const MaskCase& mask) { return encode_rle(mask_of(mask.ids)); }

TEST(Rle, RunsGoDownTheColumnsAndBeginWithBackground) {
  const Rle rle = encode(mask_drawing("", {"..#", ".##", "..."}));
  EXPECT_EQ(rle.height, 3);
  EXPECT_EQ(rle.width, 3);
  EXPECT_EQ(rle.counts, (std::vector<std::uint32_t>{4, 1, 1, 2, 1}));
}

TEST(Rle, TheFirstRunIsEmptyWhenTheFirstPixelIsInTheMask) {
  EXPECT_EQ(encode(mask_drawing("", {"#.", ".."})).counts, (std::vector<std::uint32_t>{0, 1, 3}));
}

TEST(Rle, NoEmptyRunFollowsTheLastPixel) {
  EXPECT_EQ(encode(mask_drawing("", {"..", ".#"})).counts, (std::vector<std::uint32_t>{3, 1}));
  EXPECT_EQ(encode(mask_drawing("", {".#", ".#"})).counts, (std::vector<std::uint32_t>{2, 2}));
  EXPECT_EQ(encode(mask_drawing("", {"##", "##"})).counts, (std::vector<std::uint32_t>{0, 4}));
}

TEST(Rle, AnEmptyMaskIsOneRun) {
  EXPECT_EQ(encode(mask_drawing("", {"...", "..."})).counts, (std::vector<std::uint32_t>{6}));
}

TEST(Rle, RunsGoOnAcrossFullColumns) {
  EXPECT_EQ(encode(mask_drawing("", {".##.", ".##."})).counts,
            (std::vector<std::uint32_t>{2, 4, 2}));
}

// Literal strings, computed by hand from the definition of the format.
TEST(RleString, MatchesValuesComputedByHand) {
  const auto text = [](std::vector<std::uint32_t> counts) {
    return rle_string({.height = 1, .width = 1, .counts = std::move(counts)});
  };
  EXPECT_EQ(text({9}), "9");
  EXPECT_EQ(text({0, 1}), "01");
  EXPECT_EQ(text({4, 1, 4}), "414");
  EXPECT_EQ(text({1, 1, 1, 2}), "1111");  // the 4th run: 2 - 1
  EXPECT_EQ(text({1, 3, 1, 2}), "131O");  // 2 - 3 = -1: 11111, 48 + 31
  EXPECT_EQ(text({15}), "?");             // 01111
  EXPECT_EQ(text({16}), "`0");            // 10000 would read as negative: a second group of 0
  EXPECT_EQ(text({31}), "o0");
  EXPECT_EQ(text({32}), "P1");
  EXPECT_EQ(text({0, 40, 0, 8}), "0X10PO");  // 8 - 40 = -32: 00000 and more, then -1
}

TEST(RleString, HoldsLongRuns) {
  const Rle empty = encode_rle(mask_of(IdImage(640, 480)));
  EXPECT_EQ(rle_string(empty), "PP\\9");  // 307200 = 9·32³ + 12·32² + 0·32 + 0
}

TEST(Rle, EveryMaskDecodesToItself) {
  int decoded = 0;
  for (const MaskCase& mask : mask_cases()) {
    SCOPED_TRACE(mask.name);
    const Bitmap truth = bitmap_of(mask.ids);
    const Rle rle = encode(mask);
    const std::vector<std::int64_t> runs = coco_decoder::runs_of_string(rle_string(rle));
    ASSERT_TRUE(std::equal(runs.begin(), runs.end(), rle.counts.begin(), rle.counts.end()));
    // pycocotools never writes an empty run but the first.
    ASSERT_EQ(std::count(runs.begin() + 1, runs.end(), 0), 0);
    ASSERT_EQ(coco_decoder::bitmap_of_runs(runs, mask.ids.height, mask.ids.width).values,
              truth.values);
    ASSERT_EQ(rle_area(rle), std::accumulate(truth.values.begin(), truth.values.end(), 0));
    ASSERT_EQ(rle_area(rle), mask_of(mask.ids).area_px());
    ++decoded;
  }
  EXPECT_GE(decoded, 200);
}

}  // namespace
}  // namespace seedframe
