#include "formats/class_folders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::ElementsAre;

TEST(ClassFolders, KeepPlainNames) {
  EXPECT_THAT(class_folders({"bolt", "M8_nut-2", "v1.5"}), ElementsAre("bolt", "M8_nut-2", "v1.5"));
}

TEST(ClassFolders, CannotLeaveTheirFolder) {
  EXPECT_THAT(class_folders({"../../etc", "/abs", ".", "..", "a/b", ".hidden", ""}),
              ElementsAre("_._.._etc~1", "_abs~2", "_~3", "__~4", "a_b~5", "_hidden~6", "~7"));
}

TEST(ClassFolders, AllDifferWhateverTheCase) {
  EXPECT_THAT(class_folders({"Bolt", "bolt", "a b", "a_b"}),
              ElementsAre("Bolt", "bolt~2", "a_b~3", "a_b"));
}

}  // namespace
}  // namespace seedframe
