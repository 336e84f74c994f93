#include "assets/asset_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assets/asset_check.h"
#include "assets/asset_library.h"
#include "base/canonical_json.h"
#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kFourSides =
    "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\n"
    "usemtl steel\nf 1 3 2\nf 1 2 4\nusemtl paint\nf 1 4 3\nf 2 3 4\n";

class Import : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(write_file(obj(), kFourSides)); }

  fs::path obj() const { return folder_ / "part.obj"; }
  fs::path root() const { return folder_ / "assets"; }

  AssetImport request(const std::string& name) const {
    return {.file = obj(),
            .root = root(),
            .name = name,
            .category = "tetrahedron",
            .description = "",
            .scale = 0.001};
  }

  ScratchFolder folder_;
};

TEST_F(Import, AssetsAreWholeOrNotThere) {
  ASSERT_TRUE(import_asset(request("part")));
  EXPECT_TRUE(fs::exists(root() / "part/thumbnail.png"));
  // A file where the folder should go: it cannot be replaced by one.
  ASSERT_TRUE(write_file(root() / "file", "x"));
  AssetImport wrong = request("file");
  wrong.replace = true;
  EXPECT_FALSE(import_asset(wrong));
  EXPECT_EQ(std::distance(fs::directory_iterator(root()), fs::directory_iterator()), 2);
}

TEST_F(Import, SlotsWithoutTrianglesAreNoObstacle) {
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::string vertices = "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\n";
  for (const std::string& text :
       {vertices + "usemtl none\nusemtl steel\n" + faces + "usemtl none\n",
        vertices + "usemtl steel\n" + faces +
            "usemtl back\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n"}) {
    ASSERT_TRUE(write_file(obj(), text));
    AssetImport again = request("part");
    again.replace = true;
    const auto report = import_asset(again);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_THAT(report->description.slots, ElementsAre("steel"));
    EXPECT_EQ(report->description.repairs.unused_slots, 1u);
    EXPECT_THAT((*AssetLibrary::open({root()})->load("part"))->mesh.slot_names,
                ElementsAre("steel"));
    EXPECT_TRUE(check_asset(root() / "part", {}).empty());
  }
}

TEST_F(Import, AUnitThatNobodySaysIsGuessed) {
  AssetImport guessed = request("part");
  guessed.dry_run = true;
  guessed.scale.reset();
  const auto large = import_asset(guessed);
  EXPECT_TRUE(large->unit_was_guessed);
  EXPECT_THAT(large->warnings, ElementsAre(HasSubstr("20.0 × 20.0 × 20.0 m: the file does not say "
                                                     "its unit, and metres were taken; if it is in "
                                                     "millimetres, --unit mm")));
  guessed.scale = 1.0;
  EXPECT_FALSE(import_asset(guessed)->unit_was_guessed);
  EXPECT_TRUE(import_asset(guessed)->warnings.empty());
}

TEST_F(Import, WhatMayHaveYUpIsTold) {
  AssetImport tall = request("part");
  tall.dry_run = true;
  // Stands on y = 0, in the middle of x and z.
  const std::string standing =
      "v -5 0 -5\nv 5 0 -5\nv 5 0 5\nv -5 0 5\nv 0 40 0\n"
      "f 1 2 3 4\nf 2 1 5\nf 3 2 5\nf 4 3 5\nf 1 4 5\n";
  ASSERT_TRUE(write_file(obj(), standing));
  EXPECT_THAT(import_asset(tall)->warnings,
              ElementsAre(HasSubstr("z was taken for up, but it may be y: it stands on y = 0")));
  ASSERT_TRUE(write_file(obj(), std::string("# Blender 4.5\n") + kFourSides));
  EXPECT_THAT(import_asset(tall)->warnings, ElementsAre(HasSubstr("Blender wrote it")));
  tall.up = UpAxis::kZ;
  EXPECT_TRUE(import_asset(tall)->warnings.empty());
  tall.up.reset();
  ASSERT_TRUE(write_file(obj(), kFourSides));
  EXPECT_TRUE(import_asset(tall)->warnings.empty());
}

TEST_F(Import, FarPartsAreMovedAndMeasuredAgainstTheirFile) {
  std::string text;
  for (const char* corner : {"0 0 0", "20 0 0", "0 20 0", "0 0 20"}) {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    ASSERT_EQ(std::sscanf(corner, "%lf %lf %lf", &x, &y, &z), 3);
    text += fmt::format("v {:.3f} {:.3f} {:.3f}\n", 5e8 + x, 5.4e9 + y, z);
  }
  ASSERT_TRUE(write_file(obj(), text + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
  const auto report = import_asset(request("part"));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->warnings, ElementsAre(HasSubstr("the file has it at (500000.01, 5400000.01, "
                                                      "0.01) m")));
  EXPECT_NEAR((*AssetLibrary::open({root()})->load("part"))->box.size().y(), 0.020, 1e-6);
  const Json json = *parse_json(*read_file(root() / "part/asset.json"), "asset.json");
  EXPECT_NEAR(json["origin_m"][1].get<double>(), 5400000.01, 1e-8);
  EXPECT_TRUE(check_asset(root() / "part", {}).empty());
}

}  // namespace
}  // namespace seedframe
