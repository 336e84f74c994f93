// The determinism study with the real Blender, tiny: its instruments work.

#include "study/study.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/real_blender.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

constexpr const char* kOcio = "/usr/share/blender/datafiles/colormanagement/config.ocio";

TEST(RealBlenderStudy, TheSameIsIdenticalAndOtherKernelsAreNot) {
  const auto blender = probe_blender(test_blender());
  ASSERT_TRUE(blender) << blender.error().message;
  const auto color = ColorManagement::load(kOcio);
  ASSERT_TRUE(color);
  const ScratchFolder scratch;
  const auto program = std::filesystem::path(SEEDFRAME_PROGRAM);
  Study study({*blender, std::filesystem::path(SEEDFRAME_HOME) / "blender_scripts",
               program.parent_path() / "seedframe_worker_cpu.so", scratch, 64, 48},
              *color);
  StudySetting plain;
  plain.samples = 2;
  StudySetting threads = plain;
  threads.threads = 2;
  const auto same = study.measure({"2 threads", threads, plain, 1});
  ASSERT_TRUE(same) << same.error().message;
  ASSERT_EQ(same->cells.size(), study_scenes().size());
  for (std::size_t i = 0; i < study_scenes().size(); ++i) {
    const StudyCell& cell = same->cells[i];
    EXPECT_EQ(cell.linear.differing, 0) << study_scenes()[i];
    EXPECT_EQ(cell.linear.pixels, 64 * 48);
    EXPECT_EQ(cell.other_ids + cell.other_depths + cell.other_normals, 0) << study_scenes()[i];
  }
  EXPECT_NE(study.made_with()->find("Blender " + blender->version), std::string::npos);

  StudySetting old_cpu = plain;
  old_cpu.kernels = kernels_of(Isa::kSse2);
  const auto other = study.measure({"SSE2", old_cpu, plain, 1});
  ASSERT_TRUE(other) << other.error().message;
  std::int64_t differing = 0;
  for (const StudyCell& cell : other->cells) {
    differing += cell.linear.differing;
    EXPECT_EQ(cell.other_ids, 0);
  }
  EXPECT_GT(differing, 0);
  std::filesystem::remove_all(scratch);
}

}  // namespace
}  // namespace seedframe
