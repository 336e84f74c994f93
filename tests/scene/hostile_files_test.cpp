// Material folders and formulas that want more than is theirs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/files.h"
#include "formula/formula.h"
#include "formula/formula_functions.h"
#include "tests/fixtures/message_of.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A texture set m/T, an environment map m/hdri/e.exr, and m/library.yaml.
class HostileMaterials : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"m/T", "m/hdri", "out"}) fs::create_directories(folder_ / name);
    for (const char* name : {"m/T/T_Color.png", "m/hdri/e.exr", "out/secret"}) {
      EXPECT_TRUE(write_file(folder_ / name, name));
    }
    EXPECT_TRUE(write_file(folder_ / "out/library.yaml", "materials: {}\n"));
  }
  /// Of the first frame.
  std::string error(const AllowedFolders& allowed = {}) const {
    const auto config = read_campaign_config(
        "seedframe: 1\ncamera: {distance_m: 1}\nworld: {hdri: e}\nground: {material: T}\n",
        "t.yaml");
    const auto materials = MaterialLibrary::open({folder_ / "m"}, config->materials, allowed);
    if (!materials) return materials.error().message;
    auto expander = SceneExpander::compile(*config, built_in_assets(), *materials);
    if (!expander) return expander.error().message;
    const auto frame = expander->expand(0);
    return message_of(frame);
  }
  void replace_by_link(const std::string& name, const fs::path& target) const {
    fs::remove_all(folder_ / name);
    fs::create_symlink(target, folder_ / name);
  }

  ScratchFolder folder_;
};

TEST_F(HostileMaterials, ImagesStayInTheirFolder) {
  EXPECT_EQ(error(), "(no error)");
  replace_by_link("m/T/T_Color.png", folder_ / "out/secret");
  EXPECT_THAT(error(), HasSubstr("t.yaml:4:"));
  EXPECT_THAT(error(), HasSubstr("T_Color.png leads to " + (folder_ / "out/secret").string()));
  EXPECT_EQ(error(AllowedFolders({folder_ / "out"})), "(no error)");
}

TEST_F(HostileMaterials, EnvironmentMapsDoToo) {
  replace_by_link("m/hdri/e.exr", "/dev/zero");
  EXPECT_THAT(error(), HasSubstr("t.yaml:3:15: world.hdri"));
  EXPECT_THAT(error(), HasSubstr("leads to /dev/zero, which is outside"));
}

TEST_F(HostileMaterials, AFolderThatIsALinkOpensNothing) {
  fs::rename(folder_ / "m/T", folder_ / "out/T");
  replace_by_link("m/T", folder_ / "out/T");
  EXPECT_THAT(error(), HasSubstr("which is outside of the folders that may be read"));
}

TEST_F(HostileMaterials, LibrariesStayInTheirFolder) {
  replace_by_link("m/library.yaml", folder_ / "out/library.yaml");
  EXPECT_THAT(error(),
              HasSubstr("library.yaml leads to " + (folder_ / "out/library.yaml").string()));
}

TEST_F(HostileMaterials, ALibraryNamesNoFilesElsewhere) {
  ASSERT_TRUE(write_file(folder_ / "m/library.yaml",
                         "materials: {x: {roughness: {empirical: [../out/secret, a]}}}\n"));
  EXPECT_THAT(
      error(),
      HasSubstr("library.yaml:1:41: materials.x.roughness.empirical[0]: '../out/secret' leads"));
}

TEST_F(HostileMaterials, AnImageThatIsAPipeIsNotWaitedFor) {
  fs::remove(folder_ / "m/T/T_Color.png");
  ASSERT_EQ(::mkfifo((folder_ / "m/T/T_Color.png").c_str(), 0600), 0);
  EXPECT_THAT(error(), HasSubstr("found a device, a pipe or a socket"));
}

TEST_F(HostileMaterials, LibrariesAreBoundedAsConfigsAre) {
  fs::resize_file(folder_ / "m/T/T_Color.png", 1000);
  ASSERT_TRUE(write_file(folder_ / "m/library.yaml", "materials: {}\n"));
  fs::resize_file(folder_ / "m/library.yaml", std::uintmax_t{1} << 40);
  EXPECT_THAT(error(), HasSubstr("has more than 16777216 bytes"));
}

// Formulas are arithmetic. Whoever adds a function here: it must not read a file, the environment
// or the clock, and must end soon.
TEST(FormulaFunctions, AreTheseAndNoOthers) {
  EXPECT_THAT(formula_function_names(),
              ElementsAre("abs", "acos", "asin", "atan", "atan2", "blackbody", "ceil", "clamp",
                          "cos", "cross", "deg", "dot", "exp", "floor", "hsv", "length", "ln",
                          "log10", "max", "min", "mod", "normalize", "pow", "rad", "rgb",
                          "rotate_x", "rotate_y", "rotate_z", "round", "sin", "sqrt", "tan"));
}

TEST(FormulaFunctions, ReachNothingOutsideTheScene) {
  const Scope nothing;
  for (const char* text : {"open('/etc/passwd')",
                           "read('x')",
                           "file('x')",
                           "include('x')",
                           "import('os')",
                           "__import__('os')",
                           "system('ls')",
                           "exec('ls')",
                           "eval('1')",
                           "env('HOME')",
                           "getenv('HOME')",
                           "$HOME",
                           "${HOME}",
                           "`ls`",
                           "$(ls)",
                           "time()",
                           "now()",
                           "date()",
                           "rand()",
                           "random()",
                           "sleep(9)",
                           "pi.__class__",
                           "lambda: 1",
                           "a = 1",
                           "1; 2",
                           "while 1",
                           "[x for x in y]",
                           "HOME",
                           "errno",
                           "stdin",
                           "'/etc/passwd'.x",
                           "cos.constructor(1)"}) {
    EXPECT_FALSE(CompiledFormula::compile(text, nothing)) << text;
  }
}

TEST(FormulaFunctions, TowersAndDepthsEnd) {
  const Scope nothing;
  const auto ends = [&](const std::string& text) {
    const auto formula = CompiledFormula::compile(text, nothing);
    if (formula) formula->vector({});
    return formula.has_value();
  };
  std::string tower = "9";
  for (int i = 0; i < 90; ++i) tower = "pow(9, " + tower + ")";
  EXPECT_TRUE(ends(tower));  // infinite, which no key takes
  EXPECT_FALSE(ends("pow(9, " + tower + "," + std::string(2000, ' ') + ")"));
  for (const char* text : {"(", "[", "-", "!", "sin(", "1 ? ", "1 + (", "1 ? 1 : "}) {
    std::string deep;
    while (deep.size() < 1900) deep += text;
    EXPECT_FALSE(ends(deep)) << text;
    ends(deep + "1");
    EXPECT_FALSE(ends(std::string(1'000'000, text[0]))) << text;
  }
  std::string long_sum = "1";
  for (int i = 0; i < 990; ++i) long_sum += "+1";
  EXPECT_TRUE(ends(long_sum));
}

TEST(Graphs, BombsAreRefused) {
  const ScratchFolder folder;
  const fs::path file = folder / "g.jsonl";
  const std::string config =
      "seedframe: 1\ngraphs: g.jsonl\nvariables: {frame: {a: 1}}\ncamera: {distance_m: 1}\n";
  const auto error = [&](const std::string& text) {
    EXPECT_TRUE(write_file_unsynced(file, text));
    return scene_error(config, folder / "scene.yaml");
  };
  const std::string open(3'000'000, '[');
  const std::string close(3'000'000, ']');
  EXPECT_THAT(error("{\"a\": " + open + close + "}\n"), HasSubstr("g.jsonl:1"));
  EXPECT_THAT(error("{\"a\": [" + open + close + "]}\n"), HasSubstr("g.jsonl:1"));
  EXPECT_THAT(error("{\"a\": " + open), HasSubstr("g.jsonl:1"));
  EXPECT_THAT(error("{\"a\": 1e999}\n"), HasSubstr("g.jsonl:1"));
  EXPECT_THAT(error("{\"a\": 1" + std::string(1'000'000, '0') + "}\n"), HasSubstr("g.jsonl:1"));
  EXPECT_TRUE(write_file_unsynced(file, "{}\n"));
  fs::resize_file(file, std::uintmax_t{1} << 40);
  EXPECT_THAT(scene_error(config, folder / "scene.yaml"),
              HasSubstr("has more than 1073741824 bytes"));
}

}  // namespace
}  // namespace seedframe
