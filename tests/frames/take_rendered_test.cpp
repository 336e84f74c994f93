#include "frames/take_rendered.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TakeRendered : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(given());
    ASSERT_TRUE(write_file(given() / "rendered.exr", "pixels"));
  }
  fs::path given() const { return folder_ / "workers/000003-1"; }
  fs::path attempt() const { return folder_ / "attempts/000003-1"; }
  Status take() const { return take_rendered(folder_ / "workers", "000003-1", attempt()); }
  void expect_refused(const std::string& message) const {
    const Status taken = take();
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().kind, ErrorKind::kRender);
    EXPECT_THAT(taken.error().message, HasSubstr(message));
  }

  const ScratchFolder folder_;
};

TEST_F(TakeRendered, TakesThePassesAndNothingElse) {
  ASSERT_TRUE(write_file(given() / "rendered.exr.sharp", "sharp"));
  ASSERT_TRUE(write_file(given() / "image.png", "not asked for"));
  ASSERT_TRUE(take());
  EXPECT_EQ(*read_file(attempt() / "rendered.exr"), "pixels");
  EXPECT_EQ(*read_file(attempt() / "rendered.exr.sharp"), "sharp");
  EXPECT_FALSE(fs::exists(attempt() / "image.png"));
  EXPECT_FALSE(fs::exists(given()));
}

TEST_F(TakeRendered, ALinkAPipeAndAFileOfManyNamesAreNotThePicture) {
  ASSERT_TRUE(write_file(folder_ / "other", "somebody's"));
  const fs::path picture = given() / "rendered.exr";
  fs::remove(picture);
  fs::create_symlink(folder_ / "other", picture);
  expect_refused("rendered.exr is not a plain file");
  fs::remove_all(attempt());
  ASSERT_EQ(::mkfifo(picture.c_str(), 0600), 0);
  expect_refused("rendered.exr is not a plain file");
  fs::remove_all(attempt());
  fs::create_hard_link(folder_ / "other", picture);
  expect_refused("rendered.exr is not a plain file");
  EXPECT_EQ(*read_file(folder_ / "other"), "somebody's");
}

TEST_F(TakeRendered, AFolderThatWasSwappedIsNotFollowed) {
  fs::create_directories(folder_ / "elsewhere");
  ASSERT_TRUE(write_file(folder_ / "elsewhere/rendered.exr", "somebody's"));
  fs::remove_all(given());
  expect_refused("is gone or another one");
  fs::create_symlink(folder_ / "elsewhere", given());
  expect_refused("is gone or another one");
  EXPECT_TRUE(fs::exists(folder_ / "elsewhere/rendered.exr"));
}

TEST_F(TakeRendered, WithoutAPictureNothingIsDone) {
  fs::remove(given() / "rendered.exr");
  expect_refused("left no rendered.exr");
}

}  // namespace
}  // namespace seedframe
