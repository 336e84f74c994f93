// The asset verb as a user sees it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class AssetVerb : public ProgramTest {
 protected:
  Outcome import(const std::vector<std::string>& more = {}) {
    write("part.obj", kTetrahedron);
    std::vector<std::string> arguments = {"asset", "import",  "part.obj", "--root",
                                          "lib",   "--scale", "0.001"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(AssetVerb, ImportReportsListShowsAndCheckAgrees) {
  const Outcome imported = import();
  ASSERT_EQ(imported.exit_code, 0) << imported.errors;
  EXPECT_THAT(imported.output, HasSubstr("watertight, 1 part, genus 0"));
  EXPECT_THAT(imported.output, HasSubstr("nothing to repair"));
  EXPECT_THAT(imported.output, HasSubstr("mesh.drc"));
  std::filesystem::remove(folder_ / "lib/part/thumbnail.png");
  const Outcome listed = run({"asset", "list", "--root", "lib"});
  EXPECT_THAT(listed.output, HasSubstr("part"));
  EXPECT_THAT(listed.output, HasSubstr("4 triangles"));
  EXPECT_THAT(listed.output, Not(HasSubstr("thumbnail.png")));
  write("lib/part/thumbnail.png", "an image");
  EXPECT_THAT(run({"asset", "list", "--root", "lib"}).output, HasSubstr("lib/part/thumbnail.png"));
  const Outcome checked = run({"asset", "check", "--root", "lib", "--thorough"});
  EXPECT_EQ(checked.exit_code, 0) << checked.errors;
  EXPECT_THAT(checked.output, HasSubstr("1 assets in lib, 0 damaged"));
}

TEST_F(AssetVerb, JsonReportsAreJson) {
  const Outcome imported = import({"--json"});
  const auto json = parse_json(imported.output, "report");
  ASSERT_TRUE(json) << imported.output;
  EXPECT_EQ((*json)[0]["levels"][0]["triangles"], 4);
  EXPECT_TRUE((*json)[0]["warnings"].empty());
  std::filesystem::remove(folder_ / "lib/part/thumbnail.png");
  const auto list = parse_json(run({"asset", "list", "--root", "lib", "--json"}).output, "list");
  ASSERT_TRUE(list);
  EXPECT_TRUE((*list)[0]["thumbnail"].is_null());
  EXPECT_EQ((*list)[0]["folder"], "lib/part");
}

TEST_F(AssetVerb, ADryRunWritesNothing) {
  const Outcome outcome = import({"--dry-run"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("not written"));
  EXPECT_FALSE(exists("lib"));
}

TEST_F(AssetVerb, CheckGoesOnAfterADamagedAssetAndNamesEachFault) {
  ASSERT_EQ(import().exit_code, 0);
  ASSERT_EQ(import({"--name", "other"}).exit_code, 0);
  write("lib/other/mesh.drc", "DRACO");
  write("lib/part/asset.json", "{}");
  const Outcome checked = run({"asset", "check", "--root", "lib"});
  EXPECT_EQ(checked.exit_code, 5);
  EXPECT_THAT(checked.errors, HasSubstr("lib/other/mesh.drc is damaged"));
  EXPECT_THAT(checked.errors, HasSubstr("lib/part/asset.json: key 'version' is missing"));
  EXPECT_THAT(checked.output, HasSubstr("2 assets in lib, 2 damaged"));
  const Outcome listed = run({"asset", "list", "--root", "lib"});
  EXPECT_EQ(listed.exit_code, 5);
  EXPECT_THAT(listed.output, HasSubstr("other")) << "a damaged asset must not hide the others";
}

TEST_F(AssetVerb, BadFilesAndOptionsAreInputErrors) {
  write("empty.ply", "");
  write("cut.stl", std::string(90, ' '));
  write("part.fbx", "x");
  for (const char* file : {"empty.ply", "cut.stl", "part.fbx", "missing.obj"}) {
    const Outcome outcome = run({"asset", "import", file, "--root", "lib"});
    EXPECT_NE(outcome.exit_code, 0) << file;
    EXPECT_LT(outcome.exit_code, 128) << file;
    EXPECT_THAT(outcome.errors, HasSubstr(file));
  }
  EXPECT_EQ(import({"--pixels", "1"}).exit_code, 2);
  EXPECT_EQ(import({"--levels", "99"}).exit_code, 2);
  EXPECT_EQ(import({"--up", "x"}).exit_code, 2);
  EXPECT_EQ(import({"--fill-holes", "100000"}).exit_code, 2);
  EXPECT_EQ(run({"asset", "check", "prat", "--root", "lib"}).exit_code, 2);
  EXPECT_FALSE(exists("lib"));
}

TEST_F(AssetVerb, KeypointsAreSetShownAndTakenAway) {
  ASSERT_EQ(import().exit_code, 0);
  const std::vector<std::string> keypoints = {"asset", "keypoints", "part", "--root", "lib"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = keypoints;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  EXPECT_THAT(run(keypoints).output, HasSubstr("part: 0 keypoints"));
  Outcome set = with({"tip=0,0,0.02", "heart=0.004,4e-3,0.004", "--inside", "heart", "--line",
                      "tip-heart", "--mirror", "heart-tip"});
  ASSERT_EQ(set.exit_code, 0) << set.errors;
  const Outcome shown = run(keypoints);
  EXPECT_EQ(shown.output, set.output);
  EXPECT_THAT(shown.output, HasSubstr("tip at 0 0 0.02 m\n"));
  EXPECT_THAT(shown.output, HasSubstr("heart at 0.004 0.004 0.004 m, inside\n"));
  EXPECT_THAT(shown.output, HasSubstr("line tip-heart\n"));
  EXPECT_THAT(shown.output, HasSubstr("mirror heart-tip\n"));
  EXPECT_EQ(run({"asset", "check", "--root", "lib"}).exit_code, 0);
  for (const auto& [arguments, complaint] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"tip=0,0"}, "'tip=0,0' is not a keypoint: expected NAME=X,Y,Z"},
           {{"tip=0,0,0x"}, "is not a keypoint"},
           {{"a b=0,0,0"}, "is not a keypoint"},
           {{"tip=0,0,nan"}, "'tip' needs three finite coordinates"},
           {{"tip=0,0,0", "tip=1,0,0"}, "two keypoints are named 'tip'"},
           {{"tip=0,0,0", "--inside", "tap"}, "did you mean 'tip'?"},
           {{"tip=0,0,0", "--line", "tip"}, "expected two keypoints, such as head-tip"},
           {{"tip=0,0,0", "--line", "tip-tail"}, "'tail', which does not exist"},
           {{"--line", "tip-heart"}, "give all of them again"}}) {
    const Outcome refused = with(arguments);
    EXPECT_EQ(refused.exit_code, 2) << complaint;
    EXPECT_THAT(refused.errors, HasSubstr(complaint));
    EXPECT_EQ(run(keypoints).output, shown.output) << "nothing was changed";
  }
  EXPECT_EQ(with({"--clear"}).exit_code, 0);
  EXPECT_THAT(run(keypoints).output, HasSubstr("part: 0 keypoints"));
  EXPECT_THAT(run({"asset", "keypoints", "prat", "--root", "lib"}).errors,
              HasSubstr("did you mean 'part'?"));
}

}  // namespace
}  // namespace seedframe
