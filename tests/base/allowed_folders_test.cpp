#include "base/allowed_folders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/files.h"
#include "tests/fixtures/message_of.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Allowed : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "data/sub");
    fs::create_directories(folder_ / "data2");
    EXPECT_TRUE(write_file(folder_ / "data/sub/a.txt", "a"));
    EXPECT_TRUE(write_file(folder_ / "data2/secret.txt", "s"));
  }
  bool allows(const fs::path& path) const {
    return AllowedFolders({folder_ / "data"}).check(path, "it").has_value();
  }
  std::string error(const fs::path& path) const {
    const Status status = AllowedFolders({folder_ / "data"}).check(path, "'it'");
    EXPECT_TRUE(status || status.error().kind == ErrorKind::kInput);
    return message_of(status);
  }

  ScratchFolder folder_;
};

TEST_F(Allowed, IsAllThatLiesBelow) {
  EXPECT_TRUE(allows(folder_ / "data"));
  EXPECT_TRUE(allows(folder_ / "data/"));
  EXPECT_TRUE(allows(folder_ / "data/sub/a.txt"));
  EXPECT_TRUE(allows(folder_ / "data/sub/../sub/a.txt"));
  EXPECT_TRUE(allows(folder_ / "data2/../data/sub"));
  EXPECT_TRUE(allows(folder_ / "data/not/there")) << "who opens it says so";
}

TEST_F(Allowed, IsNothingElse) {
  EXPECT_FALSE(allows("/etc/passwd"));
  EXPECT_FALSE(allows("/"));
  EXPECT_FALSE(allows(""));
  EXPECT_FALSE(allows(folder_.path()));
  EXPECT_FALSE(allows(folder_ / "data2/secret.txt")) << "a name that begins alike";
  EXPECT_FALSE(allows(folder_ / "data/../data2/secret.txt"));
  EXPECT_FALSE(allows(folder_ / "data/sub/../../../../../../../../../../etc/passwd"));
  EXPECT_FALSE(allows(folder_ / "data/not/there/../../../data2"));
  EXPECT_FALSE(allows("/proc/self/root/etc/passwd"));
  EXPECT_FALSE(AllowedFolders().check(folder_ / "data", "it"));
}

TEST_F(Allowed, LinksAreFollowed) {
  fs::create_symlink(folder_ / "data2", folder_ / "data/folder");
  fs::create_symlink("../data2/secret.txt", folder_ / "data/file");
  fs::create_symlink("folder", folder_ / "data/again");
  fs::create_symlink("sub", folder_ / "data/inside");
  fs::create_symlink("circle", folder_ / "data/circle");
  fs::create_symlink("/nowhere/at/all", folder_ / "data/dangling");
  EXPECT_FALSE(allows(folder_ / "data/folder/secret.txt"));
  EXPECT_FALSE(allows(folder_ / "data/file"));
  EXPECT_FALSE(allows(folder_ / "data/again/secret.txt"));
  EXPECT_FALSE(allows(folder_ / "data/circle"));
  EXPECT_TRUE(allows(folder_ / "data/inside/a.txt"));
  // ".." behind a link is that of where it leads.
  EXPECT_TRUE(allows(folder_ / "data/folder/../data/sub/a.txt"));
  EXPECT_FALSE(allows(folder_ / "data/folder/.."));
  // Dangling: nothing can be read, and what comes there later would be outside.
  EXPECT_FALSE(allows(folder_ / "data/dangling") && fs::exists(folder_ / "data/dangling"));
}

TEST_F(Allowed, AFolderMayBeALinkItself) {
  fs::create_symlink(folder_ / "data2", folder_ / "link");
  const AllowedFolders allowed({folder_ / "link"});
  EXPECT_TRUE(allowed.check(folder_ / "link/secret.txt", "it"));
  EXPECT_TRUE(allowed.check(folder_ / "data2/secret.txt", "it"));
}

TEST_F(Allowed, DevicesAndPipesAreRefused) {
  EXPECT_FALSE(AllowedFolders({"/"}).check("/dev/zero", "it"));
  ASSERT_EQ(::mkfifo((folder_ / "data/pipe").c_str(), 0600), 0);
  EXPECT_THAT(error(folder_ / "data/pipe"), HasSubstr("found a device, a pipe or a socket"));
}

TEST_F(Allowed, APathIsCheckedToItsEnd) {
  EXPECT_THAT(error(folder_ / std::string("data/x\0y", 8)), HasSubstr("NUL"));
  EXPECT_FALSE(allows(folder_ / ("data/" + std::string(10'000, 'x'))));
}

TEST_F(Allowed, TheMessageSaysWhereItLeadsAndWhatToDo) {
  const std::string message = error(folder_ / "data/../data2/secret.txt");
  EXPECT_THAT(message, HasSubstr("'it' leads to " + (folder_ / "data2/secret.txt").string()));
  EXPECT_THAT(message, HasSubstr("(" + (folder_ / "data").string() + ")"));
  EXPECT_THAT(message, HasSubstr("--allow DIR"));
}

TEST_F(Allowed, TheWorkingDirectoryIsWhatARelativePathStartsAt) {
  const AllowedFolders allowed({""});
  ASSERT_EQ(allowed.folders().size(), 1u);
  EXPECT_EQ(allowed.folders()[0], fs::canonical("."));
  EXPECT_TRUE(allowed.check("x", "it"));
  EXPECT_FALSE(allowed.check("../x", "it"));
}

}  // namespace
}  // namespace seedframe
