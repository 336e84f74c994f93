#include "scene/expansion_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::Key;

constexpr const char* kTwoKinds = R"(seedframe: 1
scenes: 4
max_attempts: 1000
variables: {scene: {kind: {choice: [gear, washer]}}}
sweep: {values: {count: [1, 3]}}
objects: {parts: {asset: "${kind}", category: none, count: count, position: [copy_index * 0.05, 0, 0.05]}}
ground: {}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.3, 1.5]}, elevation_deg: 45}
constraints: {near: {type: pixels, at_least: 100}}
render: {width: 256, height: 256}
)";

TEST(ExpansionSummary, IsTheSumOverAllFrames) {
  const auto expander = expander_of(kTwoKinds);
  ASSERT_TRUE(expander) << expander.error().message;
  std::int64_t visited = 0;
  std::int64_t attempts = 0;
  const auto summary = expand_all(*expander, {}, [&](const ExpandedFrame& frame) -> Status {
    ++visited;
    attempts += frame.attempts;
    return {};
  });
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->frames, expander->frame_count());
  EXPECT_EQ(summary->frames, visited);
  EXPECT_EQ(summary->least_instances, 2u) << "one object, and the ground";
  EXPECT_EQ(summary->most_instances, 4u);
  EXPECT_EQ(summary->attempts, attempts);
  EXPECT_GT(summary->attempts, summary->frames);
  EXPECT_THAT(summary->used.assets, ElementsAre(Key("gear"), Key("washer")));
  EXPECT_EQ(summary->meshes.size(), 2u) << "without grounds";
  ASSERT_EQ(summary->constraints.size(), 1u);
  EXPECT_EQ(summary->constraints[0].checked, attempts);
  EXPECT_EQ(summary->constraints[0].met, summary->frames);
  EXPECT_EQ(describe_constraints(*expander, summary->constraints),
            fmt::format("constraint near: met in {} of {} draws\n", visited, attempts));
}

TEST(ExpansionSummary, AnErrorOfTheVisitorEndsIt) {
  const auto expander = expander_of(kTwoKinds);
  ASSERT_TRUE(expander);
  int visited = 0;
  const auto summary = expand_all(*expander, {}, [&](const ExpandedFrame&) -> Status {
    return ++visited < 3 ? Status() : fail(ErrorKind::kExhausted, "no room");
  });
  EXPECT_EQ(visited, 3);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().message, "no room");
}

}  // namespace
}  // namespace seedframe
