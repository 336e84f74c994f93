// The examples of docs/config.md and docs/config/values.md can be expanded; the functions and the
// materials that they list are those that there are.

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/campaign_config.h"
#include "formula/formula_functions.h"
#include "scene/expander.h"
#include "scene/material_library.h"
#include "tests/config/config_page.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

const fs::path kHome = SEEDFRAME_HOME;

Status expand_all_frames(const std::string& text) {
  const auto config = read_campaign_config(text, kHome / "configs" / "page.yaml");
  if (!config) return forward_error(config);
  auto assets = AssetLibrary::open({kHome / "assets"});
  if (!assets) return forward_error(assets);
  auto materials = MaterialLibrary::open({kHome / "materials"}, config->materials);
  if (!materials) return forward_error(materials);
  auto expander = SceneExpander::compile(*config, *assets, *materials);
  if (!expander) return forward_error(expander);
  for (std::int64_t frame = 0; frame < expander->frame_count(); ++frame) {
    const auto expanded = expander->expand(frame);
    if (!expanded) return forward_error(expanded);
  }
  return {};
}

/// Names between backticks in the first cells of the table of formulas, such as "clamp(x, low,
/// high)".
std::vector<std::string> listed_in_formulas() {
  const std::string page = config_page();
  const std::size_t begin = page.find("| in a formula | is |");
  const std::string table = page.substr(begin, page.find("\n\n", begin) - begin);
  std::vector<std::string> listed;
  for (std::size_t row = table.find("\n| `"); row != std::string::npos;
       row = table.find("\n| `", row + 1)) {
    const std::string cell = table.substr(row + 3, table.find(" | ", row + 3) - row - 3);
    for (std::size_t open = cell.find('`'); open != std::string::npos;) {
      const std::size_t close = cell.find('`', open + 1);
      listed.push_back(cell.substr(open + 1, close - open - 1));
      open = cell.find('`', close + 1);
    }
  }
  return listed;
}

TEST(ConfigPage, ItsExamplesCanBeExpanded) {
  for (const std::string& text : config_page_examples()) {
    const Status expanded = expand_all_frames(text);
    EXPECT_TRUE(expanded) << text << (expanded ? "" : expanded.error().message);
  }
}

TEST(ConfigPage, ListsTheFunctionsThatThereAre) {
  std::set<std::string> functions;
  for (std::string name : listed_in_formulas()) {
    if (std::isalpha(static_cast<unsigned char>(name[0])) == 0) continue;
    if (name.find('(') == std::string::npos) name += "(x)";
    Scope scope;
    for (const char* number :
         {"x", "y", "a", "b", "low", "high", "r", "g", "h", "s", "value", "angle", "T"}) {
      scope[number] = number_symbol(0);
    }
    for (const char* vector : {"v", "w"}) {
      scope[vector] = {{ValueType::kVector, {}}, 0};
    }
    const auto compiled = CompiledFormula::compile(name, scope);
    EXPECT_TRUE(compiled) << name << (compiled ? "" : ": " + compiled.error().message);
    functions.insert(name.substr(0, name.find('(')));
  }
  EXPECT_THAT(functions, ::testing::UnorderedElementsAreArray(formula_function_names()));
}

TEST(ConfigPage, ListsTheBuiltInMaterials) {
  const auto library = MaterialLibrary::open({kHome / "materials"}, {});
  ASSERT_TRUE(library) << library.error().message;
  std::vector<std::string> names = library->material_names();
  for (const std::string& name : library->hdri_names()) names.push_back(name);
  const std::string page = config_page();
  const std::size_t begin = page.find("| built in | names |");
  ASSERT_NE(begin, page.npos);
  const std::string table = page.substr(begin, page.find("\n\n", begin) - begin);
  for (const std::string& name : names) {
    EXPECT_THAT(table, ::testing::HasSubstr("`" + name + "`")) << "docs/config.md";
  }
}

}  // namespace
}  // namespace seedframe
