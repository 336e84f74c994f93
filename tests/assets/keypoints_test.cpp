#include "assets/keypoints.h"

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assets/asset_files.h"
#include "assets/asset_library.h"
#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

KeypointSet two_points() {
  return {{{"head", {0, 0, -0.5}, false}, {"joint", {0.25, 0, 0}, true}},
          {{"head", "joint"}},
          {{"joint", "head"}}};
}

TEST(Keypoints, ReadBackWhatWasWritten) {
  const auto read = keypoints_from_json(to_json(two_points()), "asset.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(to_json(*read), to_json(two_points()));
}

TEST(Keypoints, AreRefusedWithTheirNames) {
  const auto complaint = [](const KeypointSet& set) {
    const Status checked = check_keypoints(set, "part");
    return checked ? std::string() : checked.error().message;
  };
  KeypointSet set = two_points();
  EXPECT_EQ(complaint(set), "");
  set.points[1].name = "head";
  EXPECT_THAT(complaint(set), HasSubstr("two keypoints are named 'head'"));
  set = two_points();
  set.skeleton[0][1] = "tail";
  EXPECT_THAT(complaint(set), HasSubstr("'tail', which does not exist"));
  set = two_points();
  set.mirrored[0] = {"head", "head"};
  EXPECT_THAT(complaint(set), HasSubstr("joined to itself"));
  set = two_points();
  set.points[0].point_m.x() = std::nan("");
  EXPECT_THAT(complaint(set), HasSubstr("'head' needs three finite coordinates"));
  set = two_points();
  set.points[0].name.clear();
  EXPECT_THAT(complaint(set), HasSubstr("needs a name"));
}

TEST(Keypoints, DamagedOnesAreNamed) {
  for (const char* key : {"points", "skeleton", "mirrored"}) {
    for (const Json& wrong : {Json(1), Json("x"), Json::array({1})}) {
      Json json = to_json(two_points());
      json[key] = wrong;
      const auto read = keypoints_from_json(json, "a/asset.json");
      ASSERT_FALSE(read) << key << wrong;
      EXPECT_EQ(read.error().kind, ErrorKind::kCorrupt);
      EXPECT_THAT(read.error().message, HasSubstr("a/asset.json"));
    }
  }
}

TEST(Keypoints, AreSetInAnAssetAndTakenAwayAgain) {
  const ScratchFolder root;
  fs::copy(fs::path(SEEDFRAME_HOME) / "assets/gear", root / "gear", fs::copy_options::recursive);
  const std::string before = *read_file(root / "gear/asset.json");
  ASSERT_TRUE(set_keypoints(root / "gear", two_points()));
  const auto asset = read_asset(root / "gear");
  ASSERT_TRUE(asset) << asset.error().message;
  EXPECT_EQ(to_json(asset->keypoints), to_json(two_points()));
  KeypointSet wrong = two_points();
  wrong.points[1].name = "head";
  EXPECT_FALSE(set_keypoints(root / "gear", wrong));
  ASSERT_TRUE(set_keypoints(root / "gear", {}));
  EXPECT_EQ(*read_file(root / "gear/asset.json"), before);
}

}  // namespace
}  // namespace seedframe
