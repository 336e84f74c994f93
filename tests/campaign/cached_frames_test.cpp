#include "campaign/cached_frames.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "frames/frame_writer.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOurs = R"({"kernel":"avx2","threads":1})";
constexpr const char* kOthers = R"({"kernel":"avx","threads":1})";

class CachedFramesTest : public ::testing::Test {
 protected:
  CachedFramesTest() {
    FrameWriter writer(committed_);
    EXPECT_TRUE(make_folders(committed_));
    writer.write(frame_files::kLabels, "labels");
    writer.manifest().frame_id = "id";
    EXPECT_TRUE(writer.write_manifest());
    CachedFrames earlier = run();
    earlier.add("id", kOurs, committed_);
  }
  CachedFrames run(CachedFrames::Use use = CachedFrames::Use::kTakeAndAdd) {
    return CachedFrames(scratch_ / "cache", use, settings_, Json::object(), {});
  }
  fs::path attempt() {
    const fs::path folder = scratch_ / ("attempt-" + std::to_string(attempts_++));
    EXPECT_TRUE(make_folders(folder));
    return folder;
  }

  ScratchFolder scratch_;
  CampaignSettings settings_;
  fs::path committed_ = scratch_ / "committed";
  int attempts_ = 0;
};

TEST_F(CachedFramesTest, NothingIsTakenUntilItIsKnownWhatWorkersAre) {
  CachedFrames frames = run();
  EXPECT_FALSE(frames.has("id"));
  EXPECT_FALSE(frames.take("id", attempt()));
  frames.expect(kOurs);
  EXPECT_TRUE(frames.has("id"));
  EXPECT_TRUE(frames.take("id", attempt()));
  EXPECT_FALSE(frames.take("another id", attempt()));
}

TEST_F(CachedFramesTest, WhatOthersMadeIsNotTaken) {
  CachedFrames frames = run();
  frames.expect(kOthers);
  EXPECT_FALSE(frames.has("id"));
}

TEST_F(CachedFramesTest, AWorkerOverrulesWhatWasExpected) {
  CachedFrames frames = run();
  frames.expect(kOurs);
  frames.worker_is_ready({}, kOthers);
  EXPECT_TRUE(frames.was_mistaken());
  EXPECT_FALSE(frames.has("id"));
  EXPECT_EQ(frames.made_with(), kOthers);
}

TEST_F(CachedFramesTest, AWorkerThatIsAsExpectedChangesNothing) {
  CachedFrames frames = run();
  frames.expect(kOurs);
  frames.worker_is_ready({}, kOurs);
  EXPECT_FALSE(frames.was_mistaken());
  EXPECT_TRUE(frames.has("id"));
}

TEST_F(CachedFramesTest, OfSeveralWorkersTheFirstCounts) {
  CachedFrames frames = run();
  frames.worker_is_ready({}, kOurs);
  frames.worker_is_ready({}, kOthers);
  EXPECT_FALSE(frames.was_mistaken());
  EXPECT_EQ(frames.made_with(), kOurs);
}

TEST_F(CachedFramesTest, WhatAWorkerSaidIsExpectedOfTheNext) {
  CachedFrames first = run();
  EXPECT_FALSE(first.expected_worker());
  ReadyMessage ready;
  ready.kernel = "avx2";
  first.worker_is_ready(ready, kOurs);
  CachedFrames second = run();
  ASSERT_TRUE(second.expected_worker());
  EXPECT_EQ(second.expected_worker()->kernel, "avx2");
  EXPECT_FALSE(run(CachedFrames::Use::kAdd).expected_worker());
}

TEST_F(CachedFramesTest, AFrameIsAddedByWhatMadeItNotByWhatIsExpected) {
  CachedFrames frames = run();
  frames.expect(kOurs);
  frames.worker_is_ready({}, kOthers);
  frames.add("late", kOurs, committed_);  // taken before the worker came
  EXPECT_FALSE(frames.has("late"));
}

TEST_F(CachedFramesTest, AFrameThatIsDamagedIsForgotten) {
  CachedFrames frames = run();
  frames.expect(kOurs);
  ASSERT_TRUE(write_file(committed_ / frame_files::kLabels, "damage"));
  EXPECT_FALSE(frames.take("id", attempt()));
  EXPECT_FALSE(frames.has("id"));
}

TEST_F(CachedFramesTest, WithoutAFolderThereIsNoCache) {
  CachedFrames frames({}, CachedFrames::Use::kTakeAndAdd, settings_, Json::object(), {});
  frames.expect(kOurs);
  frames.worker_is_ready({}, kOurs);
  frames.add("id", kOurs, committed_);
  EXPECT_FALSE(frames.has("id"));
  EXPECT_FALSE(frames.expected_worker());
}

}  // namespace
}  // namespace seedframe
