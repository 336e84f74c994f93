// Blender as a module of a Python: found by what lies there, and started through the starter
// script.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "base/sha256.h"
#include "render/blender_info.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/fixtures/script.h"

namespace seedframe {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

// Base 64 as an installer writes it, of the SHA-256 of "abc".
constexpr const char* kAbc = "ungWv48Bz-pBQUDeXa4iI7ADYaOWF3qctBD_YfIAFa0";

class BlenderModule : public testing::Test {
 protected:
  BlenderModule() {
    fs::create_directories(venv_ / "bin");
    write_script(venv_ / "bin/python",
                 "#!/bin/sh\necho started >> " + (folder_ / "started").string() + "\n");
    fs::create_directories(packages_ / "bpy");
    write(packages_ / "bpy/__init__.so", "abc");
    note("bpy-4.5.15.dist-info", std::string("bpy/4.5/a.py,,\nbpy/__init__.so,sha256=") + kAbc +
                                     ",3\nbpy/lib/b.so,sha256=x,4\n");
  }
  void note(const std::string& name, const std::string& record) {
    fs::create_directories(packages_ / name);
    write(packages_ / name / "RECORD", record);
  }
  static void write(const fs::path& path, const std::string& text) {
    EXPECT_TRUE(write_file(path, text));
  }
  std::string name() const { return "python:" + venv_.string(); }

  ScratchFolder folder_;
  fs::path venv_ = folder_ / "venv";
  fs::path packages_ = venv_ / "lib/python3.11/site-packages";
};

TEST_F(BlenderModule, IsFoundInAVirtualEnvironmentWithoutStartingIt) {
  for (const std::string& each :
       {name(), name() + "/", name() + "/bin/python", name() + "/../venv/bin/python"}) {
    const auto info = probe_blender(each);
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->version, "4.5.15") << each;
    EXPECT_TRUE(info->tested);
    EXPECT_EQ(info->program.path, venv_ / "bin/python") << each;
    EXPECT_EQ(info->program.module, packages_ / "bpy");
    EXPECT_EQ(info->program.name(), name() + "/bin/python");
  }
  EXPECT_FALSE(fs::exists(folder_ / "started"));
}

TEST_F(BlenderModule, ALinkToAnotherPythonStaysALink) {
  fs::remove(venv_ / "bin/python");
  fs::create_symlink("/bin/sh", venv_ / "bin/python");
  EXPECT_EQ(find_blender(name())->path, venv_ / "bin/python");
}

TEST_F(BlenderModule, IsStartedThroughTheStarterAndABlenderByItself) {
  const auto module = find_blender(name());
  ASSERT_TRUE(module);
  EXPECT_THAT(blender_command(*module, "/scripts", 3, "/scripts/work.py"),
              ElementsAre((venv_ / "bin/python").string(), "-I", "-B", "/scripts/bpy_starter.py",
                          "--threads", "3", "/scripts/work.py", "--"));
  EXPECT_THAT(blender_command({"/opt/blender", {}}, "/scripts", 3, "/scripts/work.py"),
              ElementsAre("/opt/blender", "--background", "--factory-startup", "--disable-autoexec",
                          "-noaudio", "--threads", "3", "--python-exit-code", "3", "--python",
                          "/scripts/work.py", "--"));
}

TEST_F(BlenderModule, ItsHashIsWhatTheInstallerNotedAsLongAsThatCanBeTrue) {
  const auto blender = find_blender(name());
  ASSERT_TRUE(blender);
  EXPECT_EQ(*sha256_of(*blender), sha256_hex("abc"));
  write(packages_ / "bpy/__init__.so", "abd");  // as long: believed
  EXPECT_EQ(*sha256_of(*blender), sha256_hex("abc"));
  write(packages_ / "bpy/__init__.so", "abcd");
  EXPECT_EQ(*sha256_of(*blender), sha256_hex("abcd"));
  for (const char* line : {"bpy/__init__.so,sha256=+,4", "bpy/__init__.so,sha256=ab", "", "x"}) {
    note("bpy-4.5.15.dist-info", line);
    EXPECT_EQ(*sha256_of(*blender), sha256_hex("abcd")) << line;
  }
}

TEST_F(BlenderModule, SaysWhatToDoWhenThereIsNone) {
  const auto message = [](const std::string& name) {
    const auto info = probe_blender(name);
    EXPECT_FALSE(info);
    EXPECT_EQ(info.error().kind, ErrorKind::kEnvironment);
    return info ? std::string() : info.error().message;
  };
  EXPECT_THAT(message("python:/no/such/venv"), HasSubstr("there is no /no/such/venv"));
  EXPECT_THAT(message("python:"), HasSubstr("--blender python:VENV"));
  fs::remove_all(packages_ / "bpy-4.5.15.dist-info");
  EXPECT_THAT(message(name()), HasSubstr("does not tell its version"));
  note("bpy-3.1.0.dist-info", "");
  EXPECT_THAT(message(name()), HasSubstr("too old"));
  fs::remove_all(packages_ / "bpy");
  EXPECT_THAT(message(name()), HasSubstr("no module bpy in " + venv_.string()));
  EXPECT_THAT(message(name()), HasSubstr("scripts/setup.sh --blender"));
  fs::remove(venv_ / "bin/python");
  EXPECT_THAT(message(name()), HasSubstr("there is no"));
}

}  // namespace
}  // namespace seedframe
