// configs/robocup_spl.yaml against paper 1: equations 1 to 7 over 2,000 accepted frames, with its
// constraints, and what stands where in them.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "mesh/collision.h"
#include "tests/scene/scene_fixture.h"
#include "tests/scene/statistics.h"

namespace seedframe {
namespace {

constexpr int kAcceptedFrames = 2'000;
constexpr double kLeastLawP = 0.01;
constexpr double kFieldWidth = 9.0;
constexpr double kFieldHeight = 6.0;

double normal_cdf(double x, double mean, double std) {
  return 0.5 * std::erfc(-(x - mean) / (std * std::numbers::sqrt2));
}

Result<SceneExpander> robocup(int scenes, int frames_per_scene) {
  return expander_of(fmt::format("base: robocup_spl.yaml\n"
                                 "set: {{scenes: {}, frames_per_scene: {}}}\n",
                                 scenes, frames_per_scene),
                     kHome / "configs" / "robocup_test.yaml");
}

/// A robot as it stands in the world.
struct Robot {
  double x, y, yaw;
  std::string asset;
};

std::vector<Robot> robots_of(const ExpandedFrame& frame) {
  std::vector<Robot> robots;
  for (const InstanceSpec& instance : frame.spec.instances) {
    if (!instance.name.starts_with("robots/")) continue;
    const Affine place = frame.world_from_camera * instance.camera_from_object;
    const double yaw = std::atan2(place.linear()(1, 0), place.linear()(0, 0));
    robots.push_back({place.translation().x(), place.translation().y(),
                      yaw * 180.0 / std::numbers::pi, instance.asset});
  }
  return robots;
}

/// Of the image's height, from the top.
double row_of_ball(const ExpandedFrame& frame) {
  for (const InstanceSpec& instance : frame.spec.instances) {
    if (instance.asset != "spl_ball") continue;
    const Eigen::Vector3d at = instance.camera_from_object.translation();
    const CameraSpec& camera = frame.spec.camera;
    const double row = camera.center_px[1] + camera.focal_px[1] * at.y() / at.z();
    return (row + 0.5) / frame.spec.render.height;
  }
  ADD_FAILURE() << "a frame without a ball";
  return 0.0;
}

class RobocupScene : public testing::Test {
 public:
  static void SetUpTestSuite() {
    auto expander = robocup(kAcceptedFrames, 1);
    ASSERT_TRUE(expander) << expander.error().message;
    for (int scene = 0; scene < kAcceptedFrames; ++scene) {
      const auto frame = expander->expand(scene, {.id = false, .draws = false, .graph = true});
      ASSERT_TRUE(frame) << frame.error().message;
      add(*frame);
    }
  }

 protected:
  static void add(const ExpandedFrame& frame) {
    for (const auto& [key, value] : frame.graph.items()) {
      if (value.is_number()) values[key].push_back(value.get<double>());
      if (!value.is_array() || value.size() != 3 || !value[0].is_number()) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        values[key + "." + "xyz"[i]].push_back(value[i].get<double>());
      }
    }
    robots_of_frames.push_back(robots_of(frame));
    rows.push_back(row_of_ball(frame));
    attempts += frame.attempts;
  }

  static double uniform_p(const std::vector<double>& samples, double low, double high) {
    return kolmogorov_p(samples, [=](double x) { return (x - low) / (high - low); });
  }

  static inline std::map<std::string, std::vector<double>> values;
  static inline std::vector<std::vector<Robot>> robots_of_frames;
  static inline std::vector<double> rows;
  static inline std::int64_t attempts = 0;
};

TEST_F(RobocupScene, Equation1TheBallIsUniformOverTheField) {
  EXPECT_GT(uniform_p(values["ball.x"], 0.0, kFieldWidth), kLeastLawP);
  EXPECT_GT(uniform_p(values["ball.y"], 0.0, kFieldHeight), kLeastLawP);
  EXPECT_GT(independence_p(values["ball.x"], values["ball.y"]), kLeastLawP);
}

TEST_F(RobocupScene, Equation2TheObserverStandsOnACircleAroundTheBall) {
  std::vector<double> distances, angles;
  for (std::size_t i = 0; i < kAcceptedFrames; ++i) {
    const double x = values["observer.x"][i] - values["ball.x"][i];
    const double y = values["observer.y"][i] - values["ball.y"][i];
    distances.push_back(std::hypot(x, y));
    angles.push_back(std::atan2(y, x));
    // R(φ) · [0 d]ᵀ
    const double phi = values["phi"][i] * std::numbers::pi / 180.0;
    const double d = values["d"][i];
    ASSERT_NEAR(x, -std::sin(phi) * d, 1e-12);
    ASSERT_NEAR(y, std::cos(phi) * d, 1e-12);
  }
  EXPECT_GT(uniform_p(distances, 0.3, 1.5), kLeastLawP);
  EXPECT_GT(uniform_p(angles, -std::numbers::pi, std::numbers::pi), kLeastLawP);
  EXPECT_GT(independence_p(distances, angles), kLeastLawP);
  EXPECT_GT(independence_p(distances, values["ball.x"]), kLeastLawP);
}

TEST_F(RobocupScene, Equation3TheObserverLooksPastTheBallByUpToHalfItsFieldOfView) {
  EXPECT_GT(uniform_p(values["gamma"], -30.5, 30.5), kLeastLawP);
  for (std::size_t i = 0; i < kAcceptedFrames; ++i) {
    const double beta = std::atan2(values["ball.y"][i] - values["observer.y"][i],
                                   values["ball.x"][i] - values["observer.x"][i]);
    ASSERT_NEAR(values["alpha"][i], beta * 180.0 / std::numbers::pi + values["gamma"][i], 1e-9);
  }
  EXPECT_GT(independence_p(values["gamma"], values["phi"]), kLeastLawP);
}

TEST_F(RobocupScene, Equation4NineOtherRobotsStandAnywhereAndLookAnywhere) {
  std::vector<double> x, y, yaw, first_x, second_x;
  for (const std::vector<Robot>& robots : robots_of_frames) {
    ASSERT_EQ(robots.size(), 9U);
    first_x.push_back(robots[0].x);
    second_x.push_back(robots[1].x);
    for (const Robot& robot : robots) {
      x.push_back(robot.x);
      y.push_back(robot.y);
      yaw.push_back(robot.yaw);
    }
  }
  EXPECT_GT(uniform_p(x, 0.0, kFieldWidth), kLeastLawP);
  EXPECT_GT(uniform_p(y, 0.0, kFieldHeight), kLeastLawP);
  EXPECT_GT(uniform_p(yaw, -180.0, 180.0), kLeastLawP);
  EXPECT_GT(independence_p(x, yaw), kLeastLawP);
  EXPECT_GT(independence_p(first_x, second_x), kLeastLawP);
  EXPECT_GT(independence_p(first_x, values["ball.x"]), kLeastLawP);
}

TEST_F(RobocupScene, RobotsStandSitAndLieAsOftenAsThePaperSays) {
  std::vector<double> counts(3, 0.0);
  for (const std::vector<Robot>& robots : robots_of_frames) {
    for (const Robot& robot : robots) {
      if (robot.asset == "robot_standing") counts[0] += 1.0;
      if (robot.asset == "robot_sitting") counts[1] += 1.0;
      if (robot.asset == "robot_lying") counts[2] += 1.0;
    }
  }
  const double all = 9.0 * kAcceptedFrames;
  EXPECT_EQ(counts[0] + counts[1] + counts[2], all);
  EXPECT_GT(chi_squared_p(counts, {0.8 * all, 0.1 * all, 0.1 * all}), kLeastLawP);
}

TEST_F(RobocupScene, Equation5OneOfTheNormalDistributionsGivesTheIntensity) {
  EXPECT_GT(kolmogorov_p(values["intensity"],
                         [](double x) {
                           return (normal_cdf(x, 1700, 50) + normal_cdf(x, 2650, 50) +
                                   normal_cdf(x, 3600, 50)) /
                                  3.0;
                         }),
            kLeastLawP);
}

TEST_F(RobocupScene, Equation6TheTemperatureIsUniform) {
  EXPECT_GT(uniform_p(values["temperature"], 3000.0, 12000.0), kLeastLawP);
  EXPECT_GT(independence_p(values["temperature"], values["intensity"]), kLeastLawP);
}

TEST_F(RobocupScene, Equation7TheFieldIsGreenOfUniformHueSaturationAndValue) {
  // The variable is linear RGB; back to HSV: value and saturation from the largest and the least.
  const auto encode = [](double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
  };
  std::vector<double> hue, saturation, value;
  for (std::size_t i = 0; i < kAcceptedFrames; ++i) {
    const double r = encode(values["field_color.x"][i]);
    const double g = encode(values["field_color.y"][i]);
    const double b = encode(values["field_color.z"][i]);
    const double most = std::max({r, g, b});
    const double least = std::min({r, g, b});
    ASSERT_EQ(most, g);
    hue.push_back(60.0 * (2.0 + (b - r) / (most - least)));
    saturation.push_back((most - least) / most);
    value.push_back(most);
  }
  EXPECT_GT(uniform_p(hue, 100.0, 140.0), kLeastLawP);
  EXPECT_GT(uniform_p(saturation, 0.5, 1.0), kLeastLawP);
  EXPECT_GT(uniform_p(value, 0.25, 1.0), kLeastLawP);
  EXPECT_GT(independence_p(hue, saturation), kLeastLawP);
  EXPECT_GT(independence_p(saturation, value), kLeastLawP);
}

TEST_F(RobocupScene, TheBallIsAtAllHeightsOfTheImage) {
  std::vector<int> balls(8, 0);
  for (const double row : rows) {
    // The nearest balls, seen from the side, have their middle on the lower edge.
    ASSERT_GT(row, 0.0);
    ASSERT_LT(row, 1.001);
    ++balls[static_cast<std::size_t>(8.0 * std::min(row, 0.999))];
  }
  for (std::size_t eighth = 0; eighth < balls.size(); ++eighth) {
    EXPECT_GT(balls[eighth], 0.02 * kAcceptedFrames) << "eighth " << eighth << " from the top";
  }
}

TEST_F(RobocupScene, FewFramesAreDrawnAgain) {
  // So little can the constraints bend the laws above.
  EXPECT_GT(attempts, kAcceptedFrames);
  EXPECT_LT(attempts, 1.05 * kAcceptedFrames);
}

/// Those that must not stand in each other.
std::vector<const InstanceSpec*> solids_of(const FrameSpec& spec) {
  std::vector<const InstanceSpec*> solids;
  for (const InstanceSpec& instance : spec.instances) {
    const bool pitch = instance.name.starts_with("pitch/") || instance.id == 0;
    if (!pitch) solids.push_back(&instance);
  }
  return solids;
}

TEST(RobocupPlaces, NoRobotStandsInAnotherInAPostOrOnTheBall) {
  auto expander = robocup(150, 1);
  ASSERT_TRUE(expander) << expander.error().message;
  std::map<std::string, std::unique_ptr<const SolidMesh>> meshes;
  int near = 0;
  for (int frame = 0; frame < 150; ++frame) {
    const ExpandedFrame expanded = frame_of(*expander, frame);
    const auto solids = solids_of(expanded.spec);
    ASSERT_EQ(solids.size(), 4U + 1U + 1U + 9U);  // posts, ball, the observer's body, robots
    for (std::size_t i = 0; i < solids.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        std::vector<SolidInstance> pair;
        for (const InstanceSpec* instance : {solids[i], solids[j]}) {
          const auto asset = built_in_assets().load(instance->asset);
          ASSERT_TRUE(asset);
          auto& mesh = meshes[instance->asset];
          if (!mesh) mesh = std::make_unique<const SolidMesh>((*asset)->mesh);
          pair.push_back({mesh.get(), (*asset)->box,
                          expanded.world_from_camera * instance->camera_from_object});
        }
        const double apart =
            (pair[0].world_from_object.translation() - pair[1].world_from_object.translation())
                .head<2>()
                .norm();
        if (apart < 0.6) ++near;
        EXPECT_FALSE(nearer_than(pair[0], pair[1], 0.0))
            << solids[i]->name << " and " << solids[j]->name << " of frame " << frame;
      }
    }
  }
  EXPECT_GT(near, 100);  // else the test would see nothing
}

TEST(RobocupPlaces, PostsAreAClassOfTheirOwn) {
  auto expander = robocup(1, 1);
  ASSERT_TRUE(expander) << expander.error().message;
  std::map<int, std::map<std::string, int>> of_category;
  for (const InstanceSpec& instance : frame_of(*expander).spec.instances) {
    if (instance.id != 0) ++of_category[instance.category][instance.asset];
  }
  using Assets = std::map<std::string, int>;
  EXPECT_EQ(of_category[0], (Assets{{"robot_standing", 1}}));  // the observer's own body
  EXPECT_EQ(of_category[2], (Assets{{"spl_ball", 1}}));
  EXPECT_EQ(of_category[3], (Assets{{"spl_goal_post", 4}}));
  EXPECT_EQ(of_category[4], (Assets{{"spl_goal", 2}}));
  EXPECT_EQ(of_category[5], (Assets{{"spl_lines", 1}}));
  EXPECT_EQ(of_category[6], (Assets{{"spl_field", 1}}));
}

std::size_t slot_of(const Mesh& mesh, const std::string& name) {
  const auto found = std::find(mesh.slot_names.begin(), mesh.slot_names.end(), name);
  EXPECT_NE(found, mesh.slot_names.end()) << name;
  return static_cast<std::size_t>(found - mesh.slot_names.begin());
}

TEST(RobocupJerseys, HaveTheNumbers1To5EachAsOften) {
  constexpr int kFrames = 200;
  auto expander = robocup(kFrames, 1);
  ASSERT_TRUE(expander) << expander.error().message;
  const auto asset = built_in_assets().load("robot_standing");
  ASSERT_TRUE(asset);
  const std::size_t slot = slot_of((*asset)->mesh, "number");
  std::map<std::string, double> robots_with;
  for (int frame = 0; frame < kFrames; ++frame) {
    const FrameSpec spec = frame_of(*expander, frame).spec;
    for (const InstanceSpec& instance : spec.instances) {
      if (!instance.name.starts_with("robots/")) continue;
      const auto material = static_cast<std::size_t>(instance.materials.at(slot));
      robots_with[spec.materials.at(material).textures.at("color")] += 1.0;
    }
  }
  std::vector<double> counts;
  for (const auto& [image, count] : robots_with) counts.push_back(count);
  ASSERT_EQ(counts.size(), 5U);
  EXPECT_GT(chi_squared_p(counts, std::vector<double>(5, 9.0 * kFrames / 5)), kLeastLawP);
}

TEST(RobocupJerseys, ANumberFillsItsSquareOnChestAndBackAndIsNotMirrored) {
  const auto asset = built_in_assets().load("robot_standing");
  ASSERT_TRUE(asset);
  const Mesh& mesh = (*asset)->mesh;
  const std::size_t slot = slot_of(mesh, "number");
  for (const double facing : {1.0, -1.0}) {
    // Who faces the chest sees the robot's left on the right.
    std::array<std::map<float, double>, 2> places;  // of u and v
    for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
      if (mesh.triangle_slots[triangle] != slot) continue;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto& at = mesh.positions[mesh.triangles[triangle][corner]];
        if (facing * at[0] < 0.0) continue;
        const std::array<float, 2>& uv = mesh.corner_uvs[3 * triangle + corner];
        places[0][uv[0]] = facing * at[1];
        places[1][uv[1]] = at[2];
      }
    }
    for (const std::map<float, double>& place_of_uv : places) {
      ASSERT_FALSE(place_of_uv.empty());
      const auto least = place_of_uv.begin();
      const auto most = place_of_uv.rbegin();
      EXPECT_NEAR(least->first, 0.0, 0.01);
      EXPECT_NEAR(most->first, 1.0, 0.01);
      EXPECT_NEAR(most->second - least->second, facing > 0.0 ? 0.062 : 0.08, 1e-3);
    }
  }
}

TEST(RobocupNesting, EachPhotometricSampleHasItsGeometricSamples) {
  constexpr int kPhotometric = 30;
  constexpr int kGeometric = 7;
  auto expander = robocup(kPhotometric, kGeometric);
  ASSERT_TRUE(expander) << expander.error().message;
  ASSERT_EQ(expander->frame_count(), kPhotometric * kGeometric);
  std::map<std::string, int> photometric, geometric;
  for (int frame = 0; frame < kPhotometric * kGeometric; ++frame) {
    const ExpandedFrame expanded = frame_of(*expander, frame);
    const Json& graph = expanded.graph;
    const Json light = {graph.at("intensity"), graph.at("temperature"), graph.at("field_color")};
    const Json places = {graph.at("ball"), graph.at("d"), graph.at("phi"), graph.at("gamma")};
    EXPECT_EQ(expanded.scene, frame / kGeometric);
    ++photometric[light.dump()];
    ++geometric[places.dump()];
  }
  EXPECT_EQ(photometric.size(), static_cast<std::size_t>(kPhotometric));
  EXPECT_EQ(geometric.size(), static_cast<std::size_t>(kPhotometric * kGeometric));
  for (const auto& [light, frames] : photometric) EXPECT_EQ(frames, kGeometric) << light;
}

}  // namespace
}  // namespace seedframe
