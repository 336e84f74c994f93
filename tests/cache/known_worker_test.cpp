#include "cache/known_worker.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

class KnownWorkerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    cache_ = FrameCache::open(scratch_ / "cache");
    ASSERT_NE(cache_, nullptr);
    options_.blender.path = "/opt/blender";
  }
  std::string identity() const { return worker_identity(facts_, options_); }

  /// A Blender of this version that notes each time that it is asked.
  std::string program(const std::string& version) {
    const fs::path path = scratch_ / "blender";
    EXPECT_TRUE(write_file(
        path, "#!/bin/sh\necho asked >>" + asked_.string() + "\necho Blender " + version + "\n"));
    fs::permissions(path, fs::perms::owner_all);
    return path.string();
  }
  std::size_t times_asked() const {
    const Result<std::string> text = read_file(asked_);
    return text ? text->size() / std::string_view("asked\n").size() : 0;
  }

  ScratchFolder scratch_;
  const fs::path asked_ = scratch_ / "asked";
  std::unique_ptr<FrameCache> cache_;
  Json facts_ = {{"blender_sha256", "b"}, {"scripts_sha256", "s"}, {"threads", 2}};
  WorkerOptions options_;
};

TEST_F(KnownWorkerTest, WhatAWorkerSaidIsRecalled) {
  ReadyMessage said;
  said.blender = "3.4.1";
  said.build = "build";
  said.kernel = "avx2";
  said.embree = "avx512";
  said.reciprocals = "r";
  said.libc = "glibc 2.36";
  EXPECT_FALSE(recall_worker(*cache_, identity()));
  remember_worker(*cache_, identity(), said);
  const auto recalled = recall_worker(*cache_, identity());
  ASSERT_TRUE(recalled);
  EXPECT_EQ(recalled->blender, said.blender);
  EXPECT_EQ(recalled->build, said.build);
  EXPECT_EQ(recalled->kernel, said.kernel);
  EXPECT_EQ(recalled->embree, said.embree);
  EXPECT_EQ(recalled->reciprocals, said.reciprocals);
  EXPECT_EQ(recalled->libc, said.libc);
}

TEST_F(KnownWorkerTest, TheLastWordCounts) {
  ReadyMessage said;
  said.kernel = "avx2";
  remember_worker(*cache_, identity(), said);
  said.kernel = "avx";
  remember_worker(*cache_, identity(), said);
  EXPECT_EQ(recall_worker(*cache_, identity())->kernel, "avx");
}

TEST_F(KnownWorkerTest, AMemoryThatCannotBeReadIsNone) {
  for (const char* damaged : {"", "{", "[]", R"({"blender": 3})", R"({"blender": "3.4.1"})"}) {
    cache_->remember("worker " + identity(), damaged);
    EXPECT_FALSE(recall_worker(*cache_, identity())) << damaged;
  }
}

TEST_F(KnownWorkerTest, WhateverDecidesMakesItAnotherWorker) {
  const std::string before = identity();
  EXPECT_EQ(identity(), before);
  facts_["blender_sha256"] = "other";
  EXPECT_NE(identity(), before) << "another Blender";
  facts_["blender_sha256"] = "b";
  options_.blender.path = "/opt/other/blender";
  EXPECT_NE(identity(), before) << "the same beside other libraries";
  options_.blender.path = "/opt/blender";
  options_.conditions.kernels = kernels_of(Isa::kAvx);
  EXPECT_NE(identity(), before) << "pinned kernels";
  options_.conditions.kernels.reset();
  options_.wrapper = {"bwrap"};
  EXPECT_NE(identity(), before) << "a sandbox";
  options_.wrapper.clear();
  options_.environment["GLIBC_TUNABLES"] = "glibc.cpu.hwcaps=-AVX2";
  EXPECT_NE(identity(), before) << "hidden instructions";
  options_.environment.clear();
  options_.preload = scratch_ / "worker_cpu.so";
  ASSERT_TRUE(write_file(options_.preload, "library"));
  const std::string preloaded = identity();
  EXPECT_NE(preloaded, before) << "a library";
  ASSERT_TRUE(write_file(options_.preload, "librarz"));
  EXPECT_NE(identity(), preloaded) << "another library of that name";
}

TEST_F(KnownWorkerTest, OurOwnEnvironmentCounts) {
  const std::string before = identity();
  ::setenv("CYCLES_CPU_NO_AVX2", "1", 1);
  EXPECT_NE(identity(), before);
  ::unsetenv("CYCLES_CPU_NO_AVX2");
  ::setenv("SEEDFRAME_A_VARIABLE_THAT_NOBODY_KNOWS", "1", 1);
  EXPECT_NE(identity(), before);
  ::unsetenv("SEEDFRAME_A_VARIABLE_THAT_NOBODY_KNOWS");
  EXPECT_EQ(identity(), before);
}

TEST_F(KnownWorkerTest, WhatIsOfNoConsequenceDoesNot) {
  const std::string before = identity();
  facts_["threads"] = 16;
  options_.threads = 16;
  options_.environment["TMPDIR"] = "/elsewhere";
  ::setenv("WINDOWID", "12345", 1);
  EXPECT_EQ(identity(), before);
  ::unsetenv("WINDOWID");
}

TEST_F(KnownWorkerTest, WithoutItsLibraryNothingIsKnown) {
  options_.preload = scratch_ / "missing.so";
  EXPECT_EQ(identity(), "");
  remember_worker(*cache_, "", ReadyMessage());
  EXPECT_FALSE(recall_worker(*cache_, ""));
}

TEST_F(KnownWorkerTest, ABlenderThatIsKnownIsNotStarted) {
  const std::string blender = program("3.4.1");
  for (int time = 0; time < 3; ++time) {
    const Result<BlenderInfo> info = known_blender(cache_.get(), blender);
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->version, "3.4.1");
    EXPECT_EQ(info->program.path, blender);
    EXPECT_TRUE(info->tested);
  }
  EXPECT_EQ(times_asked(), 1u);
}

TEST_F(KnownWorkerTest, ABlenderThatHasBeenReplacedIsAsked) {
  ASSERT_TRUE(known_blender(cache_.get(), program("3.4.1")));
  const Result<BlenderInfo> info = known_blender(cache_.get(), program("3.6.12"));
  ASSERT_TRUE(info);
  EXPECT_EQ(info->version, "3.6.12");
}

TEST_F(KnownWorkerTest, AModuleThatHasBeenReplacedIsAnotherAtOnce) {
  const std::filesystem::path venv = scratch_ / "venv";
  const std::filesystem::path packages = venv / "lib/python3.11/site-packages";
  std::filesystem::create_directories(packages / "bpy");
  std::filesystem::create_directories(venv / "bin");
  std::filesystem::copy_file("/bin/true", venv / "bin/python");
  ASSERT_TRUE(write_file(packages / "bpy/__init__.so", "library"));
  std::filesystem::create_directory(packages / "bpy-4.5.14.dist-info");
  const std::string name = "python:" + venv.string();
  EXPECT_EQ(known_blender(cache_.get(), name)->version, "4.5.14");
  std::filesystem::rename(packages / "bpy-4.5.14.dist-info", packages / "bpy-4.5.15.dist-info");
  EXPECT_EQ(known_blender(cache_.get(), name)->version, "4.5.15");
}

TEST_F(KnownWorkerTest, WithoutACacheBlenderIsAskedEachTime) {
  const std::string blender = program("3.4.1");
  ASSERT_TRUE(known_blender(nullptr, blender));
  ASSERT_TRUE(known_blender(nullptr, blender));
  EXPECT_EQ(times_asked(), 2u);
}

TEST_F(KnownWorkerTest, WhatIsNoBlenderIsNotRemembered) {
  const std::string blender = program("is not here");
  EXPECT_FALSE(known_blender(cache_.get(), blender));
  EXPECT_FALSE(known_blender(cache_.get(), blender));
  EXPECT_EQ(times_asked(), 2u);
  EXPECT_FALSE(known_blender(cache_.get(), "/no/such/program"));
}

}  // namespace
}  // namespace seedframe
