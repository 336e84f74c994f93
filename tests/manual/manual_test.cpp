#include "manual/manual.h"

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "manual/describe_command.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A small program with one of each kind of option.
class ManualOfAProgram : public ::testing::Test {
 protected:
  ManualOfAProgram() : app_("Makes cakes,\nand eats them.", "seedframe") {
    app_.require_subcommand(1);
    CLI::App* bake = app_.add_subcommand("bake", "one cake");
    bake->add_option("CONFIG", text_, "its recipe")->required();
    bake->add_option("-o,--output", text_, "where [it's] put: a folder")->type_name("DIR");
    bake->add_option("--heat", text_, "how hot")->check(CLI::IsMember({"low", "high"}));
    bake->add_option("--topping", list_,
                     "which, can be more than one:\n  nuts: hard\n  cream: soft")
        ->check(offers({"nuts", "cream"}));
    bake->add_flag("--dry-run", flag_, ".only told\\n");
    bake->footer("Example: seedframe bake cake.yaml");
    CLI::App* shelf = app_.add_subcommand("shelf", "what there is");
    shelf->require_subcommand(1);
    shelf->add_subcommand("list", "of cakes")->add_option("FILE", list_, "from these");
  }

  CommandText described() { return describe_command(app_); }

  CLI::App app_;
  std::string text_;
  std::vector<std::string> list_;
  bool flag_ = false;
};

const OptionText& option(const CommandText& command, const std::string& name) {
  for (const OptionText& option : command.options) {
    if (option.names.back() == name) return option;
  }
  throw std::out_of_range(name);
}

TEST_F(ManualOfAProgram, HasEveryVerbWithItsPath) {
  const CommandText program = described();
  std::vector<std::string> paths;
  for (const CommandText* command : all_commands(program)) paths.push_back(verb_path(*command));
  EXPECT_THAT(paths, ElementsAre("", "bake", "shelf", "shelf list"));
}

TEST_F(ManualOfAProgram, TellsWhatMayFollowAnOption) {
  const CommandText program = described();
  const CommandText& bake = program.verbs.at(0);
  EXPECT_EQ(bake.arguments.at(0).offer, Offer::kConfigs);
  EXPECT_TRUE(bake.arguments.at(0).required);
  EXPECT_THAT(option(bake, "--output").names, ElementsAre("-o", "--output"));
  EXPECT_EQ(option(bake, "--output").offer, Offer::kFolders);
  EXPECT_THAT(option(bake, "--heat").words, ElementsAre("low", "high"));
  EXPECT_THAT(option(bake, "--topping").words, ElementsAre("nuts", "cream"));
  EXPECT_TRUE(option(bake, "--topping").repeated);
  EXPECT_TRUE(option(bake, "--dry-run").value.empty());
  EXPECT_EQ(bake.example, "seedframe bake cake.yaml");
  const CommandText& list = program.verbs.at(1).verbs.at(0);
  EXPECT_EQ(list.arguments.at(0).offer, Offer::kFiles);
}

TEST_F(ManualOfAProgram, OfferedWordsAreNeitherCheckedNorShown) {
  described();
  app_.parse("bake cake.yaml --topping chocolate");
  EXPECT_THAT(list_, ElementsAre("chocolate"));
  EXPECT_THAT(app_.get_subcommand("bake")->help(), Not(HasSubstr("nuts,cream")));
}

TEST_F(ManualOfAProgram, IsTheSameEachTime) {
  const CommandText program = described();
  const CommandText again = described();
  EXPECT_EQ(bash_completion(program), bash_completion(again));
  EXPECT_EQ(man_page(program, {}), man_page(again, {}));
}

TEST_F(ManualOfAProgram, ManPageKeepsRoffFromReadingTexts) {
  const std::string page = man_page(described(), {"1.2", {{"2", "bad"}}, {}, {}});
  EXPECT_THAT(page, HasSubstr("\"seedframe 1.2\""));
  EXPECT_THAT(page, HasSubstr("\n\\&.only told\\en\n"));
  EXPECT_THAT(page, HasSubstr("\\fB\\-\\-dry\\-run\\fR"));
  EXPECT_THAT(page, HasSubstr("Makes cakes, and eats them."));
  EXPECT_THAT(page, HasSubstr("how hot; one of low, high"));
}

TEST_F(ManualOfAProgram, HelpIsQuotedForEachShell) {
  const CommandText program = described();
  EXPECT_THAT(zsh_completion(program), HasSubstr("[where \\[it'\\''s\\] put\\: a folder]"));
  EXPECT_THAT(fish_completion(program), HasSubstr("-d 'where [it\\'s] put: a folder'"));
  EXPECT_THAT(zsh_completion(program), HasSubstr("[which, can be more than one]"));
}

}  // namespace
}  // namespace seedframe
