#include "campaign/store_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

class StoreWriterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::path(::testing::TempDir()) /
            ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(root_);
    fs::create_directories(root_ / "frames");
    files_ = std::make_unique<CampaignFiles>(root_);
    auto store = JobStore::create(files_->store());
    ASSERT_TRUE(store);
    store_ = std::make_unique<JobStore>(std::move(*store));
    std::int64_t next = 0;
    ASSERT_TRUE(store_->add_frames([&]() -> Result<std::optional<FrameRow>> {
      if (next == kFrames) return std::nullopt;
      FrameRow row;
      row.frame = next++;
      return row;
    }));
  }
  void TearDown() override { fs::remove_all(root_); }

  /// Writes `events` to the end.
  void write(const std::vector<StoreEvent>& events) {
    StoreWriter writer(*files_, *store_, [this](const StoreEvent&, const Status& status) {
      (status ? written_ : failed_)++;
    });
    for (const StoreEvent& event : events) writer.push(event);
  }

  void finish_on_disk(const FrameJob& job) {
    const fs::path attempt = files_->attempt(job.frame, job.attempt);
    fs::create_directories(attempt);
    ASSERT_TRUE(write_file_unsynced(attempt / "image.png", std::to_string(job.attempt)));
  }

  FrameRow row(std::int64_t frame) { return store_->frame(frame)->value(); }

  static constexpr std::int64_t kFrames = 200;
  fs::path root_;
  std::unique_ptr<CampaignFiles> files_;
  std::unique_ptr<JobStore> store_;
  int written_ = 0;
  int failed_ = 0;
};

TEST_F(StoreWriterTest, WhatWasPushedIsWrittenInTheEnd) {
  std::vector<StoreEvent> events;
  for (std::int64_t frame = 0; frame < kFrames; ++frame) {
    finish_on_disk({frame, 1});
    events.emplace_back(AttemptStarted{{frame, 1}, 0, 1.0});
    events.emplace_back(FrameFinished{{frame, 1}, "hash", {}, {}});
  }
  write(events);
  EXPECT_EQ(written_, 2 * kFrames);
  EXPECT_EQ(store_->counts()->done, kFrames);
  for (std::int64_t frame = 0; frame < kFrames; ++frame) {
    ASSERT_TRUE(fs::exists(files_->frame(frame) / "image.png"));
    ASSERT_FALSE(fs::exists(files_->attempt(frame, 1)));
  }
}

TEST_F(StoreWriterTest, EventsOfOneFrameKeepTheirOrder) {
  finish_on_disk({3, 2});
  write({AttemptStarted{{3, 1}, 0, 1.0}, AttemptFailed{{3, 1}, "died", false},
         AttemptStarted{{3, 2}, 1, 2.0}, FrameFinished{{3, 2}, "hash", {}, {.render_s = 0.5}}});
  EXPECT_EQ(row(3).state, FrameState::kDone);
  EXPECT_EQ(row(3).attempts, 2);
  const auto attempts = store_->attempts(3);
  ASSERT_EQ(attempts->size(), 2U);
  EXPECT_EQ(attempts->at(0).message, "died");
  EXPECT_DOUBLE_EQ(attempts->at(1).render_s, 0.5);
}

TEST_F(StoreWriterTest, AFrameWhoseFolderCannotBePutIntoPlaceIsNotDone) {
  write({AttemptStarted{{5, 1}, 0, 1.0}});
  write({FrameFinished{{5, 1}, "hash", {}, {}}});  // nothing is on disk
  EXPECT_EQ(failed_, 1);
  EXPECT_EQ(row(5).state, FrameState::kRunning);
}

TEST_F(StoreWriterTest, AnAttemptThatOnlyStartedIsVisibleToOtherReaders) {
  write({AttemptStarted{{7, 1}, 2, 1.0}});
  const auto reader = JobStore::open(files_->store());
  ASSERT_TRUE(reader);
  EXPECT_EQ((*reader->frame(7))->state, FrameState::kRunning);
}

}  // namespace
}  // namespace seedframe
