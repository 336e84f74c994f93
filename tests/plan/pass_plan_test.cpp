#include "plan/pass_plan.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(PassPlan, HasWhatTheSpecAsksFor) {
  FrameSpec spec;
  EXPECT_FALSE(plan_passes(spec).depth);
  EXPECT_FALSE(plan_passes(spec).normal);
  spec.render.depth = true;
  EXPECT_TRUE(plan_passes(spec).depth);
  EXPECT_FALSE(plan_passes(spec).normal);
  spec.render.normal = true;
  EXPECT_TRUE(plan_passes(spec).normal);
}

TEST(PassPlan, OnlyALensAsksForASecondRendering) {
  FrameSpec spec;
  spec.camera.focus_distance_m = 2.0;
  EXPECT_FALSE(plan_passes(spec).sharp_rendering) << "a pinhole has no focus";
  spec.camera.aperture_radius_m = 1e-6;
  EXPECT_TRUE(plan_passes(spec).sharp_rendering);
}

}  // namespace
}  // namespace seedframe
