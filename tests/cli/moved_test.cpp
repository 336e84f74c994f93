// A finished campaign where its config and its assets are not: what needs only frames works as
// before.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class MovedTest : public ProgramTest {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "project/lib");
    fs::copy(fs::path(SEEDFRAME_HOME) / "assets/gear", folder_ / "project/lib/wheel");
    const std::string description = *read_file(folder_ / "project/lib/wheel/asset.json");
    const std::size_t name = description.find("\"name\": \"gear\"");
    ASSERT_NE(name, std::string::npos);
    write("project/lib/wheel/asset.json",
          std::string(description).replace(name, 14, "\"name\": \"wheel\""));
    write("project/scene.yaml", R"(seedframe: 1
scenes: 3
categories: [wheel]
asset_folders: [lib]
labels: geometry
render: {width: 64, height: 48}
objects: {w: {asset: wheel, category: wheel, rotation_deg: [0, 0, {uniform: [0, 360]}]}}
camera: {distance_m: 0.3, elevation_deg: 40}
)");
    ASSERT_EQ(run({"submit", "project/scene.yaml", "-o", "project/c", "--quiet"}).exit_code, 0);
  }
  Outcome export_to(const std::string& campaign, const std::string& folder) {
    return run({"export", campaign, "--format", "coco", "--format", "voc", "-o", folder});
  }
};

TEST_F(MovedTest, ExportsExplanationsAndComparisonsNeedNothingButTheCampaign) {
  ASSERT_EQ(export_to("project/c", "before").exit_code, 0);
  const Outcome explained = run({"explain", "project/c", "1"});
  EXPECT_THAT(explained.output, HasSubstr("w/0"));
  EXPECT_THAT(explained.output, HasSubstr("objects.w.rotation_deg[2]"));
  fs::rename(folder_ / "project/c", folder_ / "c");
  fs::remove_all(folder_ / "project");

  const Outcome exported = export_to("c", "after");
  ASSERT_EQ(exported.exit_code, 0) << exported.errors;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "before")) {
    if (!entry.is_regular_file() || entry.path().filename() == "export.json") continue;
    const fs::path again = folder_ / "after" / fs::relative(entry.path(), folder_ / "before");
    EXPECT_EQ(*read_file(entry.path()), *read_file(again)) << again;
  }
  EXPECT_EQ(status("c").at("done"), 3);
  EXPECT_EQ(run({"compare", "c", "c"}).exit_code, 0);

  const Outcome alone = run({"explain", "c", "1"});
  EXPECT_EQ(alone.exit_code, 0) << alone.errors;
  EXPECT_THAT(alone.output, HasSubstr("w/0"));
  EXPECT_THAT(alone.errors, HasSubstr("the config cannot be read here"));
  EXPECT_THAT(alone.errors, HasSubstr("there is no folder 'lib'"));
  EXPECT_EQ(
      Json::parse(run({"explain", "c", "1", "--json"}).output).at("objects").at(0).at("asset"),
      "wheel");
  EXPECT_EQ(run({"resume", "c"}).exit_code, 2) << "it would expand the config";
}

TEST_F(MovedTest, AnAuditOfItsFilesNeedsNothingButTheCampaign) {
  fs::rename(folder_ / "project/c", folder_ / "c");
  fs::remove_all(folder_ / "project");
  const Outcome whole = run({"audit", "c", "--frames", "0"});
  EXPECT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_THAT(whole.output, HasSubstr("3 frames"));
  EXPECT_THAT(whole.output, HasSubstr("all as they were written"));
  EXPECT_THAT(whole.output, HasSubstr("the config cannot be read here"));
  const Outcome rendering = run({"audit", "c"});
  EXPECT_EQ(rendering.exit_code, 2);
  EXPECT_THAT(rendering.errors, HasSubstr("'--frames 0' reads the campaign's files without it"));

  write("c/frames/000/000001/labels.json", "{}");
  const Outcome damaged = run({"audit", "c", "--frames", "0"});
  EXPECT_EQ(damaged.exit_code, 5);
  EXPECT_THAT(damaged.output, HasSubstr("frame 1: "));
}

TEST_F(MovedTest, ACampaignThatNobodyMayWriteToIsRead) {
  if (std::system("unshare --mount true 2>/dev/null") != 0) {
    GTEST_SKIP() << "only root can make a folder that root cannot write to";
  }
  const auto read_only = [this](const std::string& words) {
    const std::string script = fmt::format(
        "cd '{}' && mount --bind project/c project/c && mount -o remount,bind,ro project/c && '{}' "
        "{} >>out 2>&1",
        folder_.string(), SEEDFRAME_PROGRAM, words);
    write("script", script);
    return std::system(("unshare --mount sh '" + (folder_ / "script").string() + "'").c_str());
  };
  EXPECT_EQ(read_only("status project/c"), 0);
  EXPECT_EQ(read_only("explain project/c 1"), 0);
  EXPECT_EQ(read_only("compare project/c project/c"), 0);
  EXPECT_EQ(read_only("export project/c --format coco -o elsewhere"), 0);
  EXPECT_EQ(read_only("audit project/c --frames 0 -o report"), 0);
  EXPECT_TRUE(fs::exists(folder_ / "report/report.md"));
  EXPECT_NE(read_only("audit project/c --frames 0"), 0);
  EXPECT_THAT(*read_file(folder_ / "out"), HasSubstr("-o names another place"));
}

TEST_F(MovedTest, MoreScenesAreMoreFramesOfTheSameCampaign) {
  const Outcome fewer = run({"resume", "project/c", "--set", "scenes=2"});
  EXPECT_EQ(fewer.exit_code, 2);
  EXPECT_THAT(fewer.errors, HasSubstr("the campaign has 3 frames, its config asks for 2 now"));
  const Outcome outcome = run({"resume", "project/c", "--set", "scenes=5"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("2 frames are new"));
  EXPECT_THAT(outcome.output, HasSubstr("5 of 5 frames are done (2 in this run"));
  EXPECT_THAT(run({"resume", "project/c"}).output, HasSubstr("(0 in this run"))
      << "it is remembered";
  ASSERT_EQ(run({"submit", "project/scene.yaml", "-o", "whole", "--quiet", "--set", "scenes=5"})
                .exit_code,
            0);
  EXPECT_EQ(status("project/c").at("dataset_hash"), status("whole").at("dataset_hash"));
}

TEST_F(MovedTest, ADamagedCopyIsNamed) {
  write("project/c/inputs/inputs.json", "{\"seedframe_inputs\": 1}");
  const Outcome outcome = export_to("project/c", "e");
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.errors, HasSubstr("inputs/inputs.json is not as Seedframe writes it"));
}

}  // namespace
}  // namespace seedframe
