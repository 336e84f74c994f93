#include "annotate/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "annotate/extents.h"
#include "tests/annotate/mask_cases.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kCategories = {"cube", "nut", "bolt", "gear"};

InstanceSpec instance(std::string name, int id, int category) {
  InstanceSpec spec;
  spec.name = std::move(name);
  spec.id = id;
  spec.category = category;
  return spec;
}

FrameSpec spec_of(int width, int height, std::vector<InstanceSpec> instances) {
  FrameSpec spec;
  spec.render.width = width;
  spec.render.height = height;
  spec.instances = std::move(instances);
  return spec;
}

/// A 4x3 frame: 5 has an L of three pixels, 2 one pixel in the corner, 9 none.
struct SmallFrame {
  FrameSpec spec = spec_of(4, 3,
                           {instance("ground/0", 0, 0), instance("nut/0", 5, 2),
                            instance("cube/0", 9, 1), instance("rock/0", 2, 0)});
  IdImage ids{4, 3};
  SmallFrame() {
    ids.at(0, 1) = ids.at(1, 1) = ids.at(1, 2) = 5;
    ids.at(2, 3) = 2;
  }
};

TEST(MakeLabels, MeasuresEveryInstanceInTheOrderOfTheSpec) {
  const SmallFrame frame;
  const auto labels = make_labels(frame.spec, kCategories, frame.ids);
  ASSERT_TRUE(labels) << labels.error().message;
  EXPECT_EQ(labels->width, 4);
  EXPECT_EQ(labels->height, 3);
  ASSERT_EQ(labels->instances.size(), 3U);  // the ground has no id
  const InstanceLabel& nut = labels->instances[0];
  EXPECT_EQ(nut.name, "nut/0");
  EXPECT_EQ(nut.id, 5);
  EXPECT_EQ(nut.category, 2);
  EXPECT_EQ(nut.area_px, 3);
  EXPECT_EQ(nut.box, (PixelRect{1, 0, 2, 2}));
  const InstanceLabel& hidden = labels->instances[1];
  EXPECT_EQ(hidden.id, 9);
  EXPECT_EQ(hidden.area_px, 0);
  EXPECT_EQ(hidden.box, PixelRect{});
  EXPECT_EQ(labels->instances[2].box, (PixelRect{3, 2, 1, 1}));
}

TEST(MakeLabels, NamesAnUnknownIdAndItsFirstPixel) {
  SmallFrame frame;
  frame.ids.at(1, 3) = 77;
  frame.ids.at(2, 0) = 77;
  const auto labels = make_labels(frame.spec, kCategories, frame.ids);
  ASSERT_FALSE(labels);
  EXPECT_EQ(labels.error().kind, ErrorKind::kRender);
  EXPECT_THAT(labels.error().message, HasSubstr("id 77"));
  EXPECT_THAT(labels.error().message, HasSubstr("row 1, column 3"));
}

TEST(MakeLabels, RefusesAnImageOfAnotherSize) {
  SmallFrame frame;
  frame.spec.render.width = 5;
  const auto labels = make_labels(frame.spec, kCategories, frame.ids);
  ASSERT_FALSE(labels);
  EXPECT_EQ(labels.error().kind, ErrorKind::kRender);
  EXPECT_THAT(labels.error().message, HasSubstr("4x3"));
}

TEST(MakeLabels, RefusesTwoInstancesWithOneId) {
  SmallFrame frame;
  frame.spec.instances.push_back(instance("bolt/3", 5, 1));
  const auto labels = make_labels(frame.spec, kCategories, frame.ids);
  ASSERT_FALSE(labels);
  EXPECT_THAT(labels.error().message, HasSubstr("'nut/0'"));
  EXPECT_THAT(labels.error().message, HasSubstr("'bolt/3'"));
}

TEST(MakeLabels, HoldsTheLargestId) {
  IdImage ids(2, 1);
  ids.at(0, 1) = 65535;
  const auto labels = make_labels(spec_of(2, 1, {instance("a/0", 65535, 1)}), kCategories, ids);
  ASSERT_TRUE(labels);
  EXPECT_EQ(labels->instances[0].area_px, 1);
}

TEST(MeasureExtents, AgreesWithCountingEachIdByItself) {
  std::mt19937_64 random(5);
  IdImage ids(37, 29);
  for (auto& value : ids.values) value = static_cast<std::uint16_t>(random() % 12);
  const auto extents = measure_extents(ids);
  ASSERT_EQ(extents.size(), 11U);
  for (const InstanceExtent& extent : extents) {
    int area = 0, left = 99, top = 99, right = -1, bottom = -1;
    for (int row = 0; row < ids.height; ++row) {
      for (int column = 0; column < ids.width; ++column) {
        if (ids.at(row, column) != extent.id) continue;
        if (area == 0) {
          EXPECT_EQ(extent.first_row, row);
          EXPECT_EQ(extent.first_column, column);
        }
        ++area;
        left = std::min(left, column);
        right = std::max(right, column);
        top = std::min(top, row);
        bottom = std::max(bottom, row);
      }
    }
    EXPECT_EQ(extent.area_px, area);
    EXPECT_EQ(extent.box, (PixelRect{left, top, right - left + 1, bottom - top + 1}));
  }
}

TEST(SemanticImage, HoldsCategoriesAndZeroForDistractors) {
  const SmallFrame frame;
  const Image<std::uint8_t> semantic = semantic_image(frame.spec, frame.ids);
  EXPECT_EQ(semantic.values, (std::vector<std::uint8_t>{0, 2, 0, 0,  //
                                                        0, 2, 2, 0,  //
                                                        0, 0, 0, 0}));
}

Json small_json() {
  SmallFrame frame;
  frame.spec.camera.focal_px = {100, 101};
  frame.spec.camera.center_px = {2, 1};
  frame.spec.instances[1].asset = "hex_nut";
  auto labels = make_labels(frame.spec, kCategories, frame.ids);
  labels->instances[0].keypoints = {{"bore", {1.5, 0.25}, Visibility::kHidden}};
  return to_json(*labels);
}

TEST(LabelsJson, IsPinned) {
  EXPECT_EQ(canonical_json(small_json()),
            R"({"camera":{"center_px":[2,1],"focal_px":[100,101]},)"
            R"("categories":["cube","nut","bolt","gear"],"height":3,"instances":[)"
            R"({"area_px":3,"asset":"hex_nut","box":[1,0,2,2],"category":2,"id":5,)"
            R"("keypoints":[{"name":"bore","px":[1.5,0.25],"visibility":1}],"name":"nut/0"},)"
            R"({"area_px":0,"asset":"","box":[0,0,0,0],"category":1,"id":9,"name":"cube/0"},)"
            R"({"area_px":1,"asset":"","box":[3,2,1,1],"category":0,"id":2,"name":"rock/0"}],)"
            R"("twin_exact":true,"version":3,"width":4})");
}

TEST(LabelsJson, ReadsBackWhatWasWritten) {
  const auto parsed = parse_json(readable_json(small_json()), "labels.json");
  ASSERT_TRUE(parsed);
  const auto labels = labels_from_json(*parsed, "labels.json");
  ASSERT_TRUE(labels) << labels.error().message;
  ASSERT_EQ(labels->instances.size(), 3U);
  EXPECT_EQ(to_json(*labels), small_json());
}

TEST(LabelsJson, ANewerVersionIsNamed) {
  Json json = small_json();
  json["version"] = 4;
  const auto labels = labels_from_json(json, "labels.json");
  ASSERT_FALSE(labels);
  EXPECT_EQ(labels.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(labels.error().message, HasSubstr("version 4"));
  EXPECT_THAT(labels.error().message, HasSubstr("reads version 3"));
}

TEST(LabelsJson, EveryMissingKeyIsNamed) {
  for (const std::string key :
       {"version", "width", "height", "twin_exact", "instances", "categories", "camera"}) {
    Json json = small_json();
    ASSERT_EQ(json.erase(key), 1U);
    const auto labels = labels_from_json(json, "f/labels.json");
    ASSERT_FALSE(labels) << key;
    EXPECT_EQ(labels.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(labels.error().message, HasSubstr("f/labels.json"));
    EXPECT_THAT(labels.error().message, HasSubstr("'" + key + "'"));
  }
  for (const std::string key : {"id", "category", "name", "asset", "area_px", "box"}) {
    Json json = small_json();
    ASSERT_EQ(json["instances"][1].erase(key), 1U);
    const auto labels = labels_from_json(json, "f/labels.json");
    ASSERT_FALSE(labels) << key;
    EXPECT_THAT(labels.error().message, HasSubstr("instances[1]"));
    EXPECT_THAT(labels.error().message, HasSubstr("'" + key + "'"));
  }
}

TEST(LabelsJson, EveryWrongTypeIsAnError) {
  const std::vector<Json> wrong = {
      nullptr, true, -1, 1.5, "7", Json::array({1}), Json::object(), 18446744073709551615ULL};
  const Json good = small_json();
  for (const auto& [key, value] : good.items()) {
    for (const Json& replacement : wrong) {
      if (key == "twin_exact" && replacement.is_boolean()) continue;
      Json json = small_json();
      json[key] = replacement;
      EXPECT_FALSE(labels_from_json(json, "labels.json")) << key << " " << replacement;
    }
  }
  for (const auto& [key, value] : good["instances"][0].items()) {
    for (const Json& replacement : wrong) {
      if ((key == "name" || key == "asset") && replacement.is_string()) continue;
      if (key == "keypoints" && replacement.empty()) continue;  // there may be none
      Json json = small_json();
      json["instances"][0][key] = replacement;
      EXPECT_FALSE(labels_from_json(json, "labels.json")) << key << " " << replacement;
    }
  }
  for (const Json& replacement : wrong) {
    EXPECT_FALSE(labels_from_json(replacement, "labels.json")) << replacement;
    Json json = small_json();
    json["instances"][0] = replacement;
    EXPECT_FALSE(labels_from_json(json, "labels.json")) << replacement;
  }
}

TEST(LabelsJson, ImpossibleBoxesAndAreasAreErrors) {
  const auto refuses = [](const char* key, const Json& value) {
    Json json = small_json();
    json["instances"][0][key] = value;
    return !labels_from_json(json, "labels.json").has_value();
  };
  EXPECT_FALSE(refuses("area_px", 4));
  EXPECT_TRUE(refuses("area_px", 5));                    // more than the box holds
  EXPECT_TRUE(refuses("area_px", 0));                    // but with a box
  EXPECT_TRUE(refuses("box", {1, 0, 4, 2}));             // over the right border
  EXPECT_TRUE(refuses("box", {1, 2, 2, 2}));             // over the lower border
  EXPECT_TRUE(refuses("box", {-1, 0, 2, 2}));            //
  EXPECT_TRUE(refuses("box", {1, 0, 0, 2}));             //
  EXPECT_TRUE(refuses("box", {1, 0, 2}));                //
  EXPECT_TRUE(refuses("box", {1, 0, 2, 2.5}));           //
  EXPECT_TRUE(refuses("box", {2147483647, 0, 2, 2}));    // a sum that would overflow
  EXPECT_TRUE(refuses("box", {1, 0, 2, 4294967298LL}));  // 2, if cut to 32 bits
  EXPECT_TRUE(refuses("id", 9));                         // twice in the frame
  EXPECT_TRUE(refuses("id", 0));
  EXPECT_TRUE(refuses("id", 65536));
}

}  // namespace
}  // namespace seedframe
