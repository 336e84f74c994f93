#include "frames/campaign_files.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(CampaignFiles, NamesFramesByThousands) {
  const CampaignFiles files("c");
  EXPECT_EQ(files.frame(0), "c/frames/000/000000");
  EXPECT_EQ(files.frame(12345), "c/frames/012/012345");
  EXPECT_EQ(files.frame(1234567), "c/frames/1234/1234567");
  EXPECT_NE(files.attempt(5, 1), files.attempt(5, 2));
}

}  // namespace
}  // namespace seedframe
