// Configs that somebody made to read other files, or to take all memory or time.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "config/campaign_config.h"
#include "tests/fixtures/message_of.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kStart = "seedframe: 1\ncamera: {distance_m: 1}\n";

/// A config in <folder>/mine/scene.yaml, beside it <folder>/other.
class HostileConfig : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"mine", "mine/folder", "other", "other/folder"}) {
      fs::create_directories(folder_ / name);
    }
    for (const char* name : {"mine/file", "other/file"}) {
      EXPECT_TRUE(write_file(folder_ / name, "x\n1\n"));
    }
    fs::create_symlink("../other", folder_ / "mine/link");
    fs::create_symlink("../other/file", folder_ / "mine/file_link");
  }
  Result<CampaignConfig> read(const std::string& text, const AllowedFolders& allowed = {}) const {
    return read_campaign_config(text, folder_ / "mine/scene.yaml", {}, allowed);
  }
  /// Also that it comes soon.
  std::string error(const std::string& text) const {
    const auto start = std::chrono::steady_clock::now();
    const auto config = read(text);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 30.0) << text.substr(0, 200);
    const std::string message = message_of(config);
    EXPECT_LT(message.size(), 100'000u);
    return message;
  }

  ScratchFolder folder_;
};

struct Key {
  const char* before;
  const char* after;
  const char* target;  ///< "file" or "folder"
};
const std::vector<Key> kKeys = {
    {"camera: {distance_m: 1}\nseedframe: 1\nasset_folders: [", "]\n", "folder"},
    {"camera: {distance_m: 1}\nseedframe: 1\nmaterial_folders: [", "]\n", "folder"},
    {"camera: {distance_m: 1}\nseedframe: 1\ngraphs: ", "\n", "file"},
    {"camera: {distance_m: 1}\nseedframe: 1\nimage: {ocio_config: ", "}\n", "file"},
    {"seedframe: 1\ncamera: {distance_m: {empirical: [", ", x]}}\n", "file"},
    {"base: ", "\n", "file"},
};

TEST_F(HostileConfig, EveryPathStaysInTheConfigsFolder) {
  for (const Key& key : kKeys) {
    const std::string target = key.target;
    const std::string suffix = target == "file" ? "_link" : "";
    std::vector<std::string> paths = {"../other/" + target, (folder_ / "other" / target).string(),
                                      "link/" + target, "folder/../../other/" + target,
                                      "\"x\\0/../" + target + "\""};
    if (target == "file") paths.insert(paths.end(), {"file_link", "/etc/passwd", "/dev/zero"});
    for (const std::string& path : paths) {
      const std::string text = key.before + path + key.after;
      EXPECT_THAT(
          error(text),
          ::testing::AnyOf(HasSubstr("outside of the folders that may be read"), HasSubstr("NUL")))
          << text;
      EXPECT_THAT(error(text), ::testing::ContainsRegex("scene.yaml:[1-9]:[0-9]+: [a-z]")) << text;
    }
    EXPECT_THAT(error(key.before + target + key.after), ::testing::Not(HasSubstr("outside")));
  }
}

TEST_F(HostileConfig, OtherFoldersCanBeAllowed) {
  const AllowedFolders allowed({folder_ / "other"});
  for (const Key& key : kKeys) {
    const auto config =
        read(key.before + ("../other/" + std::string(key.target)) + key.after, allowed);
    if (!config) {
      EXPECT_THAT(config.error().message, ::testing::Not(HasSubstr("outside"))) << key.before;
    }
  }
  EXPECT_TRUE(read(kStart + "asset_folders: [../other/folder]\n", allowed));
}

TEST_F(HostileConfig, AnOverrideIsNoWayOut) {
  const auto config = read_campaign_config(kStart, folder_ / "mine/scene.yaml",
                                           {{"asset_folders", "[../other/folder]"}});
  ASSERT_FALSE(config);
  EXPECT_THAT(
      config.error().message,
      HasSubstr("--set asset_folders=[../other/folder]: asset_folders[0]: '../other/folder' "
                "leads to " +
                (folder_ / "other/folder").string()));
}

TEST_F(HostileConfig, ABaseIsNoWayOut) {
  ASSERT_TRUE(
      write_file(folder_ / "mine/base.yaml", kStart + "asset_folders: [../other/folder]\n"));
  EXPECT_THAT(error("base: base.yaml\n"), HasSubstr("base.yaml:3:17: asset_folders[0]: "));
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string out;
  out.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) out += text;
  return out;
}

constexpr std::size_t kMega = 1 << 20;

TEST_F(HostileConfig, DeepNestingEndsSoon) {
  for (const char* bracket : {"[", "{", "{a: ", "[[a], ", "- ", "? ", "- - ", "a: ["}) {
    for (const std::size_t levels : {std::size_t{65}, kMega / 4}) {
      EXPECT_NE(error(kStart + "x: " + repeated(bracket, levels)), "(no error)") << bracket;
      EXPECT_NE(error(repeated(bracket, levels)), "(no error)") << bracket;
    }
  }
  std::string indented;
  for (std::size_t i = 0; i < 3000; ++i) indented += std::string(i, ' ') + "a:\n";
  EXPECT_THAT(error(indented), HasSubstr("more than 64 levels"));
}

TEST_F(HostileConfig, ManyValuesTakeLittleMemory) {
  EXPECT_THAT(error(kStart + "x: [" + repeated("0,\n", 5 * kMega) + "]"),
              HasSubstr("the config has more than 250000 values"));
  EXPECT_NE(error(repeated("---\n", 3 * kMega)), "(no error)") << "only the first document counts";
}

TEST_F(HostileConfig, LongTextsAreNotRepeated) {
  const std::string huge(kMega / 2, 'x');
  EXPECT_THAT(error(kStart + "? " + huge + "\n: 1\n"),
              HasSubstr("the path of a key has more than 500"));
  EXPECT_THAT(error(kStart + "scenes: " + huge + "\n"), HasSubstr("expected a whole number"));
  EXPECT_THAT(error(kStart + "scenes: " + huge + "\n"), HasSubstr("…"));
  EXPECT_THAT(error(kStart + "categories: [" + huge + "]\n"), HasSubstr("at most 200 bytes"));
  EXPECT_NE(error(kStart + "ground: {width_m: " + huge + "}\nseed: x\n"), "(no error)");
}

TEST_F(HostileConfig, LongTextsCannotBeMultiplied) {
  const std::string text =
      kStart + "x: &a " + std::string(kMega / 2, 'x') + "\ny: [" + repeated("*a,", 100'000) + "]\n";
  EXPECT_THAT(error(text), HasSubstr("67108864 bytes of text"));
}

TEST_F(HostileConfig, EscapesMakeNoOtherEncoding) {
  for (const char* escape : {"\\N", "\\_"}) {
    EXPECT_THAT(error(kStart + "name: \"a" + escape + "\"\n"),
                HasSubstr("scene.yaml:3:7: this text is not UTF-8"));
  }
}

TEST_F(HostileConfig, ManyMistakesAreCounted) {
  std::string text = kStart + "objects:\n";
  for (int i = 0; i < 5'000; ++i) text += fmt::format("  o{}: {{b{}: 1, c: 2}}\n", i, i);
  EXPECT_THAT(error(text), HasSubstr("… and 14980 more"));
}

TEST_F(HostileConfig, HugeNumbersAreRefused) {
  for (const char* number : {"1e999", "-1e999", "99999999999999999999", ".inf", "-.inf", ".nan",
                             "nan", "inf", "1e18", "0x7fffffffffffffff", "9223372036854775808"}) {
    for (const char* key : {"seed", "scenes", "frames_per_scene", "max_attempts", "seedframe",
                            "render.width", "render.samples"}) {
      const auto config = read_campaign_config(kStart, "t.yaml", {{key, number}});
      ASSERT_FALSE(config) << key << number;
      EXPECT_THAT(config.error().message, HasSubstr("expected a whole number from"))
          << key << number;
    }
  }
  for (const char* number : {"1e999", "-1e999", ".inf", "-.inf", ".nan", "nan", "inf"}) {
    const auto config = read_campaign_config(kStart, "t.yaml", {{"camera.distance_m", number}});
    ASSERT_FALSE(config) << number;
    EXPECT_THAT(config.error().message, HasSubstr("must be finite")) << number;
  }
}

TEST_F(HostileConfig, ProductsOfSweepsAreBounded) {
  std::string axis = "[";
  for (int i = 0; i < 1000; ++i) axis += std::to_string(i) + ",";
  axis += "]";
  std::string sweep = "sweep:\n  values:\n";
  for (int i = 0; i < 20; ++i) sweep += fmt::format("    a{}: {}\n", i, axis);
  EXPECT_THAT(error(kStart + sweep), HasSubstr("a sweep may have 1000000 combinations"));
  EXPECT_THAT(error(kStart + sweep + "scenes: 100000000\nframes_per_scene: 100000000\n"),
              HasSubstr("must not exceed 100000000"));
}

TEST_F(HostileConfig, BasesReplaceABoundedNumberOfValues) {
  ASSERT_TRUE(write_file(folder_ / "mine/base.yaml", kStart));
  std::string text = "base: base.yaml\nset:\n";
  for (int i = 0; i < 1001; ++i) text += fmt::format("  variables.scene.v{}: 1\n", i);
  EXPECT_THAT(error(text), HasSubstr("set: at most 1000 values can be replaced"));
}

TEST_F(HostileConfig, LargeTablesAreRefused) {
  const std::string text = "seedframe: 1\ncamera: {distance_m: {empirical: [t.csv, x]}}\n";
  ASSERT_TRUE(write_file_unsynced(folder_ / "mine/t.csv", repeated(",", 40 * kMega)));
  EXPECT_THAT(error(text), HasSubstr("t.csv has more than 10000 columns"));
  ASSERT_TRUE(write_file_unsynced(folder_ / "mine/t.csv", "x\n1" + repeated(",", 40 * kMega)));
  EXPECT_EQ(error(text), "(no error)");
  ASSERT_TRUE(write_file_unsynced(folder_ / "mine/t.csv", "x\n" + repeated("0\n", 10'000'001)));
  EXPECT_THAT(error(text), HasSubstr("t.csv has more than 10000000 rows"));
  ASSERT_TRUE(write_file_unsynced(folder_ / "mine/t.csv", "x\n1\n"));
  fs::resize_file(folder_ / "mine/t.csv",
                  std::uintmax_t{1} << 40);  // it takes no place on the disk
  EXPECT_THAT(error(text), HasSubstr("t.csv has more than 268435456 bytes"));
}

TEST_F(HostileConfig, NamesOfFoldersAndClassesAreHarmless) {
  for (const char* name : {"../../x", "/x", "a/b", ".", "..", ".x", "-rf", "\"a\\0b\"", "\"a\\nb\"",
                           "a b", "\"\\e[2J\"", "über"}) {
    EXPECT_THAT(error(kStart + "name: " + name + "\n"), HasSubstr("a campaign's name is letters"))
        << name;
  }
  EXPECT_THAT(error(kStart + "name: " + std::string(101, 'x') + "\n"), HasSubstr("at most 100"));
  for (const char* name :
       {"\"a\\nb\"", "\"a\\0\"", "\"\\e[2J\"", "\"a\\x7f\"", "\"a\\L\"", "\"a\\u0085\""}) {
    EXPECT_THAT(error(kStart + "categories: [" + name + "]\n"),
                HasSubstr("a category's name is one line"))
        << name;
  }
}

TEST_F(HostileConfig, TheNameOfAFileIsMadeToFit) {
  const auto name_of = [](const fs::path& file) {
    return read_campaign_config(kStart, file)->name;
  };
  EXPECT_EQ(name_of("x/parts-v1.2.yaml"), "parts-v1.2");
  EXPECT_EQ(name_of("...yaml"), "_.");
  EXPECT_EQ(name_of(".yaml"), "_yaml");
  EXPECT_EQ(name_of("-rf.yaml"), "_rf");
  EXPECT_EQ(name_of("a\n\xff b.yaml"), "a___b");
  EXPECT_EQ(name_of(std::string(250, 'x') + ".yaml"), std::string(100, 'x'));
}

}  // namespace
}  // namespace seedframe
