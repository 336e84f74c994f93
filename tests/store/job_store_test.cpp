#include "store/job_store.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class JobStoreTest : public ::testing::Test {
 protected:
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

  const ScratchFolder folder_;
  const fs::path path_ = folder_ / "campaign.sqlite";
};

TEST_F(JobStoreTest, NewFramesArePending) {
  const JobStore store = store_with(3);
  EXPECT_EQ(store.counts()->pending, 3);
  EXPECT_EQ((*store.frame(2))->scene, 1);
  EXPECT_FALSE(store.frame(3)->has_value());
}

TEST_F(JobStoreTest, AttemptsKnowWhatTheyWereMadeWith) {
  JobStore store = store_with(4);
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 1.0, R"({"kernel":"avx2"})"));
  ASSERT_TRUE(store.attempt_started(1, 1, 0, 1.0, R"({"kernel":"avx"})"));
  ASSERT_TRUE(store.attempt_started(2, 1, 0, 1.0, R"({"kernel":"avx2"})"));
  ASSERT_TRUE(store.attempt_started(3, 1, 0, 1.0));
  EXPECT_THAT(*store.provenances(), ElementsAre(R"({"kernel":"avx2"})", R"({"kernel":"avx"})"))
      << "each once";
  EXPECT_EQ(store.attempts(2)->front().provenance, R"({"kernel":"avx2"})");
  EXPECT_EQ(store.attempts(3)->front().provenance, "");
}

TEST_F(JobStoreTest, WhatWasCommittedIsThereAfterReopening) {
  {
    JobStore store = store_with(2);
    ASSERT_TRUE(store.attempt_started(0, 1, 4, 1000.0));
    ASSERT_TRUE(store.frame_done(0, 1, {"hash", "", {}},
                                 {.build_s = 0.1, .render_s = 0.2, .finish_s = 0.3}));
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

TEST_F(JobStoreTest, TellsHowFarTheWorkersOfTheLastRunAre) {
  JobStore store = store_with(7);
  ASSERT_TRUE(store.attempt_started(0, 1, 5, 1.0));
  ASSERT_TRUE(store.frame_done(0, 1, {"hash", "", {}}, {.build_s = 9.0}));
  ASSERT_TRUE(store.begin_run(50.0, "host", 2));
  EXPECT_EQ(store.run_progress()->began, 0.0);
  EXPECT_TRUE(store.run_progress()->workers.empty()) << "worker 5 was of an earlier run";
  ASSERT_TRUE(store.attempt_started(1, 1, 0, 100.0));
  ASSERT_TRUE(store.attempt_started(2, 1, 1, 101.0));
  ASSERT_TRUE(store.attempt_started(3, 1, 0, 102.0));
  ASSERT_TRUE(store.attempt_started(4, 1, 0, 103.0));
  ASSERT_TRUE(store.attempt_started(5, 1, kNoWorker, 90.0));
  ASSERT_TRUE(store.frame_done(1, 1, {"hash", "", {}}, {.build_s = 0.5, .render_s = 1.5}));
  ASSERT_TRUE(store.frame_done(5, 1, {"hash", "", {}}, {}));
  ASSERT_TRUE(store.attempt_failed(2, 1, AttemptOutcome::kError, FrameState::kPending, "no"));
  const auto progress = store.run_progress();
  ASSERT_TRUE(progress) << progress.error().message;
  EXPECT_EQ(progress->began, 100.0) << "what was found on this machine is no worker's";
  EXPECT_EQ(progress->done, 1);
  ASSERT_EQ(progress->workers.size(), 2U);
  EXPECT_EQ(progress->workers[0].worker, 0);
  EXPECT_EQ(progress->workers[0].done, 1);
  EXPECT_DOUBLE_EQ(progress->workers[0].frame_s, 2.0);
  EXPECT_EQ(progress->workers[0].frame, 3) << "the first of those that wait for it";
  EXPECT_EQ(progress->workers[0].since, 102.0);
  EXPECT_EQ(progress->workers[1].failed, 1);
  EXPECT_FALSE(progress->workers[1].frame);
}

TEST_F(JobStoreTest, WhatIsWrittenTogetherIsWrittenAllOrNotAtAll) {
  JobStore store = store_with(3);
  ASSERT_TRUE(store.write_together(JobStore::Sync::kLater, [&]() -> Status {
    if (Status done = store.attempt_started(0, 1, 0, 1.0); !done) return done;
    return store.attempt_started(1, 1, 1, 1.0);
  }));
  EXPECT_EQ(store.counts()->running, 2);
  EXPECT_FALSE(store.write_together(JobStore::Sync::kNow, [&]() -> Status {
    if (Status done = store.frame_done(0, 1, {"hash", "", {}}, {}); !done) return done;
    return store.frame_done(2, 1, {"was never started", "", {}}, {});
  }));
  EXPECT_EQ(store.counts()->running, 2);
  ASSERT_TRUE(store.frame_done(0, 1, {"hash", "", {}}, {}));
  EXPECT_EQ(store.counts()->done, 1);
}

TEST_F(JobStoreTest, ALateAttemptCannotCommit) {
  JobStore store = store_with(1);
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 1.0));
  ASSERT_TRUE(store.attempt_failed(0, 1, AttemptOutcome::kError, FrameState::kPending, "died"));
  ASSERT_TRUE(store.attempt_started(0, 2, 1, 2.0));
  EXPECT_FALSE(store.frame_done(0, 1, {"late", "", {}}, {}));
  EXPECT_EQ((*store.frame(0))->state, FrameState::kRunning);
  ASSERT_TRUE(store.frame_done(0, 2, {"right", "", {}}, {}));
  EXPECT_FALSE(store.frame_done(0, 2, {"twice", "", {}}, {}));
  EXPECT_EQ((*store.frame(0))->pixel_hash, "right");
}

TEST_F(JobStoreTest, FailuresAreCountedAndTold) {
  JobStore store = store_with(2);
  ASSERT_TRUE(store.attempt_started(1, 1, 0, 1.0));
  ASSERT_TRUE(store.attempt_failed(1, 1, AttemptOutcome::kError, FrameState::kPending, "first"));
  EXPECT_EQ(store.counts()->pending, 2);
  ASSERT_TRUE(store.attempt_started(1, 2, 0, 2.0));
  ASSERT_TRUE(store.attempt_failed(1, 2, AttemptOutcome::kError, FrameState::kFailed, "second"));
  EXPECT_EQ(store.counts()->failed, 1);
  EXPECT_EQ((*store.frame(1))->error, "second");
  const auto failures = store.recent_failures(5);
  ASSERT_EQ(failures->size(), 2u);
  EXPECT_EQ(failures->front().message, "second");
}

TEST_F(JobStoreTest, AnAttemptCanFailBeforeItStarts) {
  JobStore store = store_with(1);
  ASSERT_TRUE(store.attempt_failed(0, 1, AttemptOutcome::kError, FrameState::kFailed,
                                   "no request could be made"));
  EXPECT_EQ((*store.frame(0))->state, FrameState::kFailed);
  EXPECT_EQ((*store.frame(0))->attempts, 1);
  EXPECT_EQ(store.attempts(0)->front().message, "no request could be made");
}

TEST_F(JobStoreTest, ALateFailureDoesNotUndoADoneFrame) {
  JobStore store = store_with(1);
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 1.0));
  ASSERT_TRUE(store.frame_done(0, 1, {"hash", "", {}}, {}));
  ASSERT_TRUE(store.attempt_failed(0, 1, AttemptOutcome::kError, FrameState::kFailed, "late"));
  EXPECT_EQ((*store.frame(0))->state, FrameState::kDone);
}

TEST_F(JobStoreTest, ADeadSchedulersFramesBecomePending) {
  JobStore store = store_with(2);
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 1.0));
  ASSERT_TRUE(store.begin_run(1.0, "here", 2));
  EXPECT_EQ(store.counts()->pending, 2);
  EXPECT_EQ((*store.frame(0))->attempts, 1);
  EXPECT_EQ(store.attempts(0)->front().outcome, AttemptOutcome::kLost);
}

TEST_F(JobStoreTest, CrashesAreCountedAndQuarantineIsAState) {
  JobStore store = store_with(2);
  for (int attempt = 1; attempt <= 2; ++attempt) {
    ASSERT_TRUE(store.attempt_started(0, attempt, 0, 1.0));
    ASSERT_TRUE(store.attempt_failed(0, attempt, AttemptOutcome::kCrash,
                                     attempt == 1 ? FrameState::kPending : FrameState::kQuarantined,
                                     "died"));
  }
  EXPECT_EQ((*store.frame(0))->crashes, 2);
  EXPECT_EQ(store.counts()->quarantined, 1);
  ASSERT_EQ(store.frames_in(FrameState::kQuarantined, 5)->size(), 1u);
  EXPECT_EQ(store.attempts(0)->back().outcome, AttemptOutcome::kCrash);
  ASSERT_TRUE(store.reset(0));
  EXPECT_EQ((*store.frame(0))->crashes, 0) << "whoever asks for it again has mended something";
}

TEST_F(JobStoreTest, AFailureThatIsReportedTwiceCountsOnce) {
  JobStore store = store_with(1);
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 1.0));
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(store.attempt_failed(0, 1, AttemptOutcome::kCrash, FrameState::kPending, "died"));
  }
  EXPECT_EQ((*store.frame(0))->crashes, 1);
  ASSERT_TRUE(store.attempt_started(0, 2, 0, 1.0));
  ASSERT_TRUE(store.attempt_failed(0, 1, AttemptOutcome::kCrash, FrameState::kFailed, "late"));
  EXPECT_EQ((*store.frame(0))->state, FrameState::kRunning) << "of the second attempt";
}

TEST_F(JobStoreTest, ARunThatWasReplacedWritesNothingMore) {
  JobStore old = store_with(2);
  ASSERT_TRUE(old.begin_run(1.0, "here", 1));
  ASSERT_TRUE(old.attempt_started(0, 1, 0, 1.0));
  auto now = JobStore::open(path_);
  ASSERT_TRUE(now);
  ASSERT_TRUE(now->begin_run(2.0, "there", 2));
  for (const Status& late :
       {old.frame_done(0, 1, {"late", "", {}}, {}), old.attempt_started(1, 1, 0, 1.0), old.reset(0),
        old.attempt_failed(0, 1, AttemptOutcome::kCrash, FrameState::kQuarantined, "late"),
        old.adopt(0, {"late", "", {}}), old.renew(0, "late"),
        old.write_together(JobStore::Sync::kNow, [] { return Status(); })}) {
    ASSERT_FALSE(late);
    EXPECT_THAT(late.error().message, HasSubstr("another seedframe has taken the campaign over"));
  }
  EXPECT_EQ(now->counts()->pending, 2);
  ASSERT_TRUE(now->attempt_started(0, 2, 0, 3.0));
  EXPECT_TRUE(*now->is_under_way(0, 2));
  EXPECT_FALSE(*now->is_under_way(0, 1));
}

TEST_F(JobStoreTest, ARenewedFrameIsPendingWithItsNewIdentity) {
  JobStore store = store_with(1);
  ASSERT_TRUE(store.adopt(0, {"hash", "finger", {}}));
  EXPECT_EQ((*store.frame(0))->fingerprint, "finger");
  ASSERT_TRUE(store.renew(0, "new"));
  const FrameRow row = **store.frame(0);
  EXPECT_EQ(row.state, FrameState::kPending);
  EXPECT_EQ(row.frame_id, "new");
  EXPECT_EQ(row.pixel_hash + row.fingerprint, "");
}

// The log of a store that a power loss cut or emptied anywhere: whatever opens holds the beginning
// of what was written, never a frame done out of order.
TEST_F(JobStoreTest, ALogCutOrEmptiedAnywhereHoldsABeginningOfWhatWasWritten) {
  constexpr int kFrames = 20;
  { const JobStore store = store_with(kFrames); }
  const std::string log_path = path_.string() + "-wal";
  std::string log, base;
  {
    auto store = JobStore::open(path_);
    ASSERT_TRUE(store);
    base = *read_file(path_);
    for (int frame = 0; frame < kFrames; ++frame) {
      ASSERT_TRUE(store->attempt_started(frame, 1, 0, 1.0));
      ASSERT_TRUE(store->frame_done(frame, 1, {"hash", "", {}}, {}));
    }
    log = *read_file(log_path);
  }
  std::int64_t most_done = 0;
  const auto check = [&](const std::string& bytes) {
    fs::remove(path_.string() + "-shm");
    ASSERT_TRUE(write_file_unsynced(path_, base));
    ASSERT_TRUE(write_file_unsynced(log_path, bytes));
    const auto store = JobStore::open(path_);
    ASSERT_TRUE(store) << store.error().message;
    bool before_done = true;
    std::int64_t done = 0;
    ASSERT_TRUE(store->for_each_frame([&](const FrameRow& row) -> Status {
      const bool is_done = row.state == FrameState::kDone;
      EXPECT_TRUE(before_done || !is_done) << "frame " << row.frame;
      before_done = is_done;
      done += is_done ? 1 : 0;
      return {};
    }));
    most_done = std::max(most_done, done);
  };
  for (std::size_t size = 0; size < log.size(); size += 997) check(log.substr(0, size));
  for (std::size_t at = 0; at < log.size(); at += 2048) {
    std::string emptied = log;
    emptied.replace(at, 512, std::min<std::size_t>(512, log.size() - at), '\0');
    check(emptied);
  }
  check(log);
  EXPECT_EQ(most_done, kFrames);
}

TEST_F(JobStoreTest, TheDatasetHashIsOfAllFramesInOrder) {
  JobStore store = store_with(2);
  EXPECT_EQ(*store.dataset_hash(), "");
  ASSERT_TRUE(store.adopt(1, {"b", "", {}}));
  EXPECT_EQ(*store.dataset_hash(), "");
  ASSERT_TRUE(store.adopt(0, {"a", "", {}}));
  // printf '0 id0 a\n1 id1 b\n' | sha256sum
  const std::string scene = "596ba7bff96a42e11d6b5415763a7cad661d9e38b8ef6e2a9d2b1ce606ae61ef";
  ASSERT_EQ(store.scene_hashes()->size(), 1u);
  EXPECT_EQ(store.scene_hashes()->front().hash, scene);
  EXPECT_EQ(store.scene_hashes()->front().frames, 2);
  // printf "0 $scene\n" | sha256sum
  EXPECT_EQ(*store.dataset_hash(),
            "cc969f4d309cdd7926fb3bd2e551e0f58af71aa45e90d54e9e49767678fba50e");
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
  ASSERT_TRUE(store.frame_done(0, 1, {"a", "", {1000, 0, 3}}, {}));
  ASSERT_TRUE(store.adopt(1, {"b", "", {1000, 2, 1}}));
  ASSERT_TRUE(store.adopt(2, {"c", "", {0, 0, 0}}));  // was not compared
  const auto summary = store.twin_summary();
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->frames, 2);
  EXPECT_EQ(summary->frames_differing, 2);
  EXPECT_EQ(summary->sum, (TwinTally{2000, 2, 4}));
  EXPECT_EQ((*store.frame(1))->twin, (TwinTally{1000, 2, 1}));
  ASSERT_TRUE(store.reset(1));
  EXPECT_EQ(store.twin_summary()->frames, 1) << "only what is done counts";
}

/// What `body` returns in a process that root's rights do not help.
int as_nobody(const std::function<int()>& body) {
  constexpr uid_t kNobody = 65534;
  const pid_t pid = ::fork();
  if (pid == 0) {
    const bool is_root = ::geteuid() == 0;
    ::_exit(is_root && ::setuid(kNobody) != 0 ? 127 : body());
  }
  int status = 0;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(JobStoreTest, CanBeReadWhereNothingCanBeWritten) {
  const fs::path folder = folder_ / "100% read only?";
  fs::create_directory(folder);
  {
    JobStore made = store_with(3);
    ASSERT_TRUE(made.set_meta("key", "value"));
  }
  fs::rename(path_, folder / "campaign.sqlite");
  ASSERT_TRUE(JobStore::open(folder / "campaign.sqlite"));  // from now on it is in WAL mode
  fs::permissions(folder_.path(), fs::perms(0755));
  fs::permissions(folder, fs::perms(0555));
  const int code = as_nobody([&] {
    auto store = JobStore::open(folder / "campaign.sqlite");
    if (!store) {
      std::fprintf(stderr, "%s\n", store.error().message.c_str());
      return 1;
    }
    if (store->counts()->pending != 3 || *store->meta("key") != "value") return 2;
    return store->set_meta("key", "other") ? 3 : 0;
  });
  fs::permissions(folder, fs::perms(0755));
  EXPECT_EQ(code, 0);
}

}  // namespace
}  // namespace seedframe
