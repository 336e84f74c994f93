#include "render/worker_log.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

class WorkerLogTest : public testing::Test {
 protected:
  fs::path path() const { return folder_ / "w.log"; }
  ScratchFolder folder_;
};

TEST_F(WorkerLogTest, AppendsToWhatIsThere) {
  ASSERT_TRUE(write_file(path(), "before\n"));
  auto log = WorkerLog::open(path());
  ASSERT_TRUE(log);
  log->append("now\n\n");
  EXPECT_EQ(*read_file(path()), "before\nnow\n\n");
  EXPECT_EQ(log->tail(), "now") << "its own words only, without line feeds at the end";
}

TEST_F(WorkerLogTest, StaysBounded) {
  auto log = WorkerLog::open(path());
  ASSERT_TRUE(log);
  for (int i = 0; i < 400; ++i) log->append(std::string(1 << 16, 'x'));  // 25 MB
  log->append("the last words");
  EXPECT_LE(fs::file_size(path()), 4u << 20);
  EXPECT_LE(fs::file_size(path().string() + ".1"), 4u << 20);
  EXPECT_EQ(log->tail().size(), WorkerLog::kKept);
  EXPECT_TRUE(log->tail().ends_with("xthe last words"));
  EXPECT_EQ(log->tail(14), "the last words");
}

TEST_F(WorkerLogTest, AFullDiskStopsNothing) {
  fs::create_symlink("/dev/full", path());
  auto log = WorkerLog::open(path());
  ASSERT_TRUE(log);
  log->append("kept in memory");
  EXPECT_EQ(log->tail(), "kept in memory");
}

}  // namespace
}  // namespace seedframe
