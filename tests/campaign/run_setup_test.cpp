#include "campaign/run_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/cores.h"
#include "base/files.h"
#include "base/sha256.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kOcioConfig = "/usr/share/blender/datafiles/colormanagement/config.ocio";

class RunSetupTest : public ::testing::Test {
 protected:
  RunSetupTest() {
    places_ = {scratch_ / "scripts", scratch_ / "worker_cpu.so", scratch_ / "cache"};
    EXPECT_TRUE(write_file(places_.preload, "library"));
    settings_.ocio_config = kOcioConfig;
    use_blender("3.4.1");
  }
  void use_blender(const std::string& version) {
    const fs::path path = scratch_ / "blender";
    EXPECT_TRUE(write_file(path, "#!/bin/sh\necho Blender " + version + "\n"));
    fs::permissions(path, fs::perms::owner_all);
    options_.blender = path;
  }
  RunSetup set_up(std::int64_t frames = 100) const {
    Result<RunSetup> setup = set_up_run(options_, places_, settings_, frames);
    EXPECT_TRUE(setup) << setup.error().message;
    return setup ? std::move(*setup) : RunSetup();
  }
  Error error() const {
    const Result<RunSetup> setup = set_up_run(options_, places_, settings_, 100);
    EXPECT_FALSE(setup);
    return setup ? Error() : setup.error();
  }

  ScratchFolder scratch_;
  RunPlaces places_;
  RunOptions options_;
  CampaignSettings settings_;
};

TEST_F(RunSetupTest, ARenderingHasBlenderItsColoursAndItsScripts) {
  const RunSetup setup = set_up();
  EXPECT_EQ(setup.blender.version, "3.4.1");
  EXPECT_EQ(setup.blender.sha256, *sha256_of_file(scratch_ / "blender"));
  EXPECT_EQ(setup.options.worker.blender.path, scratch_ / "blender");
  EXPECT_EQ(setup.options.worker.scripts, places_.scripts);
  EXPECT_EQ(setup.options.worker.preload, places_.preload);
  EXPECT_NE(setup.color, nullptr);
  EXPECT_EQ(setup.cache, places_.cache);
  EXPECT_THAT(setup.notes, IsEmpty());
}

TEST_F(RunSetupTest, WhatIsLeftOpenIsChosen) {
  const RunOptions options = set_up().options;
  EXPECT_GE(options.pool.workers, 1);
  EXPECT_GE(options.worker.threads, 1);
  EXPECT_LE(options.pool.workers * options.worker.threads, core_count());
  EXPECT_GT(options.pool.worker_memory_bytes, 0);
}

TEST_F(RunSetupTest, WhatIsAskedForStays) {
  options_.pool.workers = 3;
  options_.worker.threads = 5;
  options_.pool.worker_memory_bytes = 123;
  const RunOptions options = set_up().options;
  EXPECT_EQ(options.pool.workers, 3);
  EXPECT_EQ(options.worker.threads, 5);
  EXPECT_EQ(options.pool.worker_memory_bytes, 123);
}

TEST_F(RunSetupTest, WorkersThatAreAskedForShareTheCores) {
  options_.pool.workers = 4 * core_count();
  EXPECT_EQ(set_up().options.worker.threads, 1);
}

TEST_F(RunSetupTest, OfABlenderThatIsNotTestedTheUserIsTold) {
  use_blender("4.3.0");
  EXPECT_THAT(set_up().notes, ElementsAre(HasSubstr("Blender 4.3.0 is not a version that")));
}

TEST_F(RunSetupTest, AModuleOfPythonBringsItsColours) {
  const fs::path packages = scratch_ / "venv/lib/python3.11/site-packages";
  const fs::path config = packages / "bpy/4.5/datafiles/colormanagement/config.ocio";
  fs::create_directories(config.parent_path());
  fs::create_directories(packages / "bpy-4.5.15.dist-info");
  fs::create_directories(scratch_ / "venv/bin");
  fs::copy_file(kOcioConfig, config);
  fs::copy(fs::path(kOcioConfig).parent_path() / "luts", config.parent_path() / "luts");
  fs::copy(fs::path(kOcioConfig).parent_path() / "filmic", config.parent_path() / "filmic");
  fs::copy_file("/bin/true", scratch_ / "venv/bin/python");
  EXPECT_TRUE(write_file(packages / "bpy/__init__.so", "library"));
  settings_.ocio_config.reset();
  options_.blender = "python:" + (scratch_ / "venv").string();
  const RunSetup setup = set_up();
  EXPECT_EQ(setup.blender.version, "4.5.15");
  EXPECT_EQ(setup.options.worker.blender.module, packages / "bpy");
  ASSERT_NE(setup.color, nullptr);
  EXPECT_EQ(setup.color->config_hash(), *sha256_of_file(config));
  EXPECT_THAT(setup.notes, IsEmpty());

  fs::remove(config);
  EXPECT_THAT(error().message, HasSubstr(config.string()));
}

TEST_F(RunSetupTest, WithoutBlenderThereIsNone) {
  options_.blender = scratch_ / "nothing";
  EXPECT_EQ(error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(error().message, HasSubstr("Blender not found"));
}

TEST_F(RunSetupTest, TheLibraryForWorkersMustBeThere) {
  fs::remove(places_.preload);
  EXPECT_EQ(error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(error().message, HasSubstr("worker_cpu.so is missing"));
}

TEST_F(RunSetupTest, AViewThatTheColoursDoNotKnowIsAMistakeOfTheConfig) {
  settings_.image.view = "Filmic Noir";
  EXPECT_EQ(error().kind, ErrorKind::kInput);
  EXPECT_THAT(error().message, HasSubstr("Filmic Noir"));
}

TEST_F(RunSetupTest, PortableCampaignsPinTheKernels) {
  EXPECT_FALSE(set_up().options.worker.conditions.kernels);
  settings_.determinism = {Determinism::Mode::kPortable, Isa::kAvx};
  EXPECT_EQ(set_up().options.worker.conditions.kernels, kernels_of(Isa::kAvx));
}

TEST_F(RunSetupTest, WhatBlenderIsIsRememberedUntilItsFileIsTouched) {
  const std::string script = "#!/bin/sh\necho >>" + (scratch_ / "starts").string() + "\n";
  const fs::path path = scratch_ / "blender";
  const auto starts = [this] { return fs::file_size(scratch_ / "starts"); };
  ASSERT_TRUE(write_file(path, script + "echo Blender 3.4.1\n"));
  const std::string sha256 = *sha256_of_file(path);
  EXPECT_EQ(set_up().blender.sha256, sha256);
  EXPECT_EQ(starts(), 1u);
  EXPECT_EQ(set_up().blender.sha256, sha256);
  EXPECT_EQ(starts(), 1u);
  ASSERT_TRUE(write_file(path, script + "echo Blender 3.4.2\n"));
  const RunSetup changed = set_up();
  EXPECT_EQ(changed.blender.version, "3.4.2");
  EXPECT_EQ(changed.blender.sha256, *sha256_of_file(path));
  EXPECT_EQ(starts(), 2u);
}

TEST_F(RunSetupTest, FramesThatPromiseNothingAreNotCached) {
  settings_.determinism.mode = Determinism::Mode::kNone;
  EXPECT_TRUE(set_up().cache.empty());
}

TEST_F(RunSetupTest, LabelsByGeometryNeedNoBlender) {
  settings_.labels = LabelSource::kTwin;
  options_.blender = scratch_ / "nothing";
  fs::remove(places_.preload);
  const RunSetup setup = set_up();
  EXPECT_EQ(setup.color, nullptr);
  EXPECT_EQ(setup.options.pool.workers, core_count());
  EXPECT_EQ(setup.options.worker.threads, 1);
  EXPECT_THAT(describe(setup), HasSubstr("without Blender"));
}

TEST_F(RunSetupTest, AFrameThatIsAloneIsTracedOnAllCores) {
  settings_.labels = LabelSource::kTwin;
  const RunSetup setup = set_up(1);
  EXPECT_EQ(setup.options.pool.workers, 1);
  EXPECT_EQ(setup.options.worker.threads, core_count());
}

}  // namespace
}  // namespace seedframe
