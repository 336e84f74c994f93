#include "base/file_hashes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "base/sha256.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

TEST(FileHashes, AFileIsReadOnce) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a.png", "grass"));
  const AllowedFolders allowed({folder.path()});
  FileHashes hashes;
  const auto first = hashes.of(folder / "a.png", allowed);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ((*first)->sha256, sha256_hex("grass"));
  EXPECT_EQ((*first)->path, folder / "a.png");
  ASSERT_TRUE(write_file(folder / "a.png", "sand"));
  EXPECT_EQ(hashes.of(folder / "a.png", allowed).value(), *first);
}

TEST(FileHashes, AFileThatCannotBeReadIsLookedForAgain) {
  const ScratchFolder folder;
  const AllowedFolders allowed({folder.path()});
  FileHashes hashes;
  EXPECT_FALSE(hashes.of(folder / "late.png", allowed));
  ASSERT_TRUE(write_file(folder / "late.png", "here"));
  EXPECT_TRUE(hashes.of(folder / "late.png", allowed));
}

TEST(FileHashes, RefusesFilesOutsideOfTheAllowedFolders) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a.png", "grass"));
  FileHashes hashes;
  const auto refused = hashes.of(folder / "a.png", AllowedFolders({"/usr/share"}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kInput);
  EXPECT_THAT(refused.error().message, HasSubstr("a.png"));
}

}  // namespace
}  // namespace seedframe
