#include "render/schedule.h"

#include <set>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

constexpr bool kFresh = true;
constexpr bool kUsed = false;

TEST(Schedule, HandsOutEveryFrameOnceInOrder) {
  Schedule schedule({{3, 0}, {1, 0}, {2, 0}}, 3);
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{3, 1}));
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{1, 1}));
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{2, 1}));
  EXPECT_EQ(schedule.next(kUsed), std::nullopt);
  EXPECT_EQ(schedule.handed_out(), 3);
  EXPECT_FALSE(schedule.finished());
}

TEST(Schedule, NothingToDoIsFinished) {
  Schedule schedule({}, 3);
  EXPECT_TRUE(schedule.finished());
  EXPECT_EQ(schedule.next(kFresh), std::nullopt);
}

TEST(Schedule, AFrameIsDoneWhenItsVerdictIsGood) {
  Schedule schedule({{7, 0}}, 3);
  const FrameJob job = *schedule.next(kFresh);
  EXPECT_TRUE(schedule.rendered(job));
  EXPECT_EQ(schedule.unjudged(), 1);
  EXPECT_FALSE(schedule.finished());
  EXPECT_TRUE(schedule.committed(job));
  EXPECT_EQ(schedule.done(), 1);
  EXPECT_TRUE(schedule.finished());
}

TEST(Schedule, AttemptNumbersGoOnButEachRunHasItsOwn) {
  Schedule schedule({{7, 3}}, 2);
  const FrameJob first = *schedule.next(kFresh);
  EXPECT_EQ(first, (FrameJob{7, 4}));
  EXPECT_FALSE(schedule.is_last_attempt(first));
  EXPECT_TRUE(schedule.attempt_failed(first, RetryIn::kAnyWorker));
  const FrameJob second = *schedule.next(kFresh);
  EXPECT_EQ(second, (FrameJob{7, 5}));
  EXPECT_TRUE(schedule.is_last_attempt(second));
  EXPECT_TRUE(schedule.attempt_failed(second, RetryIn::kAnyWorker));
  EXPECT_EQ(schedule.failed(), 1);
  EXPECT_TRUE(schedule.finished());
}

TEST(Schedule, AnOrderlyFailureIsRetriedAnywhere) {
  Schedule schedule({{1, 0}}, 2);
  schedule.attempt_failed(*schedule.next(kUsed), RetryIn::kAnyWorker);
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{1, 2}));
}

TEST(Schedule, ACrashIsRetriedOnlyInAFreshWorker) {
  Schedule schedule({{1, 0}, {2, 0}, {3, 0}}, 2);
  schedule.attempt_failed(*schedule.next(kUsed), RetryIn::kFreshWorker);
  EXPECT_TRUE(schedule.has_retry_for_fresh_worker());
  EXPECT_FALSE(schedule.wants_fresh_worker()) << "there is other work";
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{2, 1}));
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{1, 2})) << "before what waits in line";
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{3, 1}));
}

TEST(Schedule, WantsAFreshWorkerWhenOnlyRetriesAreLeft) {
  Schedule schedule({{1, 0}}, 2);
  schedule.attempt_failed(*schedule.next(kUsed), RetryIn::kFreshWorker);
  EXPECT_TRUE(schedule.wants_fresh_worker());
  EXPECT_EQ(schedule.next(kUsed), std::nullopt);
  EXPECT_FALSE(schedule.finished());
}

TEST(Schedule, ABadVerdictIsAFailedAttempt) {
  Schedule schedule({{1, 0}}, 2);
  const FrameJob job = *schedule.next(kFresh);
  schedule.rendered(job);
  EXPECT_TRUE(schedule.attempt_failed(job, RetryIn::kFreshWorker));
  EXPECT_EQ(schedule.unjudged(), 0);
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{1, 2}));
}

TEST(Schedule, LateAndRepeatedAnswersChangeNothing) {
  Schedule schedule({{1, 0}}, 3);
  const FrameJob job = *schedule.next(kFresh);
  EXPECT_FALSE(schedule.committed(job)) << "not rendered yet";
  schedule.attempt_failed(job, RetryIn::kFreshWorker);
  EXPECT_FALSE(schedule.rendered(job)) << "the attempt has failed already";
  EXPECT_FALSE(schedule.attempt_failed(job, RetryIn::kFreshWorker));
  const FrameJob second = *schedule.next(kFresh);
  EXPECT_FALSE(schedule.rendered(job)) << "that is the first attempt's answer";
  EXPECT_TRUE(schedule.rendered(second));
  EXPECT_TRUE(schedule.committed(second));
  EXPECT_FALSE(schedule.committed(second));
  EXPECT_FALSE(schedule.attempt_failed(second, RetryIn::kAnyWorker)) << "committed stays committed";
  EXPECT_EQ(schedule.done(), 1);
  EXPECT_EQ(schedule.failed(), 0);
}

TEST(Schedule, AWithdrawnJobCostsNoAttemptAndIsNext) {
  Schedule schedule({{1, 0}, {2, 0}}, 3);
  const FrameJob job = *schedule.next(kUsed);
  EXPECT_TRUE(schedule.withdraw(job));
  EXPECT_FALSE(schedule.withdraw(job));
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{1, 1}));
}

TEST(Schedule, FailingForGoodSkipsTheOtherAttempts) {
  Schedule schedule({{1, 0}}, 3);
  const FrameJob job = *schedule.next(kUsed);
  EXPECT_TRUE(schedule.fail_for_good(job));
  EXPECT_FALSE(schedule.fail_for_good(job));
  EXPECT_EQ(schedule.failed(), 1);
  EXPECT_TRUE(schedule.finished());
}

TEST(Schedule, DrainingWaitsForWhatIsUnderWay) {
  Schedule schedule({{1, 0}, {2, 0}, {3, 0}}, 3);
  const FrameJob first = *schedule.next(kUsed);
  const FrameJob second = *schedule.next(kUsed);
  schedule.drain();
  EXPECT_EQ(schedule.next(kFresh), std::nullopt);
  EXPECT_FALSE(schedule.finished());
  schedule.rendered(first);
  schedule.committed(first);
  schedule.attempt_failed(second, RetryIn::kFreshWorker);
  EXPECT_FALSE(schedule.wants_fresh_worker());
  EXPECT_TRUE(schedule.finished());
  EXPECT_EQ(schedule.waiting(), 2) << "frames 2 and 3 are left for the next run";
}

// Every sequence of outcomes of two frames with up to three attempts ends with each frame either
// done or failed after at most three attempts, all numbered in order.
TEST(Schedule, EverySequenceOfOutcomesEndsWell) {
  constexpr int kOutcomes = 5;  // good, failed, crashed, bad verdict, withdrawn
  constexpr int kSteps = 6;
  int sequences = 1;
  for (int i = 0; i < kSteps; ++i) sequences *= kOutcomes;
  for (int sequence = 0; sequence < sequences; ++sequence) {
    Schedule schedule({{0, 0}, {1, 0}}, 3);
    int attempts[2] = {0, 0};
    int code = sequence;
    while (!schedule.finished()) {
      const FrameJob job = *schedule.next(kFresh);
      ASSERT_EQ(job.attempt, attempts[job.frame] + 1);
      const int outcome = code % kOutcomes;
      code /= kOutcomes;
      if (outcome == 4) {
        schedule.withdraw(job);
        continue;
      }
      ++attempts[job.frame];
      if (outcome == 0 || outcome == 3) schedule.rendered(job);
      if (outcome == 0) {
        schedule.committed(job);
      } else {
        schedule.attempt_failed(job, outcome == 1 ? RetryIn::kAnyWorker : RetryIn::kFreshWorker);
      }
    }
    ASSERT_EQ(schedule.done() + schedule.failed(), 2);
    ASSERT_LE(attempts[0], 3);
    ASSERT_LE(attempts[1], 3);
  }
}

}  // namespace
}  // namespace seedframe
