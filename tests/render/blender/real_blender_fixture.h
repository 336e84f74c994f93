// Frame specs, meshes and textures for tests that render with Blender itself.
#pragma once

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/canonical_json.h"
#include "base/files.h"
#include "base/philox.h"
#include "base/sha256.h"
#include "image/pass_reader.h"
#include "render/blender_info.h"
#include "render/local_executor.h"
#include "render/worker_pool.h"
#include "spec/frame_spec.h"
#include "tests/fixtures/real_blender.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {

/// A mesh buffer (docs/formats/mesh-buffer.md) of a unit sphere; slot 1, if there is one, is its
/// lower half.
inline std::string sphere_buffer(int rings, int slots, float smooth_angle) {
  std::string bytes = "SFMESH01";
  const auto put = [&bytes](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  const auto segments = static_cast<std::uint32_t>(2 * rings);
  const auto count = static_cast<std::uint32_t>(rings);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      const std::uint32_t a = i * segments + j;
      const std::uint32_t b = i * segments + (j + 1) % segments;
      if (i + 1 < count) triangles.push_back({a, a + segments, b + segments});
      if (i > 0) triangles.push_back({a, b + segments, b});
    }
  }
  put((count + 1) * segments);
  put(static_cast<std::uint32_t>(triangles.size()));
  put(static_cast<std::uint32_t>(slots));
  put(smooth_angle);
  for (std::uint32_t i = 0; i <= count; ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      const float theta =
          std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(count);
      const float phi =
          std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(count);
      put(std::sin(theta) * std::cos(phi));
      put(std::sin(theta) * std::sin(phi));
      put(std::cos(theta));
    }
  }
  for (const auto& triangle : triangles) {
    for (const std::uint32_t corner : triangle) put(corner);
  }
  for (const auto& triangle : triangles) {
    for (const std::uint32_t corner : triangle) {
      put(static_cast<float>(corner % segments) / static_cast<float>(segments));
      put(static_cast<float>(corner / segments) / static_cast<float>(count));
    }
  }
  for (const auto& triangle : triangles) {
    const bool lower = triangle[0] / segments >= count / 2;
    put(slots > 1 && lower ? std::uint32_t{1} : std::uint32_t{0});
  }
  return bytes;
}

inline Affine placed(double x, double y, double z, double scale = 1.0, double turn = 0.0) {
  Affine result = Affine::Identity();
  result.translate(Eigen::Vector3d(x, y, z));
  result.rotate(Eigen::AngleAxisd(turn, Eigen::Vector3d(0.6, 0.8, 0.0)));
  result.scale(scale);
  return result;
}

class RealBlender : public testing::Test, public RenderClient {
 protected:
  RealBlender() {
    smooth = add_mesh(sphere_buffer(12, 1, 3.2F));
    flat = add_mesh(sphere_buffer(8, 1, 0.0F));
    halves = add_mesh(sphere_buffer(10, 2, 0.3F));
  }

  std::string add_mesh(const std::string& bytes) {
    const std::string name = sha256_hex(bytes);
    meshes[name] = folder / (name + ".mesh");
    EXPECT_TRUE(write_file(meshes[name], bytes));
    return name;
  }
  /// A square BMP, row by row from below; `color_at` tells a pixel's colour as 0xrrggbb.
  std::string add_picture(std::uint32_t side,
                          const std::function<std::uint32_t(std::uint32_t pixel)>& color_at) {
    std::string bytes = "BM";
    const auto put = [&bytes](std::uint32_t value, int count) {
      for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i));
    };
    put(54 + 3 * side * side, 4), put(0, 4), put(54, 4);
    put(40, 4), put(side, 4), put(side, 4), put(1, 2), put(24, 2);
    for (int i = 0; i < 6; ++i) put(0, 4);
    for (std::uint32_t i = 0; i < side * side; ++i) put(color_at(i), 3);
    return add_texture_file(bytes);
  }
  std::string add_texture(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    const auto color = static_cast<std::uint32_t>(red << 16 | green << 8 | blue);
    return add_picture(4, [color](std::uint32_t) { return color; });
  }
  std::string add_texture_file(const std::string& bytes) {
    const std::string name = sha256_hex(bytes);
    textures[name] = folder / (name + ".bmp");
    EXPECT_TRUE(write_file(textures[name], bytes));
    return name;
  }

  static InstanceSpec instance(const std::string& name, int id, const std::string& mesh,
                               const std::vector<int>& materials, const Affine& place) {
    InstanceSpec spec;
    spec.name = name;
    spec.id = id;
    spec.category = id == 0 ? 0 : 1;
    spec.mesh = mesh;
    spec.materials = materials;
    spec.camera_from_object = place;
    return spec;
  }

  /// One white ball of radius 1 at 4 m, lit evenly by the world alone.
  FrameSpec ball() const {
    FrameSpec spec;
    spec.render = {48, 36, 4, 1, 2, 1.5, 0.0, true, false, {}, Denoise::kOff, {}, {}};
    spec.camera = {{60.0, 60.0}, {23.5, 17.5}, 0.01, 100.0};
    spec.world.color = {1, 1, 1};
    spec.world.strength = 1.0;
    spec.materials.emplace_back();
    spec.materials[0].base_color = {0.8, 0.8, 0.8};
    spec.materials[0].specular = 0.0;
    spec.instances = {instance("ball/0", 5, smooth, {0}, placed(0, 0, -4))};
    return spec;
  }
  /// Frames that differ in all that a worker could carry over from one to the next.
  FrameSpec varied(std::int64_t frame) const;

  Result<RunSummary> render(const std::vector<std::int64_t>& frames, int threads) {
    const Result<BlenderInfo> blender = probe_blender(test_blender());
    if (!blender) return forward_error(blender);
    PoolOptions options;
    WorkerOptions worker;
    worker.blender = blender->program;
    worker.scripts = SEEDFRAME_HOME "/blender_scripts";
    worker.log_path = [this](int) { return folder / "worker.log"; };
    worker.threads = threads;
    options.frames_per_worker = frames_per_worker;
    worker.conditions = conditions;
    worker.preload =
        std::filesystem::path(SEEDFRAME_PROGRAM).parent_path() / "seedframe_worker_cpu.so";
    options.attempts = {1, 1};
    executor = std::make_unique<LocalExecutor>(worker);
    pool = std::make_unique<WorkerPool>(options, *executor, *this);
    std::vector<PendingFrame> pending;
    for (const std::int64_t frame : frames) pending.push_back({frame, 0});
    passes.clear();
    failures.clear();
    Result<RunSummary> summary = pool->run(pending);
    // So that a test which looks at a missing picture fails instead of aborting.
    for (const std::int64_t frame : frames) {
      FramePasses& each = passes[frame];
      if (!each.combined.values.empty()) continue;
      each.combined = Image<float>(64, 64, 4);
      each.instance_ids = Image<std::uint16_t>(64, 64);
      each.depth = each.normal = Image<float>(64, 64, 3);
    }
    return summary;
  }
  FramePasses render_one(const FrameSpec& spec) {
    specs[0] = spec;
    const auto summary = render({0}, 1);
    EXPECT_TRUE(summary) << summary.error().message;
    EXPECT_EQ(failures[0], "");
    return passes[0];
  }

  // RenderClient
  Result<std::optional<RenderRequest>> request(const FrameJob& job) override {
    RenderRequest request;
    request.spec = canonical_json(to_json(specs.at(job.frame)));
    request.output = folder / "passes # 100%.exr";  // Blender must take nothing of it for a pattern
    request.meshes = meshes;
    request.textures = textures;
    request.sample_counts = counted.contains(job.frame);
    return request;
  }
  void started(const FrameJob&, int) override {}
  void rendered(const FrameJob& job, const RenderTimings&, int) override {
    const RenderSettings& settings = specs.at(job.frame).render;
    const PixelRect size = settings.rendered_pixels();
    PassExpectation expected{size.width, size.height, settings.depth, settings.normal, 32767, {}};
    expected.sample_counts = counted.contains(job.frame);
    auto read = read_passes(folder / "passes # 100%.exr", expected);
    const std::filesystem::path sharp_file = folder / "passes # 100%.exr.sharp";
    if (std::filesystem::exists(sharp_file)) {
      auto in_focus = read_passes(
          sharp_file, {size.width, size.height, settings.depth, settings.normal, 32767, {}});
      if (in_focus) sharp[job.frame] = std::move(*in_focus);
      std::filesystem::remove(sharp_file);
    }
    if (read) passes[job.frame] = std::move(*read);
    pool->post_verdict(job, read ? Status() : Status(forward_error(read)));
  }
  Status check_system() override { return {}; }
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override {
    const std::string& message = failure.message;
    failures[job.frame] = message;
  }
  void worker_ready(int, const ReadyMessage& message) override { ready = message; }

  ScratchFolder folder;
  std::map<std::string, std::filesystem::path> meshes, textures;
  std::string smooth, flat, halves;
  std::map<std::int64_t, FrameSpec> specs;
  std::set<std::int64_t> counted;  ///< frames whose samples are to be told
  std::map<std::int64_t, FramePasses> passes;
  std::map<std::int64_t, FramePasses> sharp;  ///< of frames with depth of field
  std::map<std::int64_t, std::string> failures;
  int frames_per_worker = 0;
  WorkerConditions conditions;
  ReadyMessage ready;
  std::unique_ptr<LocalExecutor> executor;
  std::unique_ptr<WorkerPool> pool;
};

inline FrameSpec RealBlender::varied(std::int64_t frame) const {
  const PhiloxStream stream(7, "varied");
  std::uint32_t draws = 0;
  const auto draw = [&](double low, double high) {
    const PhiloxStream::Position position = {0, static_cast<std::uint32_t>(frame), draws++, 0};
    return low + (high - low) * stream.uniform(position);
  };
  const auto pick = [&](int count) { return static_cast<int>(draw(0, count)); };
  FrameSpec spec = ball();
  spec.render.width = 40 + 8 * pick(3);
  spec.render.samples = 1 + pick(4);
  spec.render.seed = static_cast<std::uint32_t>(draw(0, 1e9));
  spec.render.max_bounces = pick(6);
  spec.render.filter_width_px = draw(0.5, 2.0);
  spec.render.clamp_indirect = pick(2) * 5.0;
  spec.render.depth = pick(2) == 1;
  spec.render.normal = pick(2) == 1;
  spec.camera.center_px[0] = 0.5 * (spec.render.width - 1) + draw(-4, 4);
  spec.camera.focal_px[1] = draw(50, 70);
  if (pick(2) == 1) {
    spec.camera.aperture_radius_m = draw(0.01, 0.1);
    spec.camera.focus_distance_m = draw(3, 5);
  }
  spec.world.color = {draw(0, 1), draw(0, 1), draw(0, 1)};
  spec.world.strength = draw(0, 1);
  if (pick(2) == 1 && !textures.empty()) {
    spec.world.hdri = textures.begin()->first;
    spec.world.importance_map_px = 64;
    spec.world.map_from_camera =
        Eigen::AngleAxisd(draw(0, 3), Eigen::Vector3d::UnitX()).toRotationMatrix();
  }
  spec.materials.assign(4, {});
  for (MaterialSpec& material : spec.materials) {
    material = {{draw(0, 1), draw(0, 1), draw(0, 1)},
                draw(0, 1),
                draw(0, 1),
                draw(0, 1),
                pick(2) * draw(0, 1),
                draw(1.1, 1.8),
                draw(0, 1),
                draw(1, 4),
                {}};
    for (const char* kind : {"color", "metallic", "normal", "roughness"}) {
      const int texture = pick(3);
      if (texture < static_cast<int>(textures.size())) {
        material.textures[kind] = std::next(textures.begin(), texture)->first;
      }
    }
  }
  spec.instances.clear();
  for (int i = 1 + pick(6); i > 0; --i) {
    const std::string mesh = std::array{smooth, flat, halves}[static_cast<std::size_t>(pick(3))];
    const std::vector<int> slots = {pick(4), pick(4)};
    const std::size_t used = mesh == halves ? 2 : 1;
    spec.instances.push_back(
        instance(fmt::format("thing/{}", i), i, mesh,
                 {slots.begin(), slots.begin() + static_cast<std::ptrdiff_t>(used)},
                 placed(draw(-1.5, 1.5), draw(-1, 1), draw(-6, -3), draw(0.3, 1), draw(0, 3))));
    spec.instances.back().hidden_from.glossy = pick(2) == 1;
    spec.instances.back().hidden_from.shadow = pick(2) == 1;
  }
  for (int i = pick(4); i > 0; --i) {
    LightSpec light;
    light.kind = static_cast<LightKind>(pick(4));
    light.camera_from_light = placed(draw(-2, 2), draw(0, 2), draw(-2, 0), 1, draw(-1, 1));
    light.color = {draw(0, 1), draw(0, 1), draw(0, 1)};
    light.power = light.kind == LightKind::kSun ? 2 : 100;
    light.radius_m = draw(0, 0.2);
    light.angle_rad = draw(0.02, 1);  // Blender's spots have a degree or more
    light.blend = draw(0, 1);
    light.width_m = draw(0.1, 1);
    light.height_m = draw(0.1, 1);
    spec.lights.push_back(light);
  }
  return spec;
}

}  // namespace seedframe
