#include "assets/asset_library.h"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assets/asset_check.h"
#include "assets/asset_import.h"
#include "base/canonical_json.h"
#include "base/files.h"
#include "base/portable_math.h"
#include "base/sha256.h"
#include "mesh/mesh_buffer.h"
#include "tests/fixtures/message_of.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\n"
    "usemtl steel\nf 1 3 2\nf 1 2 4\nusemtl paint\nf 1 4 3\nf 2 3 4\n";

class Library : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(write_file(obj(), kTetrahedron)); }

  fs::path obj() const { return folder_ / "part.obj"; }
  fs::path root() const { return folder_ / "assets"; }

  AssetImport request(const std::string& name) const {
    return {.file = obj(),
            .root = root(),
            .name = name,
            .category = "tetrahedron",
            .description = "Four sides",
            .scale = 0.001,
            .smooth_angle_deg = 35.0};
  }

  std::shared_ptr<const Asset> load(const std::string& name) const {
    const auto library = AssetLibrary::open({root()});
    EXPECT_TRUE(library);
    const auto asset = library->load(name);
    EXPECT_TRUE(asset) << asset.error().message;
    return asset ? *asset : nullptr;
  }

  // Loads after one key of asset.json has been changed.
  Error error_after_setting(const std::string& key, const Json& value) {
    EXPECT_TRUE(import_asset(request("part")).has_value() || fs::exists(root() / "part"));
    const fs::path path = root() / "part" / "asset.json";
    const std::string before = *read_file(path);
    Json json = *parse_json(before, "asset.json");
    if (key.starts_with('/')) {
      json[Json::json_pointer(key)] = value;
    } else {
      json[key] = value;
      if (value.is_null()) json.erase(key);
    }
    EXPECT_TRUE(write_file(path, readable_json(json)));
    const auto asset = AssetLibrary::open({root()})->load("part");
    EXPECT_FALSE(asset) << key;
    EXPECT_TRUE(write_file(path, before));
    return asset ? Error{} : asset.error();
  }

  ScratchFolder folder_;
};

TEST_F(Library, ImportedAssetsAreMeasuredInMetres) {
  ASSERT_TRUE(import_asset(request("part")));
  const auto asset = load("part");
  ASSERT_NE(asset, nullptr);
  EXPECT_EQ(asset->name, "part");
  EXPECT_EQ(asset->category, "tetrahedron");
  EXPECT_EQ(asset->description, "Four sides");
  EXPECT_EQ(asset->mesh.triangles.size(), 4u);
  EXPECT_THAT(asset->mesh.slot_names, ElementsAre("steel", "paint"));
  EXPECT_NEAR(asset->box.size().x(), 0.020, 1e-6);
  EXPECT_DOUBLE_EQ(asset->mesh.smooth_angle_rad, portable::radians(35.0));
  EXPECT_NEAR(asset->lowest_z(-Eigen::Matrix3d::Identity()), -0.020, 1e-6);
  EXPECT_EQ(asset->buffer, mesh_buffer(asset->mesh));
  EXPECT_EQ(asset->buffer_sha256, sha256_hex(asset->buffer));
}

TEST_F(Library, ImportingTwiceGivesTheSameBytes) {
  ASSERT_TRUE(import_asset(request("part")));
  const std::string mesh = *read_file(root() / "part" / "mesh.drc");
  const std::string description = *read_file(root() / "part" / "asset.json");
  AssetImport again = request("part");
  EXPECT_FALSE(import_asset(again)) << "an asset must not be replaced unasked";
  again.replace = true;
  ASSERT_TRUE(import_asset(again));
  EXPECT_EQ(*read_file(root() / "part" / "mesh.drc"), mesh);
  EXPECT_EQ(*read_file(root() / "part" / "asset.json"), description);
  EXPECT_THAT(description, HasSubstr("\"source\": \"part.obj\""));
}

TEST_F(Library, AFailedImportLeavesTheOldAsset) {
  ASSERT_TRUE(import_asset(request("part")));
  ASSERT_TRUE(write_file(obj(), "v 0 0 0\n"));
  AssetImport again = request("part");
  again.replace = true;
  EXPECT_FALSE(import_asset(again));
  EXPECT_EQ(load("part")->mesh.triangles.size(), 4u);
}

TEST_F(Library, RefusesImportsThatMakeNoSense) {
  for (const char* name : {"", "..", "a/b", ".hidden", "two words", "é"}) {
    EXPECT_FALSE(import_asset(request(name))) << name;
  }
  for (const double scale : {0.0, -1.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    AssetImport wrong = request("part");
    wrong.scale = scale;
    EXPECT_FALSE(import_asset(wrong)) << scale;
  }
  AssetImport wrong = request("part");
  wrong.smooth_angle_deg = 181.0;
  EXPECT_FALSE(import_asset(wrong));
  EXPECT_FALSE(fs::exists(root() / "part"));
}

TEST_F(Library, ListsAssetsOfAllRootsAndTheFirstRootWins) {
  ASSERT_TRUE(import_asset(request("part")));
  ASSERT_TRUE(import_asset(request("bolt")));
  AssetImport other = request("part");
  other.root = folder_ / "other";
  other.category = "another";
  ASSERT_TRUE(import_asset(other));
  other.name = "gear";
  ASSERT_TRUE(import_asset(other));
  fs::create_directories(root() / "no_asset");
  fs::create_directories(root() / ".part.importing");

  const auto library = AssetLibrary::open({root(), folder_ / "other"});
  ASSERT_TRUE(library) << library.error().message;
  EXPECT_THAT(library->names(), ElementsAre("bolt", "gear", "part"));
  EXPECT_EQ((*library->load("part"))->category, "tetrahedron");
  EXPECT_EQ((*library->load("gear"))->category, "another");
}

TEST_F(Library, UnknownNamesGetTheNearestOne) {
  ASSERT_TRUE(import_asset(request("hex_bolt")));
  const auto asset = AssetLibrary::open({root()})->load("hex_blot");
  ASSERT_FALSE(asset);
  EXPECT_EQ(asset.error().kind, ErrorKind::kInput);
  EXPECT_THAT(asset.error().message, HasSubstr("did you mean 'hex_bolt'?"));
}

TEST_F(Library, AMissingRootIsAnError) {
  const auto library = AssetLibrary::open({folder_ / "nowhere"});
  ASSERT_FALSE(library);
  EXPECT_EQ(library.error().kind, ErrorKind::kInput);
  EXPECT_FALSE(AssetLibrary::open({obj()})) << "a file is no folder";
}

TEST_F(Library, ADamagedMeshIsAnErrorWhateverTheDamage) {
  ASSERT_TRUE(import_asset(request("part")));
  const fs::path path = root() / "part" / "mesh.drc";
  const std::string stream = *read_file(path);
  std::string flipped = stream;
  flipped[stream.size() / 2] = static_cast<char>(flipped[stream.size() / 2] ^ 1);
  for (const std::string& damaged :
       {stream.substr(0, stream.size() - 1), stream + '\0', flipped, std::string()}) {
    ASSERT_TRUE(write_file(path, damaged));
    const auto asset = AssetLibrary::open({root()})->load("part");
    ASSERT_FALSE(asset);
    EXPECT_EQ(asset.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(asset.error().message, HasSubstr("mesh.drc is damaged"));
  }
  fs::remove(path);
  EXPECT_FALSE(AssetLibrary::open({root()})->load("part"));
}

TEST_F(Library, ADamagedDescriptionIsAnErrorThatNamesTheKey) {
  EXPECT_THAT(error_after_setting("version", 3).message, HasSubstr("use a newer Seedframe"));
  EXPECT_THAT(error_after_setting("version", 1).message, HasSubstr("import the asset again"));
  EXPECT_THAT(error_after_setting("version", "1").message, HasSubstr("'version'"));
  EXPECT_THAT(error_after_setting("category", nullptr).message, HasSubstr("'category' is missing"));
  EXPECT_THAT(error_after_setting("name", "gear").message, HasSubstr("named 'gear'"));
  EXPECT_THAT(error_after_setting("/levels/0/triangles", 5).message, HasSubstr("says 5 triangles"));
  EXPECT_THAT(error_after_setting("slots", Json::array()).message, HasSubstr("'slots'"));
  EXPECT_THAT(error_after_setting("slots", Json::array({"steel"})).message,
              HasSubstr("2 material"));
  EXPECT_THAT(error_after_setting("levels", Json::array()).message, HasSubstr("'levels'"));
  EXPECT_THAT(error_after_setting("/levels/0/file", "../x.drc").message, HasSubstr("mesh.drc"));
  EXPECT_THAT(error_after_setting("/measures/size_m", Json::array({1})).message,
              HasSubstr("'size_m'"));
  EXPECT_THAT(error_after_setting("slots", 3).message, HasSubstr("'slots'"));
  EXPECT_THAT(error_after_setting("smooth_angle_deg", 999).message, HasSubstr("smooth_angle_deg"));
  EXPECT_EQ(error_after_setting("/levels/0/sha256", "00").kind, ErrorKind::kCorrupt);
}

TEST_F(Library, EveryTruncationOfTheDescriptionIsAnError) {
  ASSERT_TRUE(import_asset(request("part")));
  const fs::path path = root() / "part" / "asset.json";
  const std::string text = *read_file(path);
  // The last byte is a newline, without which the JSON is whole.
  for (std::size_t length = 0; length + 1 < text.size(); length += 7) {
    ASSERT_TRUE(write_file(path, std::string_view(text).substr(0, length)));
    EXPECT_FALSE(AssetLibrary::open({root()})->load("part")) << length;
  }
}

// A bumpy ball of 2048 triangles, 2 m across: enough to have coarser levels.
void write_ball(const fs::path& path) {
  constexpr int kRings = 32;
  std::string text;
  for (int j = 0; j <= kRings; ++j) {
    for (int i = 0; i < kRings; ++i) {
      const double a = 2.0 * M_PI * i / kRings;
      const double b = M_PI * (j + 0.5) / (kRings + 1);
      const double r = 1.0 + 0.03 * std::sin(5.0 * a) * std::sin(3.0 * b);
      text += fmt::format("v {} {} {}\n", r * std::sin(b) * std::cos(a),
                          r * std::sin(b) * std::sin(a), r * std::cos(b));
    }
  }
  for (int j = 0; j < kRings; ++j) {
    for (int i = 0; i < kRings; ++i) {
      const int here = j * kRings + i + 1;
      const int next = j * kRings + (i + 1) % kRings + 1;
      text += fmt::format("f {} {} {} {}\n", here, here + kRings, next + kRings, next);
    }
  }
  ASSERT_TRUE(write_file(path, text));
}

TEST_F(Library, LevelsOfDetailAreReadOnDemandAndKept) {
  write_ball(obj());
  AssetImport ball = request("ball");
  ball.scale = 0.1;
  const auto report = import_asset(ball);
  ASSERT_TRUE(report) << report.error().message;
  const auto& levels = report->description.levels;
  ASSERT_GE(levels.size(), 3u);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    EXPECT_LE(levels[k].error_m, levels[k].bound_m) << k;
    EXPECT_NEAR(levels[k].bound_m, 0.2 / (20.0 * levels[k].pixels), 0.02 * levels[k].bound_m) << k;
    if (k > 0) {
      EXPECT_LE(levels[k].triangles, 0.8 * levels[k - 1].triangles) << k;
    }
  }
  const auto library = AssetLibrary::open({root()});
  ASSERT_TRUE(library);
  const auto asset = *library->load("ball");
  ASSERT_EQ(asset->levels.size(), levels.size());
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const auto level = library->load_level("ball", k);
    ASSERT_TRUE(level) << level.error().message;
    EXPECT_EQ((*level)->mesh.triangles.size(), asset->levels[k].triangles);
    EXPECT_EQ((*level)->mesh.slot_names, asset->mesh.slot_names);
    EXPECT_EQ(level->get(), library->load_level("ball", k)->get());
  }
  EXPECT_EQ((*library->load_level("ball", 0))->buffer_sha256, asset->buffer_sha256);
  EXPECT_EQ(library->load_level("ball", levels.size()).error().kind, ErrorKind::kInput);
  EXPECT_TRUE(check_asset(root() / "ball", {.thorough = true}).empty());
}

TEST_F(Library, ChecksNameEveryFaultOfAnAsset) {
  write_ball(obj());
  AssetImport ball = request("ball");
  ball.levels.pixels = 64.0;
  ASSERT_TRUE(import_asset(ball));
  const fs::path folder = root() / "ball";
  EXPECT_TRUE(check_asset(folder, {}).empty());
  const std::string before = *read_file(folder / "asset.json");
  Json json = *parse_json(before, "asset.json");
  json["/levels/1/error_m"_json_pointer] = 1e-7;
  json["/measures/volume_m3"_json_pointer] = 1.0;
  json["/measures/genus"_json_pointer] = 3;
  json["/levels/1/vertices"_json_pointer] = 7;
  ASSERT_TRUE(write_file(folder / "asset.json", readable_json(json)));
  const auto faults = check_asset(folder, {});
  EXPECT_THAT(faults,
              testing::UnorderedElementsAre(HasSubstr("'error_m'"), HasSubstr("'volume_m3'"),
                                            HasSubstr("'genus'"), HasSubstr("'vertices'")));
  ASSERT_TRUE(write_file(folder / "asset.json", before));
  ASSERT_TRUE(write_file(folder / "lod1.drc", "DRACO"));
  EXPECT_THAT(check_asset(folder, {}), ElementsAre(HasSubstr("lod1.drc is damaged")));
}

TEST_F(Library, ADryRunWritesNothing) {
  AssetImport dry = request("part");
  dry.dry_run = true;
  const auto report = import_asset(dry);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->description.levels[0].triangles, 4u);
  EXPECT_FALSE(fs::exists(root()));
}

TEST_F(Library, WarnsOfSizesThatAreUnlikelyAndOfOpenSurfaces) {
  AssetImport large = request("part");
  large.dry_run = true;
  large.scale = 50.0;
  EXPECT_THAT(import_asset(large)->warnings, ElementsAre(HasSubstr("try --scale 0.05")));
  ASSERT_TRUE(write_file(obj(), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_THAT(import_asset(large)->warnings, ElementsAre(HasSubstr("open (3 border edges)")));
}

TEST_F(Library, FineViewsGetMoreBitsACoordinate) {
  AssetImport fine = request("part");
  fine.dry_run = true;
  EXPECT_EQ(import_asset(fine)->description.levels[0].position_bits, 16);
  fine.levels.pixels = 16384.0;
  const auto report = import_asset(fine);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->description.levels[0].position_bits, 19);
  EXPECT_LE(report->description.levels[0].error_m, report->description.levels[0].bound_m);
}

TEST_F(Library, FilesThatLeadOutOfItAreRefused) {
  ASSERT_TRUE(import_asset(request("part")));
  fs::rename(root() / "part", folder_ / "elsewhere");
  const auto reason = [&] {
    const auto asset = AssetLibrary::open({root()})->load("part");
    return message_of(asset);
  };
  for (const char* name : {"mesh.drc", "asset.json", "thumbnail.png"}) {
    fs::remove_all(root() / "part");
    fs::copy(folder_ / "elsewhere", root() / "part");
    EXPECT_EQ(reason(), "(no error)");
    fs::remove(root() / "part" / name);
    fs::create_symlink(folder_ / "elsewhere/asset.json", root() / "part" / name);
    EXPECT_THAT(reason(), HasSubstr("outside of the folders that may be read")) << name;
    EXPECT_FALSE(AssetLibrary::open({root()})->folder("part")) << name;
  }
  fs::remove_all(root() / "part");
  fs::create_directory_symlink(folder_ / "elsewhere", root() / "part");
  EXPECT_THAT(reason(), HasSubstr((folder_ / "elsewhere").string()));
  fs::remove(root() / "part");
  fs::rename(folder_ / "elsewhere", root() / "other");
  fs::create_directory_symlink("other", root() / "part");
  EXPECT_EQ(reason(), "(no error)") << "it leads to another part of the library";
}

TEST_F(Library, FilesMayLieInAnotherAllowedFolder) {
  ASSERT_TRUE(import_asset(request("part")));
  fs::rename(root() / "part/mesh.drc", folder_ / "shared.drc");
  fs::create_symlink(folder_ / "shared.drc", root() / "part/mesh.drc");
  EXPECT_FALSE(AssetLibrary::open({root()})->load("part"));
  EXPECT_TRUE(AssetLibrary::open({root()}, AllowedFolders({folder_.path()}))->load("part"));
}

TEST_F(Library, ThreadsShareOneCopy) {
  ASSERT_TRUE(import_asset(request("part")));
  const auto library = AssetLibrary::open({root()});
  ASSERT_TRUE(library);
  std::vector<std::shared_ptr<const Asset>> loaded(8);
  std::vector<std::thread> threads;
  for (auto& slot : loaded) {
    threads.emplace_back([&slot, copy = *library] { slot = *copy.load("part"); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& asset : loaded) EXPECT_EQ(asset.get(), loaded.front().get());
}

}  // namespace
}  // namespace seedframe
