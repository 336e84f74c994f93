// Frames that are a part of their image: what is rendered of it, and of which object.

#include <map>

#include <gmock/gmock.h>

#include "rays/ray_scene.h"
#include "tests/scene/scene_fixture.h"
#include "twin/twin.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

/// Three gears and a bolt on a plane, the camera above them; `render` and other sections follow.
std::string scene_with(const std::string& sections) {
  return R"(seedframe: 1
seed: 3
scenes: 12
categories: [gear, hex_bolt]
objects:
  gears: {asset: gear, count: 3, scatter: {x: [-0.1, 0.1], y: [-0.1, 0.1]}, rest_on_ground: true}
  bolt: {asset: hex_bolt, position: [{uniform: [-0.1, 0.1]}, 0, 0.05]}
ground: {width_m: 2, depth_m: 2, material: Concrete01}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.4, 0.8]}, azimuth_deg: {uniform: [0, 360]}}
)" + sections;
}

Image<std::uint16_t> ids_of(const ExpandedFrame& frame) {
  TwinTracer tracer;
  const auto twin = tracer.trace(frame.spec, frame.meshes, TwinTracer::Passes::kIdsOnly);
  EXPECT_TRUE(twin);
  return twin->instance_ids;
}

/// The smallest rectangle around what has an id, or this one.
PixelRect extent_of(const Image<std::uint16_t>& ids, int id = -1) {
  PixelRect extent;
  for (int row = 0; row < ids.height; ++row) {
    for (int column = 0; column < ids.width; ++column) {
      const int found = ids.at(row, column);
      if (found != 0 && (id < 0 || found == id)) {
        extent = union_of(extent, {column, row, 1, 1});
      }
    }
  }
  return extent;
}

TEST(ViewWindow, TheRegionOfObjectsHoldsThemAndLittleElse) {
  const auto whole = all_frames(scene_with("render: {width: 320, height: 240}\n"));
  const auto frames =
      all_frames(scene_with("render: {width: 320, height: 240, region: objects}\n"));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameSpec& spec = frames[i].spec;
    ASSERT_TRUE(spec.render.region);
    const Image<std::uint16_t> ids = ids_of(frames[i]);
    EXPECT_EQ(ids.values, ids_of(whole[i]).values) << "nothing that has an id is left out";
    const PixelRect seen = extent_of(ids);
    const PixelRect& region = *spec.render.region;
    EXPECT_EQ(union_of(region, seen), region);
    EXPECT_LE(seen.x - region.x, 3);
    EXPECT_LE(region.end_x() - seen.end_x(), 3);
    EXPECT_LE(seen.y - region.y, 3);
    EXPECT_LE(region.end_y() - seen.end_y(), 3);
    FrameSpec same = spec;
    same.render.region.reset();
    EXPECT_EQ(frame_id(same), whole[i].id) << "all else is as without a region";
  }
}

TEST(ViewWindow, ARegionHidesWhatIsOutsideOfIt) {
  ExpandedFrame frame = first_frame(scene_with("render: {width: 320, height: 240}\n"));
  const Image<std::uint16_t> whole = ids_of(frame);
  frame.spec.render.region = PixelRect{100, 80, 60, 50};
  const Image<std::uint16_t> ids = ids_of(frame);
  for (int row = 0; row < ids.height; ++row) {
    for (int column = 0; column < ids.width; ++column) {
      const bool inside = frame.spec.render.region->contains(column, row);
      ASSERT_EQ(ids.at(row, column), inside ? whole.at(row, column) : 0);
    }
  }
}

TEST(ViewWindow, WithoutObjectsAPixelIsRendered) {
  const ExpandedFrame frame = first_frame(
      "seedframe: 1\nobjects: {o: {asset: gear, category: none, position: [0, 0, 9]}}\n"
      "render: {region: objects}\ncamera: {position: [0, 0, 1], target: [0, 0, 0]}\n");
  EXPECT_EQ(frame.spec.render.region, (PixelRect{0, 0, 1, 1}));
}

TEST(ViewWindow, APatchIsFilledByItsObject) {
  const auto whole = all_frames(scene_with("render: {width: 320, height: 240}\n"));
  const auto frames =
      all_frames(scene_with("render: {width: 320, height: 240}\npatches: {size: 64}\n"));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameSpec& spec = frames[i].spec;
    EXPECT_EQ(spec.render.width, 64);
    EXPECT_EQ(spec.render.height, 64);
    EXPECT_EQ(spec.instances.size(), whole[i].spec.instances.size());
    const auto target =
        std::find_if(spec.instances.begin(), spec.instances.end(),
                     [&](const InstanceSpec& each) { return each.id == spec.labels.target; });
    ASSERT_NE(target, spec.instances.end());
    EXPECT_GT(target->category, 0);
    // Nothing stands before it here, but for other parts now and then.
    const PixelRect seen = extent_of(ids_of(frames[i]), spec.labels.target);
    EXPECT_LE(seen.x, 2);
    EXPECT_LE(seen.y, 2);
    EXPECT_GE(seen.end_x(), 62);
    EXPECT_GE(seen.end_y(), 62);
  }
}

TEST(ViewWindow, APatchShowsWhatTheImageShowsThere) {
  const std::string render = "render: {width: 640, height: 480}\n";
  const ExpandedFrame whole = first_frame(scene_with(render));
  const ExpandedFrame patch = first_frame(scene_with(render + "patches: {size: 64}\n"));
  const CameraSpec& from = whole.spec.camera;
  const CameraSpec& to = patch.spec.camera;
  const Image<std::uint16_t> ids = ids_of(whole);
  const Image<std::uint16_t> patch_ids = ids_of(patch);
  int compared = 0, equal = 0;
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) {
      const double x = (column - to.center_px[0]) / to.focal_px[0];
      const double y = (row - to.center_px[1]) / to.focal_px[1];
      const auto at_column =
          static_cast<int>(std::lround(from.center_px[0] + x * from.focal_px[0]));
      const auto at_row = static_cast<int>(std::lround(from.center_px[1] + y * from.focal_px[1]));
      ++compared;
      equal += ids.at(at_row, at_column) == patch_ids.at(row, column);
    }
  }
  EXPECT_GT(equal, 0.95 * compared) << "but for outlines, where pixels are of another size";
}

TEST(ViewWindow, PatchesAreOfAllCategoriesAlike) {
  std::map<int, int> patches;
  std::string text = scene_with("patches: {size: 32}\n");
  text.replace(text.find("scenes: 12"), 10, "scenes: 300");
  for (const ExpandedFrame& frame : all_frames(text)) {
    for (const InstanceSpec& each : frame.spec.instances) {
      if (each.id == frame.spec.labels.target) ++patches[each.category];
    }
  }
  // Three gears and one bolt, each category drawn with 1/2: 150 ± 9, four times that allowed.
  EXPECT_NEAR(patches[1], 150, 35);
  EXPECT_EQ(patches[1] + patches[2], 300);
}

TEST(ViewWindow, APatchKeepsItsShapeIfAsked) {
  for (const ExpandedFrame& frame :
       all_frames(scene_with("patches: {size: 32, keep_shape: true}\n"))) {
    EXPECT_DOUBLE_EQ(frame.spec.camera.focal_px[0], frame.spec.camera.focal_px[1]);
  }
}

TEST(ViewWindow, AFrameWithoutAnythingToCutIsAnError) {
  EXPECT_THAT(
      scene_error(
          "seedframe: 1\ncategories: [gear]\nobjects: {o: {asset: gear, position: [0, 0, 9]}}\n"
          "patches: {size: 32}\ncamera: {position: [0, 0, 1], target: [0, 0, 0]}\n"),
      HasSubstr("no object of this frame shows 0.25 of its silhouette or more"));
}

}  // namespace
}  // namespace seedframe
