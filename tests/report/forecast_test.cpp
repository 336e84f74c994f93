// What a campaign will cost, told by attempts at a few of its frames.

#include "report/forecast.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

AttemptRow attempt(int worker, double started, double build_s, double render_s, double finish_s) {
  AttemptRow row;
  row.worker = worker;
  row.started = started;
  row.build_s = build_s;
  row.render_s = render_s;
  row.finish_s = finish_s;
  row.outcome = AttemptOutcome::kDone;
  return row;
}

TEST(Forecast, LeavesTheFirstFrameOfAWorkerOut) {
  // Workers start for 2 s, and read meshes for 3 s in their first frames.
  const std::vector<AttemptRow> pilots = {
      attempt(0, 102.0, 3.5, 0.5, 0.1), attempt(1, 102.1, 3.5, 0.5, 0.1),
      attempt(0, 106.0, 0.25, 0.5, 0.1), attempt(1, 106.1, 0.25, 1.0, 0.1)};
  const Forecast told = told_by(pilots, 100.0, 2, 1000);
  EXPECT_EQ(told.frames, 1000);
  EXPECT_EQ(told.pilots, 4);
  EXPECT_DOUBLE_EQ(told.frame_s, 1.0);
  EXPECT_DOUBLE_EQ(told.spread, 0.25);  // of 0.75 and 1.25
  EXPECT_DOUBLE_EQ(told.wall_s, 2.0 + 3.0 + 1000 * 1.0 / 2 + 0.1);
}

TEST(Forecast, TakesAFirstFrameWhereThereIsNoOther) {
  const Forecast told =
      told_by({attempt(0, 11, 0.5, 1.5, 0.5), attempt(1, 11, 0.5, 1.5, 0.5)}, 10.0, 2, 1);
  EXPECT_DOUBLE_EQ(told.frame_s, 2.0);
  EXPECT_DOUBLE_EQ(told.wall_s, 1.0 + 2.0 + 0.5) << "one frame is made by one worker";
}

TEST(Forecast, WithoutBlenderAThreadFinishesFrames) {
  const Forecast told =
      told_by({attempt(0, 5, 0, 0, 0.25), attempt(0, 5, 0, 0, 0.25)}, 5.0, 2, 100);
  EXPECT_DOUBLE_EQ(told.frame_s, 0.25);
  EXPECT_DOUBLE_EQ(told.wall_s, 100 * 0.25 / 2 + 0.25);
}

}  // namespace
}  // namespace seedframe
