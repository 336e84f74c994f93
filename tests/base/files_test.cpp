#include "base/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/nearest_name.h"
#include "base/sha256.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

class FilesTest : public ::testing::Test {
 protected:
  ScratchFolder folder_;
};

TEST_F(FilesTest, WritesAndReadsBytes) {
  const std::string bytes("a\0b\n", 4);
  ASSERT_TRUE(write_file(folder_ / "f", bytes));
  EXPECT_EQ(*read_file(folder_ / "f"), bytes);
}

TEST_F(FilesTest, ReplacesAtomicallyAndLeavesNoTemporary) {
  ASSERT_TRUE(write_file_atomically(folder_ / "f", "old"));
  ASSERT_TRUE(write_file_atomically(folder_ / "f", "new"));
  EXPECT_EQ(*read_file(folder_ / "f"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
}

TEST_F(FilesTest, CommitReplacesAFolderThatIsThere) {
  fs::create_directories(folder_ / "final");
  ASSERT_TRUE(write_file(folder_ / "final" / "stale", "x"));
  fs::create_directories(folder_ / "attempt");
  ASSERT_TRUE(write_file(folder_ / "attempt" / "fresh", "y"));
  ASSERT_TRUE(commit_folder(folder_ / "attempt", folder_ / "final"));
  EXPECT_TRUE(fs::exists(folder_ / "final" / "fresh"));
  EXPECT_FALSE(fs::exists(folder_ / "final" / "stale"));
  EXPECT_FALSE(fs::exists(folder_ / "attempt"));
}

TEST_F(FilesTest, ManyFilesCanWaitForTheDiskTogether) {
  ASSERT_TRUE(write_file_unsynced(folder_ / "a", "1"));
  ASSERT_TRUE(write_file_unsynced(folder_ / "b", "2"));
  EXPECT_TRUE(sync_filesystem(folder_));
  EXPECT_EQ(*read_file(folder_ / "b"), "2");
  EXPECT_FALSE(sync_filesystem(folder_ / "none"));
  EXPECT_FALSE(write_file_unsynced("/dev/full", "x"));
}

TEST_F(FilesTest, AFileIsOverwrittenWhateverItsLength) {
  EXPECT_FALSE(overwrite_file_unsynced(folder_ / "none", "x")) << "nothing there to overwrite";
  ASSERT_TRUE(write_file(folder_ / "f", "a long text"));
  ASSERT_TRUE(overwrite_file_unsynced(folder_ / "f", "short"));
  EXPECT_EQ(*read_file(folder_ / "f"), "short");
  ASSERT_TRUE(overwrite_file_unsynced(folder_ / "f", "much longer than that"));
  EXPECT_EQ(*read_file(folder_ / "f"), "much longer than that");
  EXPECT_FALSE(overwrite_file_unsynced("/dev/full", "x"));
  fs::create_hard_link(folder_ / "f", folder_ / "g");
  EXPECT_FALSE(overwrite_file_unsynced(folder_ / "f", "x"));
  EXPECT_EQ(*read_file(folder_ / "g"), "much longer than that");
}

TEST_F(FilesTest, ErrorsNameTheFileAndTheReason) {
  const auto missing = read_file(folder_ / "none");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("none: No such file"), std::string::npos);
  EXPECT_FALSE(read_file(folder_));
  EXPECT_FALSE(write_file(folder_ / "no" / "such" / "folder", "x"));
  const auto full = write_file("/dev/full", "x");
  ASSERT_FALSE(full);
  EXPECT_NE(full.error().message.find("No space left"), std::string::npos);
}

TEST_F(FilesTest, WhatIsNoFileIsNeitherWaitedForNorReadWithoutEnd) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const fs::path& path : {folder_ / "pipe", fs::path("/dev/zero")}) {
    const auto read = read_file(path);
    ASSERT_FALSE(read) << path;
    EXPECT_EQ(read.error().kind, ErrorKind::kInput);
    EXPECT_NE(read.error().message.find("it is a device, a pipe or a socket"), std::string::npos);
  }
}

TEST(Sha256, MatchesFips180) {
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256().update("a").update("bc").hex(), sha256_hex("abc"));
}

TEST(NearestName, FindsTyposAndNothingElse) {
  const std::vector<std::string> names = {"samples", "width", "height"};
  EXPECT_EQ(nearest_name("sampels", names), "samples");
  EXPECT_EQ(nearest_name("widht", names), "width");
  EXPECT_EQ(nearest_name("colour", names), "");
  EXPECT_EQ(did_you_mean("smaples", names), " (did you mean 'samples'?)");
  EXPECT_EQ(did_you_mean("colour", names), " (there are: samples, width, height)");
  EXPECT_EQ(did_you_mean("z", {"x", "y"}), " (there are: x, y)");
  const std::vector<std::string> longer = {"coco", "yolo-detect", "yolo-obb", "rotation_deg",
                                           "yolos"};
  EXPECT_EQ(did_you_mean("olo", longer),
            " (there are: coco, yolo-detect, yolo-obb, rotation_deg, yolos)");
  EXPECT_EQ(did_you_mean("rotation", longer), " (did you mean 'rotation_deg'?)");
  EXPECT_EQ(did_you_mean("yolo", {"coco", "yolo-detect", "yolo-obb", "yolo-pose"}),
            " (did you mean 'yolo-detect', 'yolo-obb' or 'yolo-pose'?)");
}

}  // namespace
}  // namespace seedframe
