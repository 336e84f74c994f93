#include "image_files/image_module.h"

#include <fstream>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

namespace fs = std::filesystem;

TEST(ImageModule, IsFoundBesideTheProgramAndOpenedOnce) {
  const auto table = image_module_table();
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ((*table)->version, image_module::kVersion);
  EXPECT_EQ(*image_module_table(), *table);
}

TEST(ImageModule, WhenMissingTheErrorSaysWhereItWasLookedForAndWhatToInstall) {
  const auto table = open_image_module({"/nowhere/a.so", "/nowhere/b.so"});
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().kind, ErrorKind::kEnvironment);
  EXPECT_EQ(table.error().message,
            "the library that reads and writes images is missing: there is no /nowhere/a.so or "
            "/nowhere/b.so; install OpenImageIO (libopenimageio2.4, which scripts/setup.sh does) "
            "and build or install Seedframe as a whole");
}

TEST(ImageModule, WhenUnloadableTheErrorSaysWhy) {
  const fs::path file = fs::path(testing::TempDir()) / "no_library.so";
  std::ofstream(file) << "not a library, but long enough to be looked at as if it were one .......";
  const auto table = open_image_module({"/nowhere/a.so", file});
  fs::remove(file);
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().kind, ErrorKind::kEnvironment);
  EXPECT_NE(table.error().message.find("no_library.so"), std::string::npos);
  EXPECT_NE(table.error().message.find("install OpenImageIO"), std::string::npos);
}

TEST(ImageModule, ALibraryWithoutTheTableIsOfAnotherBuild) {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path().parent_path();
  const auto table = open_image_module({folder / "seedframe_worker_cpu.so"});
  ASSERT_FALSE(table);
  EXPECT_NE(table.error().message.find("another Seedframe"), std::string::npos);
}

}  // namespace
}  // namespace seedframe
