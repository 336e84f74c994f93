#include "formats/patches.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export/split.h"
#include "export/verify.h"
#include "tests/export/synthetic_dataset.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

/// ImageFolder refuses a class without an image, and numbers the others by the folders there are.
TEST(ExportPatches, OnlyClassesWithAPatchHaveAFolderAndThatInEverySplit) {
  const ScratchFolder scratch;
  SyntheticDataset campaign(scratch.path() / "campaign");
  IdImage bolt(16, 10);
  bolt.at(2, 2) = 3;
  IdImage both = bolt;
  both.at(5, 5) = 40;
  campaign.dataset().seed = 2;
  ExportOptions options{.output = scratch.path() / "out"};
  options.splits = {{"train", 0.6}, {"val", 0.4}};
  for (const int scene : {0, 1, 2, 3, 4}) {
    const bool trains = split_of_scene(scene, 2, options.splits) == 0;
    campaign.add_frame(scene, scene, trains ? both : bolt);
  }
  const auto summary = export_one(campaign.dataset(), "patches", options);
  ASSERT_TRUE(summary) << summary.error().message;
  const std::set<std::string> shown = {"bolt", "gear"};
  EXPECT_EQ(names_in(summary->folder / "train"), shown);
  EXPECT_EQ(names_in(summary->folder / "val"), shown);
  EXPECT_TRUE(fs::is_empty(summary->folder / "val/gear"));
  EXPECT_THAT(summary->warnings, ElementsAre(HasSubstr("no patch shows 'no', 'say \"über\"'"),
                                             AllOf(HasSubstr("no patch of val shows 'gear'"),
                                                   HasSubstr("allow_empty=True"))));
  const Json classes = *parse_json(*read_file(summary->folder / "classes.json"), "classes");
  EXPECT_EQ(classes.size(), 4U);

  const auto again = export_one(campaign.dataset(), "patches", options);  // all is taken over
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->reused, 5);
  EXPECT_EQ(names_in(again->folder / "val"), shown);
  fs::remove(again->folder / "val/gear");
  EXPECT_THAT(
      verify_export(campaign.dataset(), export_formats(), again->folder, 1)->first_differences,
      ElementsAre("the folder val/gear is missing"));
}

}  // namespace
}  // namespace seedframe
