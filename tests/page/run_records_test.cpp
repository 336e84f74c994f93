#include "page/run_records.h"

#include <gmock/gmock.h>

#include "export/export_index.h"
#include "tests/campaign/campaign_fixture.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RunRecordsTest : public CampaignFixture {
 protected:
  /// An export whose frame f is in the split that `split_of` has for it.
  void write_export(const std::string& format, const std::vector<int>& split_of) {
    const fs::path folder = campaign().files.exports() / format;
    fs::create_directories(folder);
    ExportMarker marker;
    marker.format = format;
    marker.options.splits = {{"train", 0.8}, {"val", 0.2}};
    ASSERT_TRUE(write_file(folder / kMarkerFile, marker_text(marker)));
    std::string index;
    for (std::size_t frame = 0; frame < split_of.size(); ++frame) {
      IndexEntry entry;
      entry.frame = static_cast<std::int64_t>(frame);
      entry.split = split_of[frame];
      index += index_line(entry);
    }
    ASSERT_TRUE(write_file(folder / kIndexFile, index));
  }
  ToldText told() { return ToldText(campaign().files.root()); }
};

TEST_F(RunRecordsTest, WithoutExportsThereAreNoSplits) {
  EXPECT_THAT(exports_found(campaign(), told()).splits, IsEmpty());
}

TEST_F(RunRecordsTest, AnExportTellsTheScenesOfItsSplits) {
  write_export("coco",
               {0, 0, 0, 1, 1, 1, 0, 1, 0});  // scenes of three frames: the third is in both
  const ExportsFound found = exports_found(campaign(), told());
  ASSERT_EQ(found.splits.size(), 2u);
  EXPECT_EQ(found.splits[0].split, "train");
  EXPECT_THAT(found.splits[0].scenes, ElementsAre(0, 2));
  EXPECT_THAT(found.splits[1].scenes, ElementsAre(1, 2));
  EXPECT_THAT(found.splits[1].frames, ElementsAre(3, 4, 5, 7));
  EXPECT_EQ(found.json[0].at("splits")[1].at("frames"), 4);
}

TEST_F(RunRecordsTest, AnExportThatCannotBeReadIsToldAndLeftOut) {
  write_export("coco", {0, 5, -1});  // splits that there are not
  EXPECT_THAT(exports_found(campaign(), told()).splits[0].frames, ElementsAre(0));
  ASSERT_TRUE(write_file(campaign().files.exports() / "coco" / kIndexFile, "{\"frame\": "));
  const ExportsFound found = exports_found(campaign(), told());
  EXPECT_THAT(found.splits, IsEmpty());
  EXPECT_TRUE(found.json[0].contains("error"));
}

TEST_F(RunRecordsTest, OfErrorsNothingIsSaidWhereNothingWasPromisedOrMeasured) {
  EXPECT_TRUE(errors_json(campaign(), std::nullopt)->is_null());
}

TEST_F(RunRecordsTest, FailuresAreCountedAndTheFirstTold) {
  for (int frame = 0; frame < 3; ++frame) {
    ASSERT_TRUE(campaign().store.attempt_failed(frame, 1, AttemptOutcome::kError,
                                                FrameState::kFailed, "no"));
  }
  const Json failures = *failures_json(campaign(), told());
  EXPECT_EQ(failures.at("count"), 3);
  EXPECT_EQ(failures.at("frames").size(), 3u);
  EXPECT_EQ(failures.at("attempts").size(), 3u);
}

TEST(ToldTexts, NameTheCampaignInsteadOfItsFolder) {
  const ToldText told("/data/of/mine/parts");
  EXPECT_EQ(told.name(), "parts");
  EXPECT_EQ(told.of("cannot read /data/of/mine/parts/frames: gone"),
            "cannot read parts/frames: gone");
  EXPECT_EQ(ToldText("/data/of/mine/parts/").name(), "parts");
}

TEST(ToldTexts, LoseTheFoldersOfAbsolutePaths) {
  EXPECT_EQ(without_folders("/home/me/parts.yaml:3:1: 'a/b' is not in '/data/lib'"),
            "parts.yaml:3:1: 'a/b' is not in 'lib'");
  EXPECT_EQ(without_folders("1/2 and /"), "1/2 and ");
  EXPECT_EQ(without_folders(""), "");
}

TEST(ToldTexts, AreUtf8WithoutWhatATerminalObeys) {
  EXPECT_EQ(ToldText("/a/b").of("\x1b[31m\xff"), "?[31m?");
  EXPECT_EQ(ToldText("parts").of("spare parts"), "spare parts") << "a word is no path";
}

}  // namespace
}  // namespace seedframe
