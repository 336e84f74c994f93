#include "render/schedule.h"

#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

constexpr bool kFresh = true;
constexpr bool kUsed = false;

TEST(Schedule, HandsOutEveryFrameOnceInOrder) {
  Schedule schedule({{3, 0}, {1, 0}, {2, 0}}, {3, 3});
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{3, 1}));
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{1, 1}));
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{2, 1}));
  EXPECT_EQ(schedule.next(kUsed), std::nullopt);
  EXPECT_EQ(schedule.handed_out(), 3);
  EXPECT_FALSE(schedule.finished());
}

TEST(Schedule, NothingToDoIsFinished) {
  Schedule schedule({}, {3, 3});
  EXPECT_TRUE(schedule.finished());
  EXPECT_EQ(schedule.next(kFresh), std::nullopt);
}

TEST(Schedule, AFrameIsDoneWhenItsVerdictIsGood) {
  Schedule schedule({{7, 0}}, {3, 3});
  const FrameJob job = *schedule.next(kFresh);
  EXPECT_TRUE(schedule.rendered(job));
  EXPECT_EQ(schedule.unjudged(), 1);
  EXPECT_FALSE(schedule.finished());
  EXPECT_TRUE(schedule.committed(job));
  EXPECT_EQ(schedule.done(), 1);
  EXPECT_TRUE(schedule.finished());
}

TEST(Schedule, AttemptNumbersGoOnButEachRunHasItsOwnErrors) {
  Schedule schedule({{7, 3}}, {2, 3});
  const FrameJob first = *schedule.next(kFresh);
  EXPECT_EQ(first, (FrameJob{7, 4}));
  EXPECT_EQ(schedule.attempt_failed(first, Failure::kAnswered), Consequence::kRetry);
  const FrameJob second = *schedule.next(kFresh);
  EXPECT_EQ(second, (FrameJob{7, 5}));
  EXPECT_EQ(schedule.attempt_failed(second, Failure::kAnswered), Consequence::kFailed);
  EXPECT_EQ(schedule.failed(), 1);
  EXPECT_TRUE(schedule.finished());
}

TEST(Schedule, ErrorsAndCrashesAreCountedApart) {
  Schedule schedule({{7, 0}}, {2, 2});
  EXPECT_EQ(schedule.attempt_failed(*schedule.next(kFresh), Failure::kCrash), Consequence::kRetry);
  EXPECT_EQ(schedule.attempt_failed(*schedule.next(kFresh), Failure::kBadFile),
            Consequence::kRetry);
  EXPECT_EQ(schedule.crashes(7), 1);
  EXPECT_EQ(schedule.attempt_failed(*schedule.next(kFresh), Failure::kCrash),
            Consequence::kQuarantined);
  EXPECT_EQ(schedule.quarantined(), 1);
  EXPECT_EQ(schedule.failed(), 0);
  EXPECT_TRUE(schedule.finished());
}

TEST(Schedule, ASuspectsLastAttemptIsMadeAloneAndAtTheEnd) {
  Schedule schedule({{1, 1, 2}, {2, 0}, {3, 0}}, {3, 3});
  const FrameJob second = *schedule.next(kFresh);
  EXPECT_EQ(second.frame, 2) << "others first";
  const FrameJob third = *schedule.next(kFresh);
  EXPECT_EQ(schedule.workers_wanted(), 0);
  EXPECT_EQ(schedule.next(kFresh), std::nullopt) << "somebody else is at work";
  schedule.rendered(second);
  EXPECT_EQ(schedule.next(kFresh), std::nullopt);
  schedule.attempt_failed(third, Failure::kCrash);
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{3, 2})) << "a first crash needs a fresh worker only";
  schedule.rendered({3, 2});
  EXPECT_TRUE(schedule.wants_fresh_worker());
  EXPECT_EQ(schedule.workers_wanted(), 1);
  EXPECT_EQ(schedule.next(kUsed), std::nullopt);
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{1, 2}));
  schedule.attempt_failed({3, 2}, Failure::kAnswered);
  EXPECT_EQ(schedule.next(kFresh), std::nullopt) << "nobody beside it";
  EXPECT_EQ(schedule.workers_wanted(), 0);
  schedule.attempt_failed({1, 2}, Failure::kCrash);
  EXPECT_EQ(schedule.quarantined(), 1);
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{3, 3}));
}

TEST(Schedule, AnOrderlyFailureIsRetriedAnywhere) {
  Schedule schedule({{1, 0}}, {2, 2});
  schedule.attempt_failed(*schedule.next(kUsed), Failure::kAnswered);
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{1, 2}));
}

TEST(Schedule, ACrashIsRetriedOnlyInAFreshWorker) {
  Schedule schedule({{1, 0}, {2, 0}, {3, 0}}, {2, 3});
  schedule.attempt_failed(*schedule.next(kUsed), Failure::kCrash);
  EXPECT_TRUE(schedule.has_retry_for_fresh_worker());
  EXPECT_FALSE(schedule.wants_fresh_worker()) << "there is other work";
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{2, 1}));
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{1, 2})) << "before what waits in line";
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{3, 1}));
}

TEST(Schedule, WantsAFreshWorkerWhenOnlyRetriesAreLeft) {
  Schedule schedule({{1, 0}}, {2, 3});
  schedule.attempt_failed(*schedule.next(kUsed), Failure::kCrash);
  EXPECT_TRUE(schedule.wants_fresh_worker());
  EXPECT_EQ(schedule.next(kUsed), std::nullopt);
  EXPECT_FALSE(schedule.finished());
}

TEST(Schedule, ABadFileIsRetriedNextAndTheLastTimeByAFreshWorker) {
  Schedule schedule({{1, 0}, {2, 0}}, {3, 3});
  schedule.attempt_failed(*schedule.next(kUsed), Failure::kBadFile);
  const FrameJob second = *schedule.next(kUsed);
  EXPECT_EQ(second, (FrameJob{1, 2}));
  schedule.attempt_failed(second, Failure::kBadFile);
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{2, 1}));
  EXPECT_EQ(schedule.next(kUsed), std::nullopt);
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{1, 3}));
}

TEST(Schedule, ABadVerdictIsAFailedAttempt) {
  Schedule schedule({{1, 0}}, {2, 2});
  const FrameJob job = *schedule.next(kFresh);
  schedule.rendered(job);
  EXPECT_TRUE(schedule.attempt_failed(job, Failure::kBadFile).has_value());
  EXPECT_EQ(schedule.unjudged(), 0);
  EXPECT_EQ(schedule.next(kFresh), (FrameJob{1, 2}));
}

TEST(Schedule, LateAndRepeatedAnswersChangeNothing) {
  Schedule schedule({{1, 0}}, {3, 3});
  const FrameJob job = *schedule.next(kFresh);
  EXPECT_FALSE(schedule.committed(job)) << "not rendered yet";
  schedule.attempt_failed(job, Failure::kBadFile);
  EXPECT_FALSE(schedule.rendered(job)) << "the attempt has failed already";
  EXPECT_FALSE(schedule.attempt_failed(job, Failure::kBadFile).has_value());
  const FrameJob second = *schedule.next(kFresh);
  EXPECT_FALSE(schedule.rendered(job)) << "that is the first attempt's answer";
  EXPECT_TRUE(schedule.rendered(second));
  EXPECT_TRUE(schedule.committed(second));
  EXPECT_FALSE(schedule.committed(second));
  EXPECT_FALSE(schedule.attempt_failed(second, Failure::kAnswered).has_value())
      << "committed stays committed";
  EXPECT_EQ(schedule.done(), 1);
  EXPECT_EQ(schedule.failed(), 0);
}

TEST(Schedule, AWithdrawnJobCostsNoAttemptAndIsNext) {
  Schedule schedule({{1, 0}, {2, 0}}, {3, 3});
  const FrameJob job = *schedule.next(kUsed);
  EXPECT_TRUE(schedule.withdraw(job));
  EXPECT_FALSE(schedule.withdraw(job));
  EXPECT_EQ(schedule.next(kUsed), (FrameJob{1, 1}));
}

TEST(Schedule, FailingForGoodSkipsTheOtherAttempts) {
  Schedule schedule({{1, 0}}, {3, 3});
  const FrameJob job = *schedule.next(kUsed);
  EXPECT_TRUE(schedule.fail_for_good(job));
  EXPECT_FALSE(schedule.fail_for_good(job));
  EXPECT_EQ(schedule.failed(), 1);
  EXPECT_TRUE(schedule.finished());
}

TEST(Schedule, DrainingWaitsForWhatIsUnderWay) {
  Schedule schedule({{1, 0}, {2, 0}, {3, 0}}, {3, 3});
  const FrameJob first = *schedule.next(kUsed);
  const FrameJob second = *schedule.next(kUsed);
  schedule.drain();
  EXPECT_EQ(schedule.next(kFresh), std::nullopt);
  EXPECT_FALSE(schedule.finished());
  schedule.rendered(first);
  schedule.committed(first);
  schedule.attempt_failed(second, Failure::kCrash);
  EXPECT_FALSE(schedule.wants_fresh_worker());
  EXPECT_TRUE(schedule.finished());
  EXPECT_EQ(schedule.waiting(), 2) << "frames 2 and 3 are left for the next run";
}

// Every sequence of outcomes of two frames ends with each frame done, failed or quarantined, its
// attempts numbered in order and no more of them than its errors and crashes allow.
TEST(Schedule, EverySequenceOfOutcomesEndsWell) {
  constexpr int kOutcomes = 5;  // good, answered, crashed, bad verdict, withdrawn
  constexpr int kSteps = 7;
  int sequences = 1;
  for (int i = 0; i < kSteps; ++i) sequences *= kOutcomes;
  for (int sequence = 0; sequence < sequences; ++sequence) {
    Schedule schedule({{0, 0}, {1, 0}}, {2, 3});
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
        constexpr Failure kFailures[] = {Failure::kAnswered, Failure::kAnswered, Failure::kCrash,
                                         Failure::kBadFile};
        schedule.attempt_failed(job, kFailures[outcome]);
      }
    }
    ASSERT_EQ(schedule.done() + schedule.failed() + schedule.quarantined(), 2);
    ASSERT_LE(attempts[0], 4);
    ASSERT_LE(attempts[1], 4);
  }
}

// Ten thousand random interleavings of what two workers, their verdicts and ghosts of old attempts
// may say: an answer that is not the open attempt's never changes anything.
TEST(Schedule, LateReportsAgainstNewAttemptsNeverCount) {
  std::mt19937 random(1);  // of a test, not of a dataset
  const auto pick = [&](std::size_t below) { return random() % below; };
  for (int round = 0; round < 10'000; ++round) {
    Schedule schedule({{0, 0}, {1, 0}, {2, 0}}, {3, 3});
    std::set<FrameJob> at_worker, unjudged;
    std::vector<FrameJob> ever;
    std::map<std::int64_t, int> committed;
    while (!schedule.finished()) {
      if (at_worker.size() < 2 && pick(2) == 0) {
        if (const auto job = schedule.next(pick(2) == 0)) {
          at_worker.insert(*job);
          ever.push_back(*job);
        }
      }
      if (ever.empty()) continue;
      const FrameJob job = ever[pick(ever.size())];  // mostly a late or repeated report
      const bool held = at_worker.contains(job);
      const bool waits = unjudged.contains(job);
      switch (pick(4)) {
        case 0:
          ASSERT_EQ(schedule.rendered(job), held);
          if (held) unjudged.insert(job);
          at_worker.erase(job);
          break;
        case 1:
          ASSERT_EQ(schedule.committed(job), waits);
          if (waits) ++committed[job.frame];
          unjudged.erase(job);
          break;
        case 2:
          ASSERT_EQ(schedule.attempt_failed(job, Failure::kCrash).has_value(), held || waits);
          at_worker.erase(job);
          unjudged.erase(job);
          break;
        default:
          ASSERT_EQ(schedule.attempt_failed(job, Failure::kBadFile).has_value(), held || waits);
          at_worker.erase(job);
          unjudged.erase(job);
      }
    }
    for (const auto& [frame, times] : committed) ASSERT_EQ(times, 1) << "frame " << frame;
    ASSERT_EQ(schedule.done(), static_cast<std::int64_t>(committed.size()));
    ASSERT_EQ(schedule.done() + schedule.failed() + schedule.quarantined(), 3);
  }
}

}  // namespace
}  // namespace seedframe
