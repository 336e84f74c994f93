#include "store/job_store.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class JobStoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = folder_ / "campaign.sqlite";
  }
  void TearDown() override { fs::remove_all(folder_); }

  JobStore store_with(std::int64_t frames) {
    auto store = JobStore::create(path_);
    EXPECT_TRUE(store) << store.error().message;
    std::int64_t next = 0;
    EXPECT_TRUE(store->add_frames([&]() -> Result<std::optional<FrameRow>> {
      if (next == frames) return std::nullopt;
      FrameRow row;
      row.frame = next;
      row.scene = next / 2;
      row.frame_id = "id" + std::to_string(next++);
      return row;
    }));
    return std::move(*store);
  }

  fs::path folder_;
  fs::path path_;
};

TEST_F(JobStoreTest, NewFramesArePending) {
  const JobStore store = store_with(3);
  EXPECT_EQ(store.counts()->pending, 3);
  EXPECT_EQ((*store.frame(2))->scene, 1);
  EXPECT_FALSE(store.frame(3)->has_value());
}

TEST_F(JobStoreTest, WhatWasCommittedIsThereAfterReopening) {
  {
    JobStore store = store_with(2);
    ASSERT_TRUE(store.attempt_started(0, 1, 4, 1000.0));
    ASSERT_TRUE(
        store.frame_done(0, 1, "hash", {}, {.build_s = 0.1, .render_s = 0.2, .finish_s = 0.3}));
    ASSERT_TRUE(store.set_meta("key", "value"));
  }
  const auto store = JobStore::open(path_);
  ASSERT_TRUE(store);
  EXPECT_EQ((*store->frame(0))->state, FrameState::kDone);
  EXPECT_EQ((*store->frame(0))->pixel_hash, "hash");
  EXPECT_EQ(*store->meta("key"), "value");
  EXPECT_EQ(*store->meta("other"), "");
  const auto attempts = store->attempts(0);
  ASSERT_EQ(attempts->size(), 1u);
  EXPECT_EQ(attempts->front().worker, 4);
  EXPECT_DOUBLE_EQ(attempts->front().render_s, 0.2);
  EXPECT_DOUBLE_EQ((*store->mean_timings(10))->finish_s, 0.3);
}

TEST_F(JobStoreTest, WhatIsWrittenTogetherIsWrittenAllOrNotAtAll) {
  JobStore store = store_with(3);
  ASSERT_TRUE(store.write_together(JobStore::Sync::kLater, [&]() -> Status {
    if (Status done = store.attempt_started(0, 1, 0, 1.0); !done) return done;
    return store.attempt_started(1, 1, 1, 1.0);
  }));
  EXPECT_EQ(store.counts()->running, 2);
  EXPECT_FALSE(store.write_together(JobStore::Sync::kNow, [&]() -> Status {
    if (Status done = store.frame_done(0, 1, "hash", {}, {}); !done) return done;
    return store.frame_done(2, 1, "was never started", {}, {});
  }));
  EXPECT_EQ(store.counts()->running, 2);
  ASSERT_TRUE(store.frame_done(0, 1, "hash", {}, {}));
  EXPECT_EQ(store.counts()->done, 1);
}

TEST_F(JobStoreTest, ALateAttemptCannotCommit) {
  JobStore store = store_with(1);
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 1.0));
  ASSERT_TRUE(store.attempt_failed(0, 1, "died", false));
  ASSERT_TRUE(store.attempt_started(0, 2, 1, 2.0));
  EXPECT_FALSE(store.frame_done(0, 1, "late", {}, {}));
  EXPECT_EQ((*store.frame(0))->state, FrameState::kRunning);
  ASSERT_TRUE(store.frame_done(0, 2, "right", {}, {}));
  EXPECT_FALSE(store.frame_done(0, 2, "twice", {}, {}));
  EXPECT_EQ((*store.frame(0))->pixel_hash, "right");
}

TEST_F(JobStoreTest, FailuresAreCountedAndTold) {
  JobStore store = store_with(2);
  ASSERT_TRUE(store.attempt_started(1, 1, 0, 1.0));
  ASSERT_TRUE(store.attempt_failed(1, 1, "first", false));
  EXPECT_EQ(store.counts()->pending, 2);
  ASSERT_TRUE(store.attempt_started(1, 2, 0, 2.0));
  ASSERT_TRUE(store.attempt_failed(1, 2, "second", true));
  EXPECT_EQ(store.counts()->failed, 1);
  EXPECT_EQ((*store.frame(1))->error, "second");
  const auto failures = store.recent_failures(5);
  ASSERT_EQ(failures->size(), 2u);
  EXPECT_EQ(failures->front().message, "second");
}

TEST_F(JobStoreTest, AnAttemptCanFailBeforeItStarts) {
  JobStore store = store_with(1);
  ASSERT_TRUE(store.attempt_failed(0, 1, "no request could be made", true));
  EXPECT_EQ((*store.frame(0))->state, FrameState::kFailed);
  EXPECT_EQ((*store.frame(0))->attempts, 1);
  EXPECT_EQ(store.attempts(0)->front().message, "no request could be made");
}

TEST_F(JobStoreTest, ALateFailureDoesNotUndoADoneFrame) {
  JobStore store = store_with(1);
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 1.0));
  ASSERT_TRUE(store.frame_done(0, 1, "hash", {}, {}));
  ASSERT_TRUE(store.attempt_failed(0, 1, "late", true));
  EXPECT_EQ((*store.frame(0))->state, FrameState::kDone);
}

TEST_F(JobStoreTest, ADeadSchedulersFramesBecomePending) {
  JobStore store = store_with(2);
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 1.0));
  ASSERT_TRUE(store.reset_running());
  EXPECT_EQ(store.counts()->pending, 2);
  EXPECT_EQ((*store.frame(0))->attempts, 1);
  EXPECT_EQ(store.attempts(0)->front().outcome, "failed");
}

TEST_F(JobStoreTest, TheDatasetHashIsOfAllFramesInOrder) {
  JobStore store = store_with(2);
  EXPECT_EQ(*store.dataset_hash(), "");
  ASSERT_TRUE(store.adopt(1, "b", {}));
  EXPECT_EQ(*store.dataset_hash(), "");
  ASSERT_TRUE(store.adopt(0, "a", {}));
  // printf '0 id0 a\n1 id1 b\n' | sha256sum
  EXPECT_EQ(*store.dataset_hash(),
            "596ba7bff96a42e11d6b5415763a7cad661d9e38b8ef6e2a9d2b1ce606ae61ef");
}

TEST_F(JobStoreTest, AddingFramesIsAllOrNothing) {
  auto store = JobStore::create(path_);
  int calls = 0;
  EXPECT_FALSE(store->add_frames([&]() -> Result<std::optional<FrameRow>> {
    if (calls++ == 3) return fail(ErrorKind::kInput, "no more");
    FrameRow row;
    row.frame = calls;
    return row;
  }));
  EXPECT_EQ(store->counts()->total(), 0);
}

TEST_F(JobStoreTest, RefusesWhatIsNoStore) {
  EXPECT_THAT(JobStore::open(path_).error().message, HasSubstr("there is no campaign here"));
  ASSERT_TRUE(write_file(path_, std::string(5000, 'x')));
  EXPECT_EQ(JobStore::open(path_).error().kind, ErrorKind::kCorrupt);
  fs::remove(path_);
  { const JobStore store = store_with(1); }
  EXPECT_THAT(JobStore::create(path_).error().message, HasSubstr("exists already"));
}

TEST_F(JobStoreTest, EveryTruncationOpensWithAnErrorOrWhole) {
  { const JobStore store = store_with(50); }
  const std::string whole = *read_file(path_);
  for (std::size_t size = 0; size < whole.size(); size += 509) {
    fs::remove(path_.string() + "-wal");
    fs::remove(path_.string() + "-shm");
    ASSERT_TRUE(write_file(path_, whole.substr(0, size)));
    const auto store = JobStore::open(path_);
    if (!store) continue;
    // Whatever opens must not claim frames that it cannot show.
    const auto counts = store->counts();
    if (counts) {
      EXPECT_EQ(counts->done, 0);
    }
  }
}

TEST_F(JobStoreTest, TwinsOfDoneFramesAreSummedUp) {
  JobStore store = store_with(4);
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 1.0));
  ASSERT_TRUE(store.frame_done(0, 1, "a", {1000, 0, 3}, {}));
  ASSERT_TRUE(store.adopt(1, "b", {1000, 2, 1}));
  ASSERT_TRUE(store.adopt(2, "c", {0, 0, 0}));  // was not compared
  const auto summary = store.twin_summary();
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->frames, 2);
  EXPECT_EQ(summary->frames_differing, 2);
  EXPECT_EQ(summary->sum, (TwinTally{2000, 2, 4}));
  EXPECT_EQ((*store.frame(1))->twin, (TwinTally{1000, 2, 1}));
  ASSERT_TRUE(store.reset(1));
  EXPECT_EQ(store.twin_summary()->frames, 1) << "only what is done counts";
}

}  // namespace
}  // namespace seedframe
