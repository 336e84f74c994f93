#include "frames/frame_link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "frames/frame_writer.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class FrameLink : public ::testing::Test {
 protected:
  FrameLink() {
    EXPECT_TRUE(make_folders(committed_));
    EXPECT_TRUE(make_folders(folder_));
    FrameWriter writer(committed_);
    writer.write(frame_files::kLabels, "labels");
    writer.write(frame_files::kInstances, "ids");
    writer.manifest().frame_id = "abc";
    EXPECT_TRUE(writer.write_manifest());
  }

  ScratchFolder scratch_;
  fs::path committed_ = scratch_ / "committed";
  fs::path folder_ = scratch_ / "attempt";
};

TEST_F(FrameLink, SharesEveryFileOfTheFrame) {
  const Result<Manifest> manifest = link_frame(committed_, "abc", folder_);
  ASSERT_TRUE(manifest) << manifest.error().message;
  EXPECT_EQ(manifest->files.size(), 2u);
  for (const char* name : {frame_files::kLabels, frame_files::kInstances, frame_files::kManifest}) {
    EXPECT_TRUE(fs::equivalent(committed_ / name, folder_ / name)) << name;
  }
}

TEST_F(FrameLink, RefusesAnotherFrame) {
  EXPECT_FALSE(link_frame(committed_, "abd", folder_));
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(FrameLink, RefusesAFileWithOtherBytesOfTheSameSize) {
  ASSERT_TRUE(write_file(committed_ / frame_files::kLabels, "lobels"));
  const Result<Manifest> manifest = link_frame(committed_, "abc", folder_);
  ASSERT_FALSE(manifest);
  EXPECT_THAT(manifest.error().message, HasSubstr(frame_files::kLabels));
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(FrameLink, LeavesNothingWhenAFileCannotBeMade) {
  ASSERT_TRUE(make_folders(folder_ / frame_files::kInstances / "in the way"));
  EXPECT_FALSE(link_frame(committed_, "abc", folder_));
  EXPECT_FALSE(fs::exists(folder_ / frame_files::kManifest));
  EXPECT_FALSE(fs::exists(folder_ / frame_files::kLabels));
}

}  // namespace
}  // namespace seedframe
