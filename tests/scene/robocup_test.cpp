// configs/robocup_spl.yaml against equations 1 to 7 of paper 1, over the draws of 10,000 scenes of
// one frame each. Without its constraint: which frames are then drawn again is tested elsewhere,
// and it would bend the distributions.

#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"
#include "tests/scene/statistics.h"

namespace seedframe {
namespace {

constexpr int kFrames = 10'000;
constexpr double kFieldWidth = 9.0;
constexpr double kFieldHeight = 6.0;

double normal_cdf(double x, double mean, double std) {
  return 0.5 * std::erfc(-(x - mean) / (std * std::numbers::sqrt2));
}

/// A robot as it stands in the world.
struct Robot {
  double x, y, yaw;
  std::string mesh;
};

class RobocupScene : public testing::Test {
 public:
  static void SetUpTestSuite() {
    auto expander =
        expander_of(fmt::format("base: robocup_spl.yaml\n"
                                "set: {{constraints: {{}}, scenes: {}, frames_per_scene: 1}}\n",
                                kFrames),
                    kHome / "configs" / "robocup_test.yaml");
    ASSERT_TRUE(expander) << expander.error().message;
    for (int scene = 0; scene < kFrames; ++scene) {
      const auto frame = expander->expand(scene, {.id = false, .draws = true, .graph = true});
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
    std::vector<Robot>& robots = robots_of_frames.emplace_back();
    std::map<std::string, double> draws;
    for (const Draw& draw : frame.draws) {
      if (draw.name.starts_with("objects.robots.asset/")) robots.push_back({0, 0, 0, draw.value});
      if (draw.value.is_number()) draws[draw.name] = draw.value.get<double>();
    }
    for (std::size_t i = 0; i < robots.size(); ++i) {
      robots[i].x = draws.at(fmt::format("objects.robots.position[0]/{}", i));
      robots[i].y = draws.at(fmt::format("objects.robots.position[1]/{}", i));
      robots[i].yaw = draws.at(fmt::format("objects.robots.rotation_deg[2]/{}", i));
    }
  }

  static double uniform_p(const std::vector<double>& samples, double low, double high) {
    return kolmogorov_p(samples, [=](double x) { return (x - low) / (high - low); });
  }

  static inline std::map<std::string, std::vector<double>> values;
  static inline std::vector<std::vector<Robot>> robots_of_frames;
};

TEST_F(RobocupScene, Equation1TheBallIsUniformOverTheField) {
  EXPECT_GT(uniform_p(values["ball.x"], 0.0, kFieldWidth), kLeastP);
  EXPECT_GT(uniform_p(values["ball.y"], 0.0, kFieldHeight), kLeastP);
  EXPECT_LT(std::abs(correlation(values["ball.x"], values["ball.y"])), 0.04);
}

TEST_F(RobocupScene, Equation2TheObserverStandsOnACircleAroundTheBall) {
  std::vector<double> distances, angles;
  for (std::size_t i = 0; i < kFrames; ++i) {
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
  EXPECT_GT(uniform_p(distances, 0.3, 1.5), kLeastP);
  EXPECT_GT(uniform_p(angles, -std::numbers::pi, std::numbers::pi), kLeastP);
  EXPECT_LT(std::abs(correlation(distances, angles)), 0.04);
  EXPECT_LT(std::abs(correlation(distances, values["ball.x"])), 0.04);
}

TEST_F(RobocupScene, Equation3TheObserverLooksPastTheBallByUpToHalfItsFieldOfView) {
  EXPECT_GT(uniform_p(values["gamma"], -30.5, 30.5), kLeastP);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double beta = std::atan2(values["ball.y"][i] - values["observer.y"][i],
                                   values["ball.x"][i] - values["observer.x"][i]);
    ASSERT_NEAR(values["alpha"][i], beta * 180.0 / std::numbers::pi + values["gamma"][i], 1e-9);
  }
  EXPECT_LT(std::abs(correlation(values["gamma"], values["phi"])), 0.04);
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
  EXPECT_GT(uniform_p(x, 0.0, kFieldWidth), kLeastP);
  EXPECT_GT(uniform_p(y, 0.0, kFieldHeight), kLeastP);
  EXPECT_GT(uniform_p(yaw, 0.0, 360.0), kLeastP);
  EXPECT_LT(std::abs(correlation(x, yaw)), 0.015);
  EXPECT_LT(std::abs(correlation(first_x, second_x)), 0.04);
  EXPECT_LT(std::abs(correlation(first_x, values["ball.x"])), 0.04);
}

TEST_F(RobocupScene, RobotsStandSitAndLieAsOftenAsThePaperSays) {
  std::vector<double> counts(3, 0.0);
  for (const std::vector<Robot>& robots : robots_of_frames) {
    for (const Robot& robot : robots) {
      if (robot.mesh == "robot_standing") counts[0] += 1.0;
      if (robot.mesh == "robot_sitting") counts[1] += 1.0;
      if (robot.mesh == "robot_lying") counts[2] += 1.0;
    }
  }
  const double all = 9.0 * kFrames;
  EXPECT_EQ(counts[0] + counts[1] + counts[2], all);
  EXPECT_GT(chi_squared_p(counts, {0.8 * all, 0.1 * all, 0.1 * all}), kLeastP);
}

TEST_F(RobocupScene, Equation5OneOfTheNormalDistributionsGivesTheIntensity) {
  EXPECT_GT(kolmogorov_p(values["intensity"],
                         [](double x) {
                           return (normal_cdf(x, 1700, 50) + normal_cdf(x, 2650, 50) +
                                   normal_cdf(x, 3600, 50)) /
                                  3.0;
                         }),
            kLeastP);
}

TEST_F(RobocupScene, Equation6TheTemperatureIsUniform) {
  EXPECT_GT(uniform_p(values["temperature"], 3000.0, 12000.0), kLeastP);
  EXPECT_LT(std::abs(correlation(values["temperature"], values["intensity"])), 0.04);
}

TEST_F(RobocupScene, Equation7TheFieldIsGreenOfUniformHueSaturationAndValue) {
  // The variable is linear RGB; back to HSV: value and saturation from the largest and the least.
  const auto encode = [](double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
  };
  std::vector<double> hue, saturation, value;
  for (std::size_t i = 0; i < kFrames; ++i) {
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
  EXPECT_GT(uniform_p(hue, 100.0, 140.0), kLeastP);
  EXPECT_GT(uniform_p(saturation, 0.5, 1.0), kLeastP);
  EXPECT_GT(uniform_p(value, 0.25, 1.0), kLeastP);
  EXPECT_LT(std::abs(correlation(hue, saturation)), 0.04);
  EXPECT_LT(std::abs(correlation(saturation, value)), 0.04);
}

}  // namespace
}  // namespace seedframe
