// Copies that fall onto each other.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/object_placer.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

std::string piles(const std::string& more, int count) {
  return fmt::format(
      "seedframe: 1\nseed: 5\nobjects:\n  o: {{asset: cube, category: none, count: {}, scatter: "
      "{{x: [-0.1, 0.1], y: [-0.1, 0.1], pile: true}}, rest_on_ground: true}}\n{}{}",
      count, more, kCameraAtOrigin);
}

double height_of(const InstanceSpec& instance) { return place_of(instance).z(); }

TEST(Piles, MoreCopiesThanTheAreaHoldsLieOnEachOther) {
  const auto frame = first_frame(piles("", 60));  // of 50 mm, on 200 mm
  int on_ground = 0;
  double highest = 0.0;
  const double ground = [&] {
    double least = 1e9;
    for (const auto& each : frame.spec.instances) least = std::min(least, height_of(each));
    return least;
  }();
  for (const InstanceSpec& instance : frame.spec.instances) {
    on_ground += height_of(instance) < ground + 1e-9;
    highest = std::max(highest, height_of(instance) - ground);
  }
  EXPECT_GT(on_ground, 4);
  EXPECT_LT(on_ground, 30);
  EXPECT_GT(highest, 0.099);
}

TEST(Piles, NoTwoCubesAreInEachOther) {
  const auto frame = first_frame(piles("", 40));
  const auto& all = frame.spec.instances;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Vector3d apart = (place_of(all[i]) - place_of(all[j])).cwiseAbs();
      // Of 50 mm, with small chamfers: cells of about a millimetre.
      EXPECT_GT(apart.maxCoeff(), 0.047) << all[i].name << ' ' << all[j].name;
    }
  }
}

TEST(Piles, WhatIsNotPiledIsUnderThem) {
  const auto frame = first_frame(piles(
      "  slab: {asset: cube, category: none, scale: [20, 20, 1], rest_on_ground: true}\n", 3));
  const auto& all = frame.spec.instances;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(height_of(all[i]) - height_of(all[3]), 0.045) << all[i].name;
  }
}

TEST(Piles, PlacesAreThoseOfMoreCopies) {
  const auto few = first_frame(piles("", 5));
  const auto many = first_frame(piles("", 50));
  for (std::size_t i = 0; i < 5; ++i) {
    const Eigen::Vector3d apart =
        place_of(few.spec.instances[i]) - place_of(many.spec.instances[i]);
    EXPECT_LT(apart.head<2>().norm(), 1e-9);
  }
}

TEST(Piles, NeedSomethingToRestOnAndKeepNoGap) {
  const auto message = [](const std::string& object) {
    const auto read = read_campaign_config(
        "seedframe: 1\nobjects: {o: {" + object + "}}\ncamera: {distance_m: 1}\n", "p.yaml");
    return read ? std::string() : read.error().message;
  };
  const std::string scatter = "scatter: {x: [0, 1], y: [0, 1], pile: true";
  EXPECT_EQ(message("asset: cube, category: none, rest: stable, " + scatter + "}"), "");
  EXPECT_THAT(message("asset: cube, category: none, " + scatter + "}"),
              HasSubstr("add rest_on_ground: true or rest: stable"));
  EXPECT_THAT(
      message("asset: cube, category: none, rest_on_ground: true, " + scatter + ", gap_m: 0.1}"),
      HasSubstr("remove gap_m or pile"));
  EXPECT_THAT(message("objects: {}, rest_on_ground: true, " + scatter + "}"),
              HasSubstr("pile is for an asset"));
}

}  // namespace
}  // namespace seedframe
