#include "render/blender_info.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/scratch_folder.h"
#include "tests/fixtures/script.h"

namespace seedframe {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string kFake = SEEDFRAME_HOME "/tests/fake_blender/fake_blender.py";

TEST(BlenderInfo, ReadsVersions) {
  const auto info = parse_blender_version("Blender 3.4.1\n\tbuild date: 2023-01-21\n");
  ASSERT_TRUE(info);
  EXPECT_EQ(info->version, "3.4.1");
  EXPECT_TRUE(info->tested);
  const auto lts = parse_blender_version("a library warns\nBlender 4.2.0 LTS\n");
  ASSERT_TRUE(lts);
  EXPECT_EQ(lts->major, 4);
  EXPECT_EQ(lts->minor, 2);
  EXPECT_TRUE(lts->tested);
  EXPECT_FALSE(parse_blender_version("Blender 4.3.0")->tested);
  EXPECT_EQ(tested_blender_versions(), "3.4, 4.2, 4.5, 5.0 and 5.2");
  EXPECT_TRUE(parse_blender_version("Blender 3.3.0"));
}

TEST(BlenderInfo, RefusesOldVersionsAndOtherPrograms) {
  EXPECT_THAT(parse_blender_version("Blender 3.2.9").error().message, HasSubstr("too old"));
  EXPECT_THAT(parse_blender_version("Blender 2.93.0").error().message, HasSubstr("3.3 or newer"));
  EXPECT_FALSE(parse_blender_version(""));
  EXPECT_FALSE(parse_blender_version("GNU bash 5.2"));
  EXPECT_FALSE(parse_blender_version("Blender 99999999999999999999.1"));
}

TEST(BlenderInfo, FindsTheProgramAndAsksIt) {
  const auto info = probe_blender(kFake);
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->program.path, kFake);
  EXPECT_EQ(info->version, "3.4.1");
}

TEST(BlenderInfo, SaysWhatToDoWhenThereIsNone) {
  for (const char* missing : {"/no/such/blender", "no-such-blender"}) {
    const auto info = probe_blender(missing);
    ASSERT_FALSE(info);
    EXPECT_EQ(info.error().kind, ErrorKind::kEnvironment);
    EXPECT_THAT(info.error().message, HasSubstr("--blender PATH"));
    EXPECT_THAT(info.error().message, HasSubstr(missing));
  }
}

TEST(BlenderInfo, AFileThatMayNotBeExecutedIsNoProgram) {
  const ScratchFolder folder;
  const fs::path path = write_script(folder / "not-executable", "#!/bin/sh\n");
  fs::permissions(path, fs::perms::owner_read);
  EXPECT_THAT(probe_blender(path.string()).error().message, HasSubstr("may be executed"));
  EXPECT_FALSE(probe_blender(folder.string()));
}

TEST(BlenderInfo, AProgramThatFailsIsAnErrorWithItsOutput) {
  const ScratchFolder folder;
  const fs::path path = write_script(folder / "broken-blender",
                                     "#!/bin/sh\necho libfoo.so is missing >&2; exit 127\n");
  const auto info = probe_blender(path.string());
  ASSERT_FALSE(info);
  EXPECT_THAT(info.error().message, HasSubstr("libfoo.so is missing"));
  EXPECT_THAT(info.error().message, HasSubstr("127"));
}

}  // namespace
}  // namespace seedframe
