// Runs the tests of configs/schema.json, which are written in the language of the script that makes
// it.
#include <cstdlib>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(ConfigSchema, PassesItsOwnTests) {
  EXPECT_EQ(std::system("/usr/bin/python3 '" SEEDFRAME_HOME "/tests/config/schema_test.py'"), 0);
}

}  // namespace
}  // namespace seedframe
