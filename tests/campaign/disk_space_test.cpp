#include "campaign/disk_space.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/statvfs.h>

#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kEndless = std::numeric_limits<std::uint64_t>::max();

TEST(DiskSpace, NothingNeedsNoRoom) {
  const ScratchFolder scratch;
  EXPECT_TRUE(check_room(scratch.path(), {0, 0}));
}

TEST(DiskSpace, TooFewBytesPauseARun) {
  const ScratchFolder scratch;
  const Status room = check_room(scratch.path(), {kEndless, 0});
  ASSERT_FALSE(room);
  EXPECT_EQ(room.error().kind, ErrorKind::kExhausted);
  EXPECT_THAT(room.error().message, HasSubstr("is full"));
}

TEST(DiskSpace, TooFewInodesPauseARunAsAFullDiskDoes) {
  const ScratchFolder scratch;
  struct statvfs info = {};
  ASSERT_EQ(::statvfs(scratch.path().c_str(), &info), 0);
  if (info.f_files == 0) GTEST_SKIP() << "this file system has no table of inodes";
  const Status room = check_room(scratch.path(), {0, kEndless});
  ASSERT_FALSE(room);
  EXPECT_EQ(room.error().kind, ErrorKind::kExhausted);
  EXPECT_THAT(room.error().message, HasSubstr("takes no more files"));
}

TEST(DiskSpace, ARunNeedsRoomForFilesToo) {
  RunSetup setup;
  setup.frame_bytes = 1000;
  setup.options.pool.workers = 2;
  const DiskRoom room = room_for_attempts(setup);
  EXPECT_EQ(room.bytes, 8000U);
  EXPECT_GE(room.files, 8U * 10U);
}

}  // namespace
}  // namespace seedframe
