// The asset verb as a user sees it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

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

TEST_F(AssetVerb, OneBadFileCostsNoOther) {
  write("a.obj", kTetrahedron);
  write("bad.obj", "v 0 0 0\n");
  write("c.obj", kTetrahedron);
  const std::vector<std::string> all = {"asset",  "import", "a.obj",  "bad.obj", "c.obj",
                                        "--root", "lib",    "--unit", "mm"};
  const Outcome outcome = run(all);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.errors, HasSubstr("error: bad.obj has no polygons"));
  EXPECT_TRUE(exists("lib/a/asset.json") && exists("lib/c/asset.json"));
  EXPECT_FALSE(exists("lib/bad") || exists("lib/.bad.importing"));
  const Outcome again = run(all);
  EXPECT_EQ(again.exit_code, 2) << "all failed";
  EXPECT_THAT(again.errors, HasSubstr("a.obj: lib/a exists; choose another name"));
}

TEST_F(AssetVerb, TheUsersOwnLibraryIsWhereAssetsGo) {
  write("part.obj", kTetrahedron);
  const std::string data = "XDG_DATA_HOME=" + (folder_ / "data").string();
  const std::string library = (folder_ / "data/seedframe/assets").string();
  const Outcome imported =
      run({"asset", "import", "part.obj", "--unit", "mm", "--category", "tool"}, {data});
  ASSERT_EQ(imported.exit_code, 0) << imported.errors;
  EXPECT_THAT(imported.output, HasSubstr("asset_folders: [" + library + "]"));
  EXPECT_TRUE(exists("data/seedframe/assets/part/thumbnail.png"));
  const Outcome listed = run({"asset", "list"}, {data});
  EXPECT_THAT(listed.output, ::testing::ContainsRegex("part +tool +4 triangles"));
  EXPECT_THAT(listed.output, ::testing::ContainsRegex("hex_bolt +hex_bolt "));
  EXPECT_THAT(listed.output, ::testing::ContainsRegex("cube +\\(distractor\\)"));
  // A config may read it without being allowed to.
  write("scene.yaml", "seedframe: 1\nasset_folders: [" + library +
                          "]\ncategories: [tool]\nobjects: {p: {asset: part}}\n"
                          "camera: {distance_m: 1}\n");
  const Outcome checked = run({"check", "scene.yaml"}, {data});
  EXPECT_EQ(checked.exit_code, 0) << checked.errors;
  EXPECT_EQ(run({"asset", "check", "part"}, {data}).exit_code, 0);
  const Outcome built_in = run({"asset", "remove", "gear"}, {data});
  EXPECT_EQ(built_in.exit_code, 2) << "the built-in assets are none of the user's";
  EXPECT_EQ(run({"asset", "remove", "part"}, {data}).exit_code, 0);
  EXPECT_FALSE(exists("data/seedframe/assets/part"));
  EXPECT_EQ(run({"asset", "list"}, {data}).exit_code, 0);
}

TEST_F(AssetVerb, RemoveTakesWholeAssetsByName) {
  ASSERT_EQ(import().exit_code, 0);
  ASSERT_EQ(import({"--name", "other"}).exit_code, 0);
  const Outcome wrong = run({"asset", "remove", "part", "othr", "--root", "lib"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("did you mean 'other'?"));
  EXPECT_TRUE(exists("lib/part")) << "with one wrong name, none is removed";
  const Outcome removed = run({"asset", "remove", "part", "--root", "lib"});
  EXPECT_EQ(removed.exit_code, 0) << removed.errors;
  EXPECT_THAT(removed.output, HasSubstr("removed lib/part"));
  EXPECT_EQ(contents("lib").count("other/asset.json"), 1u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "lib"),
                          std::filesystem::directory_iterator()),
            1);
}

TEST_F(AssetVerb, NamesInOtherEncodingsAreNoInternalErrors) {
  write(
      "gr\xF6\xDF"
      "e.obj",
      std::string("mtllib gr\xF6\xDF"
                  "e.mtl\n") +
          kTetrahedron);
  const Outcome imported = run({"asset", "import",
                                "gr\xF6\xDF"
                                "e.obj",
                                "--root", "l\xF6", "--category",
                                "Gr\xF6\xDF"
                                "e",
                                "--description", "\xFF", "--unit", "mm", "--json"});
  ASSERT_EQ(imported.exit_code, 0) << imported.errors;
  const auto json = parse_json(imported.output, "report");
  ASSERT_TRUE(json) << imported.output;
  EXPECT_EQ((*json)[0]["name"], "gr__e");
  EXPECT_EQ((*json)[0]["category"], "Größe");
  EXPECT_EQ((*json)[0]["source"], "größe.obj");
  EXPECT_THAT((*json)[0]["warnings"].dump(), HasSubstr("at 'größe.mtl'"));
  const Outcome listed = run({"asset", "list", "--root", "l\xF6", "--json"});
  EXPECT_EQ(listed.exit_code, 0) << listed.errors;
  EXPECT_TRUE(parse_json(listed.output, "list"));
  EXPECT_EQ(run({"asset", "import", "n\xF6thing.obj", "--root", "lib", "--json"}).exit_code, 2);
}

TEST_F(AssetVerb, UnitsHaveNames) {
  write("part.obj", kTetrahedron);
  for (const auto& [unit, size] :
       std::map<std::string, std::string>{{"mm", "20.0 × 20.0 × 20.0 mm"},
                                          {"cm", "200.0 ×"},
                                          {"m", "20.0 × 20.0 × 20.0 m\n"},
                                          {"in", "508.0 × 508.0 × 508.0 mm"}}) {
    const Outcome outcome = run({"asset", "import", "part.obj", "--dry-run", "--unit", unit});
    EXPECT_THAT(outcome.output, HasSubstr(size));
    EXPECT_THAT(outcome.output, Not(HasSubstr("unit ")));
  }
  const Outcome guessed = run({"asset", "import", "part.obj", "--dry-run"});
  EXPECT_THAT(guessed.output, HasSubstr("unit     metres, as the file does not say"));
  EXPECT_THAT(guessed.output, HasSubstr("if it is in millimetres, --unit mm"));
  EXPECT_EQ(run({"asset", "import", "part.obj", "--unit", "ft"}).exit_code, 2);
  EXPECT_EQ(run({"asset", "import", "part.obj", "--unit", "mm", "--scale", "2"}).exit_code, 2);
}

TEST_F(AssetVerb, WhatIsNoFileIsRefusedAtOnce) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.stl").c_str(), 0600), 0);
  for (const std::string file : {"pipe.stl", "/dev/zero", "/dev/null", "."}) {
    const Outcome outcome = run({"asset", "import", file, "--root", "lib", "--name", "x"});
    EXPECT_EQ(outcome.exit_code, 2) << file;
    EXPECT_THAT(outcome.errors, HasSubstr("cannot read " + file + ": it is a")) << file;
  }
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

TEST_F(AssetVerb, WithJsonAnImportOfSeveralFilesIsOneDocument) {
  write("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write("bad.obj", "v 0 0\n");
  const Outcome outcome =
      run({"asset", "import", "bad.obj", "good.obj", "--root", "lib2", "--json"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.errors;
  const Json reports = Json::parse(outcome.output);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports.at(0).at("file"), "bad.obj");
  EXPECT_EQ(reports.at(0).at("error").at("exit_code"), 2);
  EXPECT_EQ(reports.at(1).at("name"), "good");
}

}  // namespace
}  // namespace seedframe
