// Runs the worker's tests that need no Blender, which are written in the worker's language.
#include <gtest/gtest.h>

#include "render/child_process.h"

namespace seedframe {
namespace {

TEST(WorkerScripts, PassTheirOwnTests) {
  const auto output =
      output_of({"/usr/bin/python3", SEEDFRAME_HOME "/tests/render/protocol_test.py"},
                std::chrono::seconds(60));
  EXPECT_TRUE(output) << output.error().message;
}

}  // namespace
}  // namespace seedframe
