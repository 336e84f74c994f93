// What must hold in a frame, and what happens when it does not.

#include "scene/constraints.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

/// A camera at the origin that looks along y, and what is in front of it.
std::string with_constraint(const std::string& constraint, const std::string& objects,
                            const std::string& more = "", int max_attempts = 3) {
  return "seedframe: 1\nseed: 1\nmax_attempts: " + std::to_string(max_attempts) +
         "\nrender: {width: 100, height: 80}\nconstraints: {c: {" + constraint + "}}\nobjects:\n" +
         objects + kCameraAtOrigin + more;
}

/// Whether the constraint holds in the only frame.
bool holds(const std::string& constraint, const std::string& objects) {
  const std::string error = scene_error(with_constraint(constraint, objects));
  if (error == "(no error)") return true;
  EXPECT_THAT(error, HasSubstr("'c' was not met"));
  return false;
}

std::string cube(const std::string& name, const std::string& position,
                 const std::string& more = "") {
  return "  " + name + ": {asset: cube, category: none, position: " + position + more + "}\n";
}

TEST(Constraint, VisibleIsTheShareThatNothingHides) {
  // A wall in front of the right half of a cube: the image's middle is at x = 0.
  const std::string half =
      cube("a", "[0, 2, 0]") + cube("wall", "[0.5, 1, 0]", ", scale: [20, 0.1, 20]");
  EXPECT_TRUE(holds("type: visible, objects: [a], at_least: 0.45", half));
  EXPECT_FALSE(holds("type: visible, objects: [a], at_least: 0.55", half));
  EXPECT_TRUE(holds("type: visible, objects: [wall], at_least: 1", half));
  EXPECT_TRUE(holds("type: visible", cube("a", "[0, 2, 0]")));
}

TEST(Constraint, VisibleAsksOnlyAboutWhatIsInTheImage) {
  // Half of it reaches out of the image to the left; the default focal length is 107 px.
  EXPECT_TRUE(holds("type: visible, at_least: 1", cube("a", "[-0.93, 2, 0]")));
  EXPECT_FALSE(holds("type: visible", cube("a", "[-50, 2, 0]")));
  EXPECT_FALSE(holds("type: visible", cube("a", "[0, -2, 0]")));
}

TEST(Constraint, TheGroundHides) {
  const std::string text = "seedframe: 1\nmax_attempts: 3\nobjects:\n" + cube("a", "[0, 2, -0.1]") +
                           "constraints: {c: {type: visible, at_least: 0.1}}\n"
                           "camera: {position: [0, 0, 1], target: [0, 2, 0]}\n";
  EXPECT_EQ(scene_error(text), "(no error)");
  EXPECT_THAT(scene_error(text + "ground: {}\n"), HasSubstr("'c' was not met"));
  // A ground that falls away lies 0.4 m lower at the cube's place.
  EXPECT_EQ(scene_error(text + "ground: {curvature_per_m: -0.2}\n"), "(no error)");
}

TEST(Constraint, InViewIsTheShareInsideTheImageHiddenOrNot) {
  const std::string wall = cube("wall", "[0, 1, 0]", ", scale: [20, 0.1, 20]");
  EXPECT_TRUE(holds("type: in_view, objects: [a]", cube("a", "[0, 2, 0]") + wall));
  EXPECT_FALSE(holds("type: in_view", cube("a", "[-0.93, 2, 0]")));
  EXPECT_TRUE(holds("type: in_view, at_least: 0.4", cube("a", "[-0.93, 2, 0]")));
  EXPECT_FALSE(holds("type: in_view, at_least: 0.6", cube("a", "[-0.93, 2, 0]")));
}

TEST(Constraint, PixelsAreCounted) {
  // 50 mm at 2 m and 107 px: 2.7 pixels wide; at 0.5 m 11 wide.
  EXPECT_TRUE(holds("type: pixels, at_least: 4", cube("a", "[0, 2, 0]")));
  EXPECT_FALSE(holds("type: pixels, at_least: 16", cube("a", "[0, 2, 0]")));
  EXPECT_TRUE(holds("type: pixels, at_least: 100", cube("a", "[0, 0.5, 0]")));
  EXPECT_FALSE(holds("type: pixels", cube("a", "[0, 2, 0]", ", hidden_from: [camera]")));
}

TEST(Constraint, ApartLooksAtSurfaces) {
  const std::string near = cube("a", "[0, 2, 0]") + cube("b", "[0.06, 2, 0]");  // 10 mm between
  EXPECT_TRUE(holds("type: apart", near));
  EXPECT_TRUE(holds("type: apart, at_least: 9mm", near));
  EXPECT_FALSE(holds("type: apart, at_least: 11mm", near));
  EXPECT_FALSE(holds("type: apart", cube("a", "[0, 2, 0]") + cube("b", "[0.04, 2, 0]")));
  // One inside the other.
  EXPECT_FALSE(
      holds("type: apart", cube("a", "[0, 2, 0]") + cube("b", "[0, 2, 0]", ", scale: 0.2")));
}

TEST(Constraint, DistanceLooksAtMiddles) {
  const std::string two = cube("a", "[0, 2, 0]") + cube("b", "[0.3, 2, 0.4]");
  EXPECT_TRUE(holds("type: distance, at_least: 49cm", two));
  EXPECT_FALSE(holds("type: distance, at_least: 51cm", two));
  EXPECT_FALSE(holds("type: distance, at_least: 0.51", two));
}

TEST(Constraint, IsAboutTheObjectsThatItNames) {
  const std::string touching = cube("a", "[0, 2, 0]") + cube("b", "[0.04, 2, 0]") +
                               "  g: {objects: {c: {asset: cube, category: none, position: [1, 2, "
                               "0]}}}\n";
  EXPECT_TRUE(holds("type: apart, objects: [a, c]", touching));
  EXPECT_FALSE(holds("type: apart, objects: [a, b]", touching));
  EXPECT_FALSE(holds("type: distance, objects: [c, a], at_least: 2", touching));
  EXPECT_TRUE(holds("type: distance, objects: [a], at_least: 2", touching));
}

TEST(Constraint, AllCopiesCount) {
  const std::string row =
      "  o: {asset: cube, category: none, count: 3, position: [copy_index * 0.06, 2, 0]}\n";
  EXPECT_TRUE(holds("type: distance, at_least: 0.05", row));
  EXPECT_FALSE(holds("type: distance, at_least: 0.07", row));
  EXPECT_FALSE(holds("type: in_view",
                     "  o: {asset: cube, category: none, count: 3, position: [copy_index * 0.6, 2, "
                     "0]}\n"));
}

TEST(Constraint, HoldsOfNothing) {
  for (const char* type : {"visible", "in_view", "pixels", "apart", "distance"}) {
    EXPECT_TRUE(holds(std::string("type: ") + type + ", at_least: 1", "  g: {objects: {}}\n"))
        << type;
  }
}

TEST(Constraint, ABoundOfZeroHoldsOfWhatIsNotThere) {
  EXPECT_TRUE(holds("type: visible, at_least: 0", cube("a", "[0, -2, 0]")));
}

TEST(Constraint, BoundsMayVary) {
  const std::string text = with_constraint(
      "type: distance, at_least: bound", cube("a", "[0, 2, 0]") + cube("b", "[0.5, 2, 0]"),
      "variables: {frame: {bound: {choice: [0.1, 5]}}}\nframes_per_scene: 20\n", 100);
  for (const ExpandedFrame& frame : all_frames(text)) EXPECT_EQ(frame.graph.at("bound"), 0.1);
}

}  // namespace
}  // namespace seedframe
