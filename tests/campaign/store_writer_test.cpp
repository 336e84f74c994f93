#include "campaign/store_writer.h"

#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

class StoreWriterTest : public ::testing::Test {
 protected:
  void SetUp() override {
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

  /// As file and pixel hash say which attempt it is.
  static FrameFinished finished(const FrameJob& job) {
    return {job, std::to_string(job.attempt), {}, {}};
  }

  FrameRow row(std::int64_t frame) { return store_->frame(frame)->value(); }

  static constexpr std::int64_t kFrames = 200;
  ScratchFolder root_;
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
  write({AttemptStarted{{3, 1}, 0, 1.0},
         AttemptFailed{{3, 1}, {Failure::kCrash, Consequence::kRetry, "died", {}}},
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

TEST_F(StoreWriterTest, ALateOrRepeatedReportChangesNeitherStoreNorFiles) {
  finish_on_disk({3, 1});
  finish_on_disk({3, 2});
  write({AttemptStarted{{3, 1}, 0, 1.0},
         AttemptFailed{{3, 1}, {Failure::kCrash, Consequence::kRetry, "hung", {}}},
         AttemptStarted{{3, 2}, 1, 2.0}, FrameFinished{{3, 1}, "late", {}, {}}});
  EXPECT_EQ(row(3).state, FrameState::kRunning);
  EXPECT_FALSE(fs::exists(files_->frame(3))) << "dropped before its folder got its name";
  write({FrameFinished{{3, 2}, "right", {}, {}}});
  write({FrameFinished{{3, 1}, "late", {}, {}}, FrameFinished{{3, 2}, "twice", {}, {}}});
  EXPECT_EQ(failed_, 0) << "dropped, which is no error";
  EXPECT_EQ(row(3).pixel_hash, "right");
  EXPECT_EQ(*read_file(files_->frame(3) / "image.png"), "2");
}

TEST_F(StoreWriterTest, ARunThatWasReplacedPutsNothingIntoPlace) {
  ASSERT_TRUE(store_->begin_run(1.0, "here", 1));
  finish_on_disk({3, 1});
  write({AttemptStarted{{3, 1}, 0, 1.0}});
  auto other = JobStore::open(files_->store());
  ASSERT_TRUE(other);
  ASSERT_TRUE(other->begin_run(2.0, "there", 2));
  write({FrameFinished{{3, 1}, "late", {}, {}}});
  EXPECT_EQ(failed_, 1);
  EXPECT_FALSE(fs::exists(files_->frame(3)));
}

// Ten thousand random orders of what attempts of three frames report, late and twice: the first
// attempt to commit stays, and its files are the ones in place.
TEST_F(StoreWriterTest, NoOrderOfReportsOverwritesACommittedFrame) {
  std::mt19937 random(1);  // of a test, not of a dataset
  constexpr int kRounds = 10'000;
  constexpr int kFramesARound = 3;
  std::vector<StoreEvent> events;
  std::map<std::int64_t, int> winner;  // attempt by frame, as it must come out
  int overwrites = 0;
  const auto flush = [&] {
    write(events);
    for (const auto& [frame, attempt] : winner) {
      const FrameRow now = row(frame);
      const auto file = read_file(files_->frame(frame) / "image.png");
      if (now.attempts != attempt || now.pixel_hash != std::to_string(attempt) || !file ||
          *file != std::to_string(attempt)) {
        ++overwrites;
      }
    }
    ASSERT_TRUE(store_->write_together(JobStore::Sync::kLater, [&]() -> Status {
      for (const auto& [frame, attempt] : winner) {
        if (Status done = store_->renew(frame, "next round"); !done) return done;
      }
      return {};
    }));
    events.clear();
    winner.clear();
  };
  std::map<std::int64_t, int> last_attempt;
  for (int round = 0; round < kRounds; ++round) {
    const std::int64_t frame = (round * kFramesARound) % kFrames;
    if (winner.contains(frame)) flush();
    const int first = last_attempt[frame] + 1;
    const int attempts = 1 + static_cast<int>(random() % 3);
    const int commits = static_cast<int>(random() % attempts);  // the one that is not given up
    for (int i = 0; i < attempts; ++i) {
      const FrameJob job = {frame, first + i};
      finish_on_disk(job);
      events.emplace_back(AttemptStarted{job, 0, 1.0});
      if (random() % 2 == 0 && i > 0) events.emplace_back(finished({frame, first + i - 1}));
      if (i < commits) {
        events.emplace_back(AttemptFailed{job, {Failure::kCrash, Consequence::kRetry, "hung", {}}});
      } else {
        events.emplace_back(finished(job));
        winner[frame] = job.attempt;
        last_attempt[frame] = job.attempt;
        break;
      }
    }
    for (int late = 0; late < 2; ++late) {
      events.emplace_back(finished({frame, first + static_cast<int>(random() % attempts)}));
      events.emplace_back(AttemptFailed{{frame, first + static_cast<int>(random() % attempts)},
                                        {Failure::kCrash, Consequence::kQuarantined, "late", {}}});
    }
  }
  flush();
  EXPECT_EQ(overwrites, 0);
  EXPECT_EQ(failed_, 0);
}

}  // namespace
}  // namespace seedframe
