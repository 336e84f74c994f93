// What verifying an export of any format finds.
#include "export/verify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export/export_index.h"
#include "tests/export/every_format.h"

namespace seedframe {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class VerifyExport : public EveryFormat {};

INSTANTIATE_TEST_SUITE_P(Formats, VerifyExport, ::testing::ValuesIn(kFormats), name_of_format);

TEST_P(VerifyExport, IsWhatItWasMadeFrom) {
  const auto summary = run(split_options());
  ASSERT_TRUE(summary) << summary.error().message;
  const VerifySummary found = verified();
  EXPECT_EQ(found.frames, 10);
  EXPECT_EQ(found.differences, 0) << ::testing::PrintToString(found.first_differences);
}

TEST_P(VerifyExport, ShowsAChangeOfAnyFile) {
  ASSERT_TRUE(run(split_options()));
  int changed = 0;
  std::map<std::pair<fs::path, fs::path>, int> alike;
  for (const auto& [path, bytes] : files_below(folder())) {
    if (path == "seedframe.json" || path == "seedframe.index" || bytes.empty()) continue;
    if (++alike[{fs::path(path).parent_path(), fs::path(path).extension()}] > 3) continue;
    SCOPED_TRACE(path);
    std::string other = bytes;
    other[other.size() / 2] ^= 1;
    ASSERT_TRUE(write_quickly(folder() / path, other));
    EXPECT_GT(verified().differences, 0);
    fs::remove(folder() / path);
    EXPECT_GT(verified().differences, 0);
    ASSERT_TRUE(write_quickly(folder() / path, bytes));
    ++changed;
  }
  EXPECT_GE(changed, 1);
  EXPECT_EQ(verified().differences, 0);
  ASSERT_TRUE(write_quickly(folder() / "stray.txt", "not of this export"));
  EXPECT_THAT(verified().first_differences, Contains("stray.txt belongs to no frame"));
}

TEST_P(VerifyExport, ShowsSharedFilesOfNoFrame) {
  ExportOptions three = options();
  three.splits = {{"train", 1.0 - 1e-9}, {"val", 1e-9}};
  ASSERT_TRUE(run(three));  // val is empty
  EXPECT_EQ(verified().differences, 0);
  for (const auto& [path, bytes] : files_below(folder())) {
    const std::size_t split = path.find("train");
    if (split == std::string::npos || path.find("seedframe") != std::string::npos) continue;
    std::string other = path;
    other.replace(split, 5, "val");
    const auto before = read_file(folder() / other);
    fs::create_directories((folder() / other).parent_path());
    ASSERT_TRUE(write_quickly(folder() / other, bytes));
    EXPECT_GT(verified().differences, 0) << other;
    fs::remove(folder() / other);
    if (before) {
      ASSERT_TRUE(write_quickly(folder() / other, *before));
    }
  }
  EXPECT_EQ(verified().differences, 0);
}

TEST_P(VerifyExport, ShowsFramesThatCameAndWent) {
  ASSERT_TRUE(run(split_options()));
  campaign_.add_frame(12, 6, SyntheticDataset::discs(12));
  EXPECT_THAT(verified().first_differences, Contains(HasSubstr("frame 12: is not in the export")));
  campaign_.frames().pop_back();
  campaign_.frames().pop_back();
  EXPECT_THAT(verified().first_differences,
              Contains(HasSubstr("frame 10 is in the export, and not in the campaign")));
}

TEST_P(VerifyExport, NamesAFrameThatWentFromAmongOthers) {
  ASSERT_TRUE(run(split_options()));
  campaign_.frames().erase(campaign_.frames().begin() + 4);
  EXPECT_THAT(verified().first_differences,
              Contains(HasSubstr("frame 5 is in the export, and not in the campaign")));
}

TEST_P(VerifyExport, ShowsAnExportOfOtherClasses) {
  ASSERT_TRUE(run(split_options()));
  campaign_.dataset().keypoints[2].names.emplace_back("hub");
  EXPECT_GT(verified().differences, 0);
}

TEST_P(VerifyExport, ShowsFramesInAnotherSplit) {
  ASSERT_TRUE(run(split_options()));
  campaign_.dataset().seed = 3;  // draws other scenes into val
  if (!is_reused()) {
    EXPECT_THAT(verified().first_differences, Contains("statistics.json is not what it should be"));
    return;
  }
  EXPECT_THAT(verified().first_differences, Contains(HasSubstr("belongs to another split")));
}

TEST_P(VerifyExport, ShowsFilesThatTheIndexDoesNotList) {
  ASSERT_TRUE(run(split_options()));
  std::string index = *read_file(folder() / kIndexFile);
  const std::size_t files = index.find("\"files\":[[");
  if (files == std::string::npos) return;  // of the formats without files of their own
  index.erase(files + 9, index.find("]]", files) - files - 8);
  ASSERT_TRUE(write_quickly(folder() / kIndexFile, index));
  EXPECT_GT(verified().differences, 0);
}

}  // namespace
}  // namespace seedframe
