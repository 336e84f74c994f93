#include "campaign/pauses.h"

#include <deque>
#include <optional>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

using namespace std::chrono_literals;

const Error kFull{ErrorKind::kExhausted, "the disk is full"};

/// Runs that end as they are told to, and a clock that only sleeping moves.
class FakeRun : public PausableRun {
 public:
  struct Ending {
    std::int64_t done = 0;       ///< of the frames that it is given, the first ones
    std::optional<Error> error;  ///< none: it ends well
  };

  Result<RunSummary> run(const std::vector<PendingFrame>& frames) override {
    ran.push_back(frames.size());
    const Ending ending = endings.front();
    if (endings.size() > 1) endings.pop_front();
    done += ending.done;
    if (ending.error) return tl::unexpected(*ending.error);
    return RunSummary{.committed = ending.done};
  }
  std::int64_t frames_done() const override { return done; }
  bool is_drained() const override { return drained_at && now() >= *drained_at; }
  bool has_room() override { return now() >= room_at; }
  Result<std::vector<PendingFrame>> reopen(const std::vector<PendingFrame>& wanted) override {
    if (!reopen_errors.empty()) {
      const Error error = reopen_errors.front();
      reopen_errors.pop_front();
      return tl::unexpected(error);
    }
    const auto done_since = static_cast<std::size_t>(done - done_before_);
    done_before_ = done;
    return std::vector<PendingFrame>(wanted.size() - done_since);
  }
  void tell_pause(const Error&) override { ++pauses; }
  void tell_end_of_pause(std::size_t) override { ++ends_of_pauses; }
  std::chrono::steady_clock::time_point now() const override { return now_; }
  void sleep(std::chrono::milliseconds time) override { now_ += time; }

  std::chrono::steady_clock::time_point at(std::chrono::milliseconds time) const {
    return std::chrono::steady_clock::time_point() + time;
  }

  std::deque<Ending> endings;
  std::deque<Error> reopen_errors;
  std::chrono::steady_clock::time_point room_at = at(0ms);
  std::optional<std::chrono::steady_clock::time_point> drained_at;
  std::vector<std::size_t> ran;
  std::int64_t done = 0;
  int pauses = 0;
  int ends_of_pauses = 0;

 private:
  std::chrono::steady_clock::time_point now_ = at(0ms);
  std::int64_t done_before_ = 0;
};

class Pauses : public ::testing::Test {
 protected:
  Result<RunSummary> run(std::size_t frames, std::chrono::duration<double> limit = 600s) {
    return run_with_pauses(fake_, std::vector<PendingFrame>(frames), limit);
  }
  FakeRun fake_;
};

TEST_F(Pauses, ARunThatEndsWellHasNone) {
  fake_.endings = {{12, {}}};
  const Result<RunSummary> summary = run(12);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->committed, 12);
  EXPECT_EQ(fake_.pauses, 0);
}

TEST_F(Pauses, AFullDiskIsWaitedForAndTheRestIsRun) {
  fake_.endings = {{5, kFull}, {7, {}}};
  fake_.room_at = fake_.at(30s);
  const Result<RunSummary> summary = run(12);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(fake_.ran, (std::vector<std::size_t>{12, 7}));
  EXPECT_EQ(fake_.pauses, 1);
  EXPECT_EQ(fake_.ends_of_pauses, 1);
  EXPECT_EQ(fake_.now(), fake_.at(30s));
}

TEST_F(Pauses, OtherErrorsAreNotWaitedFor) {
  fake_.endings = {{5, Error{ErrorKind::kEnvironment, "no Blender"}}};
  const Result<RunSummary> summary = run(12);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().message, "no Blender");
  EXPECT_EQ(fake_.pauses, 0);
}

TEST_F(Pauses, TheErrorIsReturnedAfterTheLimit) {
  fake_.endings = {{5, kFull}};
  fake_.room_at = fake_.at(1h);
  const Result<RunSummary> summary = run(12, 60s);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().message, kFull.message);
  EXPECT_EQ(fake_.ran.size(), 1u);
  EXPECT_EQ(fake_.now(), fake_.at(60s));
  EXPECT_EQ(fake_.ends_of_pauses, 0);
}

TEST_F(Pauses, ALimitOfZeroMeansNone) {
  fake_.endings = {{5, kFull}};
  EXPECT_FALSE(run(12, 0s));
  EXPECT_EQ(fake_.pauses, 0);
}

TEST_F(Pauses, DrainingEndsAPause) {
  fake_.endings = {{5, kFull}};
  fake_.room_at = fake_.at(1h);
  fake_.drained_at = fake_.at(10s);
  EXPECT_FALSE(run(12));
  EXPECT_EQ(fake_.now(), fake_.at(10s));
}

TEST_F(Pauses, RoomThatComesTogetherWithTheDrainIsNotUsed) {
  fake_.endings = {{5, kFull}};
  fake_.room_at = fake_.at(10s);
  fake_.drained_at = fake_.at(10s);
  EXPECT_FALSE(run(12));
  EXPECT_EQ(fake_.ran.size(), 1u);
}

TEST_F(Pauses, ThreeFruitlessOnesInARowAreTheLast) {
  fake_.endings = {{0, kFull}};
  EXPECT_FALSE(run(12));
  EXPECT_EQ(fake_.pauses, 3);
  EXPECT_EQ(fake_.ran, (std::vector<std::size_t>{12, 12, 12, 12}));
}

TEST_F(Pauses, AFrameInBetweenStartsTheCountAgain) {
  fake_.endings = {{0, kFull}, {0, kFull}, {0, kFull}, {1, kFull}, {0, kFull}};
  EXPECT_FALSE(run(12));
  EXPECT_EQ(fake_.pauses, 6);
  EXPECT_EQ(fake_.ran.back(), 11u);
}

TEST_F(Pauses, ADiskThatFailsAgainWhenTheCampaignIsOpenedIsWaitedForFurther) {
  fake_.endings = {{5, kFull}, {7, {}}};
  fake_.reopen_errors = {kFull, kFull};
  ASSERT_TRUE(run(12));
  EXPECT_EQ(fake_.pauses, 1) << "it is the same pause";
  EXPECT_EQ(fake_.ran.size(), 2u);
}

TEST_F(Pauses, ACampaignThatCannotBeOpenedAgainEndsTheRun) {
  fake_.endings = {{5, kFull}};
  fake_.reopen_errors = {Error{ErrorKind::kInput, "another run has begun"}};
  const Result<RunSummary> summary = run(12);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().message, "another run has begun");
}

}  // namespace
}  // namespace seedframe
