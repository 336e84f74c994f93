// Runs the tests of what stands in a worker that are written in the worker's language.
#include <filesystem>

#include <gtest/gtest.h>

#include "render/child_process.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

constexpr auto kLongest = std::chrono::seconds(60);

TEST(WorkerScripts, PassTheirOwnTests) {
  const auto output =
      output_of({"/usr/bin/python3", SEEDFRAME_HOME "/tests/render/protocol_test.py"}, kLongest);
  EXPECT_TRUE(output) << output.error().message;
}

TEST(WorkerPreload, FindsEmbreeWhoeverLoadedIt) {
  const fs::path preload = fs::path(SEEDFRAME_PROGRAM).parent_path() / "seedframe_worker_cpu.so";
  ASSERT_TRUE(fs::exists(preload));
  const auto output =
      output_of({"/usr/bin/env", "LD_PRELOAD=" + preload.string(), "/usr/bin/python3",
                 SEEDFRAME_HOME "/tests/render/preload_test.py", "libembree3.so.3"},
                kLongest);
  EXPECT_TRUE(output) << output.error().message;
}

}  // namespace
}  // namespace seedframe
