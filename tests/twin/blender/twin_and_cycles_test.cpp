// The twin against Blender: ids, depth and normals of the same frames, pixel by pixel.
#include <cmath>

#include <gmock/gmock.h>

#include "mesh/mesh_buffer.h"
#include "tests/render/blender/real_blender_fixture.h"
#include "twin/twin.h"
#include "twin/twin_comparison.h"

namespace seedframe {
namespace {

using ::testing::IsEmpty;

class RealBlenderTwin : public RealBlender {
 protected:
  Twin twin_of(const FrameSpec& spec) {
    MeshBuffers buffers;
    for (const auto& [sha256, path] : meshes) {
      buffers[sha256] = std::make_shared<const std::string>(*read_file(path));
    }
    auto twin = TwinTracer().trace(spec, buffers, TwinTracer::Passes::kAsked);
    EXPECT_TRUE(twin) << twin.error().message;
    return std::move(*twin);
  }
};

TEST_F(RealBlenderTwin, IdsDepthAndNormalsAreCycles) {
  std::vector<std::int64_t> frames;
  for (std::int64_t frame = 0; frame < 12; ++frame) {
    FrameSpec spec = varied(frame);
    spec.render.width = 160;
    spec.render.height = 120;
    spec.render.depth = spec.render.normal = true;
    spec.render.samples = 1;
    spec.camera.focal_px = {180.0, 180.0 + static_cast<double>(frame)};
    spec.camera.center_px = {79.5, 59.5 + static_cast<double>(frame)};
    spec.camera.aperture_radius_m = 0.0;
    for (MaterialSpec& material : spec.materials) material.textures.clear();
    specs[frame] = spec;
    frames.push_back(frame);
  }
  ASSERT_TRUE(render(frames, 2));
  TwinTally sum;
  std::int64_t seen = 0, off_depth = 0, off_normal = 0;
  for (const std::int64_t frame : frames) {
    const Twin twin = twin_of(specs[frame]);
    const FramePasses& cycles = passes[frame];
    const TwinVerdict verdict =
        compare_with_twin(specs[frame], cycles.instance_ids, twin.instance_ids, {});
    EXPECT_THAT(verdict.complaint, IsEmpty()) << frame;
    sum.pixels += verdict.tally.pixels;
    sum.inside_px += verdict.tally.inside_px;
    sum.edge_px += verdict.tally.edge_px;
    for (int row = 0; row < 120; ++row) {
      for (int column = 0; column < 160; ++column) {
        if (twin.instance_ids.at(row, column) != cycles.instance_ids.at(row, column)) continue;
        if (twin.instance_ids.at(row, column) == 0) continue;
        ++seen;
        const float z = cycles.depth->at(row, column);
        const float error = std::abs(twin.depth->at(row, column) - z) / z;
        EXPECT_LE(error, 1e-3F) << "frame " << frame << ", " << column << ", " << row;
        if (error > 1e-4F) ++off_depth;
        float dot = 0.0F;
        for (int c = 0; c < 3; ++c) {
          dot += twin.normal->at(row, column, c) * cycles.normal->at(row, column, c);
        }
        // Half a degree.
        if (dot < 0.99996F) ++off_normal;
      }
    }
  }
  EXPECT_EQ(sum.pixels, 12 * 160 * 120);
  EXPECT_EQ(sum.inside_px, 0);
  EXPECT_LE(sum.edge_px, 12);
  EXPECT_GT(seen, 30'000);
  // Surfaces seen at a grazing angle magnify the roundings of the rays.
  EXPECT_LE(off_depth, seen / 1000);
  EXPECT_LE(off_normal, seen / 200);
}

TEST_F(RealBlenderTwin, LabelsLookThroughTheHolesOfAnOpacityTexture) {
  const std::string holes =
      add_texture_file(*read_file(SEEDFRAME_HOME "/tests/twin/data/opacity.png"));
  FrameSpec spec = ball();
  spec.render.max_bounces = 8;
  spec.materials.push_back(spec.materials[0]);
  spec.materials[1].textures["alpha"] = holes;
  spec.materials[1].texture_repeat = 2.0;
  spec.labels.twin_exact = false;
  spec.instances = {instance("leaf/0", 5, smooth, {1}, placed(0, 0, -4)),
                    instance("wall/0", 9, flat, {0}, placed(0, 0, -40, 20))};
  const FramePasses picture = render_one(spec);
  const Twin twin = twin_of(spec);
  std::int64_t leaf = 0, through = 0;
  for (std::size_t i = 0; i < picture.instance_ids.values.size(); ++i) {
    if (twin.instance_ids.values[i] != 5) continue;
    ++leaf;
    through += picture.instance_ids.values[i] == 9 ? 1 : 0;
  }
  EXPECT_GT(leaf, 500);
  EXPECT_NEAR(static_cast<double>(through) / static_cast<double>(leaf), 0.25, 0.15)
      << "front and back of the leaf have holes, each over half of it";
}

}  // namespace
}  // namespace seedframe
