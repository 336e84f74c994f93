#include "formats/bop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/bop_models.h"
#include "tests/export/synthetic_dataset.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ExportBop : public ::testing::Test {
 protected:
  ExportBop() {
    // Silhouettes are boxes: of the first bolt a diagonal is seen, of the gear 16 of 20 pixels.
    IdImage ids(32, 24);
    for (int i = 0; i < 20; ++i) ids.at(i, 2 + i) = 3;
    for (int row = 18; row < 22; ++row) {
      for (int column = 0; column < 4; ++column) ids.at(row, column) = 40;
    }
    campaign_.add_frame(41, 5, ids);
    for (const char* name : {"bolt", "gear"}) {
      auto asset = std::make_shared<Asset>();
      asset->name = name;
      asset->mesh.positions = {{0, 0, 0}, {0.1F, 0, 0}, {0, 0.2F, 0}};
      asset->mesh.triangles = {{0, 1, 2}};
      campaign_.dataset().assets.push_back({asset, {}});
    }
  }
  Json read(const ExportSummary& summary, const std::string& path) const {
    return *parse_json(*read_file(summary.folder / path), path);
  }

  ScratchFolder scratch_;
  SyntheticDataset campaign_{scratch_.path() / "campaign"};
};

TEST_F(ExportBop, IgnoresAndDoesNotAskForWhatIsHardlySeen) {
  const auto summary = export_one(campaign_.dataset(), "bop", {.output = scratch_.path() / "out"});
  ASSERT_TRUE(summary) << summary.error().message;
  const Json coco = read(*summary, "train/000005/scene_gt_coco.json");
  const Json& annotations = coco["annotations"];
  ASSERT_EQ(annotations.size(), 2U);
  EXPECT_EQ(annotations[0]["ignore"], true);
  EXPECT_EQ(annotations[0]["area"], 20);
  EXPECT_EQ(annotations[0]["bbox"], Json({1, 0, 21, 20}));  // of the silhouette
  EXPECT_EQ(annotations[1]["ignore"], false);
  EXPECT_EQ(annotations[1]["bbox"], Json({0, 18, 4, 4}));  // a column of it is outside the image
  EXPECT_EQ(annotations[1]["width"], 32);
  EXPECT_EQ(annotations[1]["height"], 24);
  EXPECT_EQ(read(*summary, "train_targets_bop19.json"),
            Json::array({{{"im_id", 41}, {"inst_count", 1}, {"obj_id", 2}, {"scene_id", 5}}}));
}

TEST_F(ExportBop, HasTheCameraOfItsFirstFrame) {
  const fs::path path = campaign_.frame_folder(41) / frame_files::kLabels;
  Json labels = *parse_json(*read_file(path), "labels");
  labels["camera"] = {{"center_px", {15.5, 11.5}}, {"focal_px", {40.5, 41.5}}};
  ASSERT_TRUE(write_quickly(path, readable_json(labels)));
  campaign_.write_manifest(campaign_.frames()[0]);
  const auto summary = export_one(campaign_.dataset(), "bop", {.output = scratch_.path() / "out"});
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(
      read(*summary, "camera.json"),
      Json(
          {{"width", 32}, {"height", 24}, {"fx", 40.5}, {"fy", 41.5}, {"cx", 15.5}, {"cy", 11.5}}));
  EXPECT_THAT(summary->warnings, ElementsAre(HasSubstr("render: {passes: [depth]}")));
}

/// Corner i has its x, y and z from the bits of i.
Mesh cube() {
  Mesh mesh;
  for (const int corner : {0, 1, 2, 3, 4, 5, 6, 7}) {
    mesh.positions.push_back({static_cast<float>(corner & 1), static_cast<float>(corner >> 1 & 1),
                              static_cast<float>(corner >> 2)});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

int vertices_of(const std::string& ply) {
  return std::stoi(ply.substr(ply.find("element vertex ") + 15));
}

TEST(BopModels, HaveAVertexForEachNormal) {
  auto asset = std::make_shared<Asset>();
  asset->name = "cube";
  asset->mesh = cube();
  CommonPart flat;
  add_bop_models({{asset, {}}}, flat);
  EXPECT_EQ(vertices_of(flat.files.at("models/obj_000001.ply")), 24);
  auto smooth = std::make_shared<Asset>(*asset);
  smooth->mesh.smooth_angle_rad = 3.0;
  CommonPart round;
  add_bop_models({{smooth, {}}}, round);
  EXPECT_EQ(vertices_of(round.files.at("models/obj_000001.ply")), 8);
}

TEST(BopModels, HaveANormalOfLengthOneWhereATriangleHasNoArea) {
  auto asset = std::make_shared<Asset>();
  asset->name = "sliver";
  asset->mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  asset->mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  CommonPart common;
  add_bop_models({{asset, {}}}, common);
  const std::string& ply = common.files.at("models/obj_000001.ply");
  const char* vertices = ply.data() + ply.find("end_header\n") + 11;
  for (int i = 0; i < vertices_of(ply); ++i) {
    std::array<float, 6> numbers{};
    std::memcpy(numbers.data(), vertices + 24 * i, sizeof numbers);
    EXPECT_EQ(std::abs(numbers[5]), 1.0F) << "vertex " << i;
  }
}

TEST(BopModels, SayAfterWhichRotationsAModelLooksTheSame) {
  auto asset = std::make_shared<Asset>();
  asset->name = "cube";
  asset->mesh = cube();
  for (auto& position : asset->mesh.positions) position[0] += 3.0F;  // far from its origin
  CommonPart common;
  add_bop_models({{asset, {}}}, common);
  const Json info = parse_json(common.files.at("models/models_info.json"), "info")->at("1");
  EXPECT_FALSE(info.contains("symmetries_continuous"));
  const auto matrices = info.at("symmetries_discrete").get<std::vector<std::vector<double>>>();
  ASSERT_EQ(matrices.size(), 23U);
  for (const std::vector<double>& matrix : matrices) {
    ASSERT_EQ(matrix.size(), 16U);
    for (const std::array<float, 3>& vertex : asset->mesh.positions) {
      // Each vertex comes to lie on a vertex, in millimetres.
      std::array<double, 3> turned{};
      for (std::size_t row = 0; row < 3; ++row) {
        turned[row] = matrix[4 * row + 3];
        for (std::size_t i = 0; i < 3; ++i) turned[row] += 1000.0 * matrix[4 * row + i] * vertex[i];
      }
      const bool on_vertex = std::any_of(asset->mesh.positions.begin(), asset->mesh.positions.end(),
                                         [&](const auto& other) {
                                           return std::abs(turned[0] - 1000.0 * other[0]) < 0.01 &&
                                                  std::abs(turned[1] - 1000.0 * other[1]) < 0.01 &&
                                                  std::abs(turned[2] - 1000.0 * other[2]) < 0.01;
                                         });
      EXPECT_TRUE(on_vertex) << turned[0] << " " << turned[1] << " " << turned[2];
    }
  }
}

}  // namespace
}  // namespace seedframe
