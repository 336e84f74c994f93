// What a page and a server ask of a store.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "store/job_store.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;

class StoreQueriesTest : public ::testing::Test {
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
  const std::filesystem::path path_ = folder_ / "campaign.sqlite";
};

TEST_F(StoreQueriesTest, AttemptsOfAllFramesComeInOrder) {
  JobStore store = store_with(3);
  ASSERT_TRUE(store.attempt_started(2, 1, 0, 1.0));
  ASSERT_TRUE(store.attempt_started(0, 1, 0, 2.0, R"({"kernel":"avx2"})"));
  ASSERT_TRUE(store.attempt_failed(0, 1, AttemptOutcome::kError, FrameState::kPending, "no"));
  ASSERT_TRUE(store.attempt_started(0, 2, 1, 3.0));
  std::vector<std::pair<std::int64_t, int>> seen;
  ASSERT_TRUE(store.for_each_attempt([&seen](const AttemptRow& row) -> Status {
    seen.emplace_back(row.frame, row.attempt);
    return {};
  }));
  EXPECT_THAT(seen, ElementsAre(std::pair(0, 1), std::pair(0, 2), std::pair(2, 1)));
  const Status stopped = store.for_each_attempt(
      [](const AttemptRow&) -> Status { return fail(ErrorKind::kInput, "enough"); });
  EXPECT_EQ(stopped.error().message, "enough");
}

TEST_F(StoreQueriesTest, TheNewestGoodAttemptsComeFirst) {
  JobStore store = store_with(3);
  for (int frame = 0; frame < 3; ++frame) {
    ASSERT_TRUE(store.attempt_started(frame, 1, 0, 10.0 + frame));
  }
  ASSERT_TRUE(store.frame_done(1, 1, {"p", "f", {}}, {}));
  ASSERT_TRUE(store.frame_done(0, 1, {"p", "f", {}}, {}));
  const auto newest = store.recent_done(5);
  ASSERT_EQ(newest->size(), 2u);
  EXPECT_EQ(newest->front().frame, 1);
  EXPECT_EQ(store.recent_done(1)->size(), 1u);
}

TEST_F(StoreQueriesTest, ItsVersionChangesWhenAnotherOneWrites) {
  JobStore store = store_with(2);
  const auto reader = JobStore::open(path_);
  ASSERT_TRUE(reader);
  const std::int64_t before = *reader->data_version();
  EXPECT_EQ(*reader->data_version(), before);
  EXPECT_EQ(*reader->last_process(), std::nullopt) << "nobody has begun a run";
  ASSERT_TRUE(store.begin_run(1.0, "host", 4711));
  EXPECT_NE(*reader->data_version(), before);
  EXPECT_EQ(*reader->last_process(), 4711);
}

}  // namespace
}  // namespace seedframe
