// docs/config.md and docs/config/values.md name every key, and their examples are right.
//
// The keys are learnt from the reader itself: a key "probe" is put everywhere, and the error lists
// what there is instead.

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "config/campaign_config.h"
#include "tests/config/config_page.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const fs::path kHome = SEEDFRAME_HOME;

/// What the reader says of the smallest config with `probe: 1` below `path`, or nothing.
std::string answer_to_probe(const std::string& path) {
  std::vector<Override> overrides = {{path.empty() ? "probe" : path + ".probe", "1"}};
  const auto config =
      read_campaign_config("seedframe: 1\ncamera: {distance_m: 1}\n", "t.yaml", overrides);
  return config ? "" : config.error().message;
}

/// The comma-separated names between `before` and ')', or none.
std::vector<std::string> names_after(const std::string& text, const std::string& before) {
  std::vector<std::string> names;
  std::size_t start = text.find(before);
  if (start == std::string::npos) return names;
  start += before.size();
  const std::size_t stop = text.find(')', start);
  while (start < stop) {
    const std::size_t end = std::min(text.find(", ", start), stop);
    names.push_back(text.substr(start, end - start));
    start = end + 2;
  }
  return names;
}

std::vector<std::string> keys_below(const std::string& path) {
  const std::string probe = path.empty() ? "probe" : path + ".probe";
  return names_after(answer_to_probe(path), ": " + probe + ": unknown key (there are: ");
}

/// True where names of the user's choice stand, such as below "objects".
bool has_names_below(const std::string& path) {
  return answer_to_probe(path).find(path + ".probe: expected a mapping, found '1'") !=
         std::string::npos;
}

/// Objects hold objects that hold objects: those of a group are as those of the scene.
bool is_nested(const std::string& path) { return path == "objects.probe.objects"; }

/// All keys with their paths; NAME stands for names of the user's choice.
void collect_keys(const std::string& path, std::set<std::string>& keys) {
  for (const std::string& key : keys_below(path)) {
    const bool is_colour = key == "rgb" || key == "hsv" || key == "kelvin";
    const std::string full = path.empty() || is_colour ? key : path + "." + key;
    keys.insert(full);
    if (!is_colour && !is_nested(full)) collect_keys(full, keys);
  }
  if (!path.empty() && has_names_below(path)) collect_keys(path + ".probe", keys);
}

std::set<std::string> known_keys() {
  std::set<std::string> keys;
  collect_keys("", keys);
  return keys;
}

/// The keys of each type of light; only those of a point light are known without its type.
std::set<std::string> light_keys() {
  std::set<std::string> keys;
  for (const char* type : {"point", "sun", "spot", "area"}) {
    const auto config = read_campaign_config(
        "seedframe: 1\ncamera: {distance_m: 1}\n", "t.yaml",
        {{"lights.probe.type", type}, {"lights.probe.power", "1"}, {"lights.probe.probe", "1"}});
    EXPECT_FALSE(config);
    for (const std::string& key : names_after(config.error().message, "(there are: ")) {
      keys.insert("lights.NAME." + key);
    }
  }
  return keys;
}

std::string with_names(std::string key) {
  for (std::size_t at = key.find(".probe"); at != std::string::npos; at = key.find(".probe")) {
    key.replace(at, 6, ".NAME");
  }
  return key;
}

TEST(ConfigPage, HasARowForEveryKey) {
  const std::string page = config_page();
  std::set<std::string> keys = light_keys();
  for (const std::string& key : known_keys()) keys.insert(with_names(key));
  // If the way in which keys are learnt breaks, this says so.
  for (const char* key : {"seed", "render.samples", "variables.scene", "objects.NAME.scatter.gap_m",
                          "objects.NAME.objects", "objects.NAME.grid.counts", "sweep.hold_draws",
                          "constraints.NAME.type", "materials.NAME.base_color", "lights.NAME.blend",
                          "lights.NAME.lux", "camera.fov_deg"}) {
    ASSERT_TRUE(keys.contains(key)) << key;
  }
  std::vector<std::string> missing;
  for (const std::string& key : keys) {
    if (page.find("\n| `" + key + "` |") == std::string::npos) missing.push_back(key);
  }
  EXPECT_THAT(missing, IsEmpty()) << "docs/config.md has no row for these";
}

TEST(ConfigPage, ObjectsInAGroupHaveTheKeysOfObjects) {
  const std::vector<std::string> keys = keys_below("objects.probe");
  EXPECT_THAT(keys, Contains("objects"));
  EXPECT_EQ(keys_below("objects.probe.objects.probe"), keys);
}

TEST(ConfigPage, HasNoRowForAKeyThatIsNotThere) {
  const std::string page = config_page();
  std::set<std::string> keys = light_keys();
  for (const std::string& key : known_keys()) keys.insert(with_names(key));
  const std::string row = "\n| `";
  for (std::size_t at = page.find(row); at != std::string::npos; at = page.find(row, at + 1)) {
    const std::size_t start = at + row.size();
    const std::string cell = page.substr(start, page.find('`', start) - start);
    const std::string section = cell.substr(0, cell.find('.'));
    if (section == cell || !keys.contains(section)) continue;
    EXPECT_THAT(keys, Contains(cell));
  }
}

TEST(ConfigPage, HasARowForEveryDistributionWithItsParameters) {
  const std::string page = config_page();
  const std::string error = answer_to_probe("camera.roll_deg");
  const auto distributions = names_after(error, "unknown distribution 'probe' (there are: ");
  ASSERT_GE(distributions.size(), 11u) << error;
  for (const std::string& name : distributions) {
    std::string row = "\n| `" + name + "` | `";
    if (name != "constant" && name != "choice" && name != "mixture") {
      std::string parameters;
      for (const std::string& parameter : keys_below("camera.roll_deg." + name)) {
        parameters += (parameters.empty() ? "" : ", ") + parameter;
      }
      row += "{" + name + ": [" + parameters + "]}` |";
    }
    EXPECT_THAT(page, HasSubstr(row));
  }
}

TEST(ConfigPage, ItsExamplesAreAccepted) {
  const std::vector<std::string> examples = config_page_examples();
  EXPECT_GE(examples.size(), 17u);
  for (const std::string& text : examples) {
    const auto config = read_campaign_config(text, kHome / "configs" / "page.yaml");
    EXPECT_TRUE(config) << text << (config ? "" : config.error().message);
  }
}

TEST(ConfigFolder, AllItsConfigsAreAccepted) {
  int configs = 0;
  for (const auto& entry : fs::directory_iterator(kHome / "configs")) {
    if (entry.path().extension() != ".yaml") continue;
    const auto text = read_file(entry.path());
    ASSERT_TRUE(text);
    const auto config = read_campaign_config(*text, entry.path());
    EXPECT_TRUE(config) << (config ? "" : config.error().message);
    ++configs;
  }
  EXPECT_GE(configs, 1);
}

}  // namespace
}  // namespace seedframe
