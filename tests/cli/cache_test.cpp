// Frames that have been rendered on this machine are linked, not rendered; and only those.

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kCached = R"(seedframe: 1
name: cached
scenes: 4
frames_per_scene: 3
categories: [gear]
render: {width: 32, height: 24, samples: 1}
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
camera: {distance_m: {uniform: [0.2, 0.5]}}
labels: {check: false}
)";

class CacheTest : public ProgramTest {
 protected:
  void SetUp() override { write_config("cached.yaml", kCached); }
  Outcome with_cache(std::vector<std::string> arguments, const std::string& fake = "{}") {
    arguments.insert(arguments.end(), {"--blender", kFakeBlender});
    return run(arguments,
               {"SEEDFRAME_CACHE=" + (folder_ / "cache").string(), "SEEDFRAME_FAKE=" + fake});
  }
  Outcome submit(const std::string& campaign, std::vector<std::string> more = {},
                 const std::string& fake = "{}") {
    std::vector<std::string> arguments = {"submit", "cached.yaml", "-o", campaign};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = with_cache(arguments, fake);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return outcome;
  }
};

TEST_F(CacheTest, TheSameCampaignAgainIsLinked) {
  EXPECT_THAT(submit("a").output, Not(HasSubstr("found on this machine")));
  // A worker that renders nothing but failures shows that none was asked.
  const Outcome again = submit("b", {}, R"({"fail_frames": "all", "fail_attempts": 99})");
  EXPECT_THAT(again.output, HasSubstr("12 in this run, 12 of them found on this machine"));
  EXPECT_EQ(contents("a/frames"), contents("b/frames"));
  EXPECT_EQ(std::filesystem::hard_link_count(folder_ / "a/frames/000/000003/image.png"), 2u);
  EXPECT_EQ(status("a").at("dataset_hash"), status("b").at("dataset_hash"));
  EXPECT_THAT(run({"explain", "b", "3"}).output,
              HasSubstr("attempt 1  found on this machine, done"));
  EXPECT_THAT(with_cache({"resume", "b"}).output, HasSubstr("0 in this run"));
  EXPECT_EQ(run({"audit", "b", "--frames", "0"}).exit_code, 0);
}

TEST_F(CacheTest, OnlyTheSameFramesMadeWithTheSameAreTaken) {
  submit("a");
  EXPECT_THAT(submit("seed", {"--set", "seed=5"}).output, Not(HasSubstr("found on")));
  EXPECT_THAT(submit("kernel", {}, R"({"kernel": "avx"})").output, Not(HasSubstr("found on")));
  EXPECT_THAT(submit("names", {"--set", "categories=[gear, other]"}).output,
              Not(HasSubstr("found on")));
  EXPECT_THAT(submit("off", {"--no-cache"}).output, Not(HasSubstr("found on")));
  EXPECT_THAT(submit("none", {"--set", "determinism=none"}).output, Not(HasSubstr("found on")));
  EXPECT_THAT(submit("more", {"--set", "scenes=5"}).output,
              HasSubstr("15 in this run, 12 of them found on this machine"));
  EXPECT_THAT(submit("threads", {"--threads", "2"}).output, HasSubstr("12 of them found"))
      << "threads change no pixel";
}

TEST_F(CacheTest, WhatIsGoneOrDamagedIsRendered) {
  submit("a");
  std::filesystem::remove_all(folder_ / "a/frames/000/000002");
  std::string image = *read_file(folder_ / "a/frames/000/000005/image.png");
  image[image.size() / 2] = static_cast<char>(image[image.size() / 2] ^ 1);
  write("a/frames/000/000005/image.png", image);
  EXPECT_THAT(submit("b").output, HasSubstr("12 in this run, 10 of them found on this machine"));
  EXPECT_EQ(run({"audit", "b", "--frames", "0"}).exit_code, 0);
  // b is now where they are found.
  EXPECT_THAT(submit("c").output, HasSubstr("12 of them found on this machine"));
}

/// What an environment says of a worker does not change by itself; what is in a file does.
class CacheOfStartsTest : public CacheTest {
 protected:
  void SetUp() override {
    CacheTest::SetUp();
    write("blender", "#!/bin/sh\necho start >>" + (folder_ / "starts").string() + "\nexec " +
                         kFakeBlender + " \"$@\"\n");
    std::filesystem::permissions(folder_ / "blender", std::filesystem::perms::owner_all);
    set_kernel("avx2");
  }
  void set_kernel(const std::string& name) { write("kernel", name + "\n"); }
  Outcome submit(const std::string& campaign, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"submit", "cached.yaml", "-o",
                                          campaign, "--blender",   (folder_ / "blender").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(
        arguments, {"SEEDFRAME_CACHE=" + (folder_ / "cache").string(),
                    R"(SEEDFRAME_FAKE={"kernel_from": ")" + (folder_ / "kernel").string() + "\"}"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return outcome;
  }
  /// Of Blender, to ask for its version too.
  std::size_t starts() const {
    const auto text = read_file(folder_ / "starts");
    return text ? static_cast<std::size_t>(std::count(text->begin(), text->end(), '\n')) : 0;
  }
  /// Kernels that the frames of a campaign were made with.
  std::set<std::string> kernels(const std::string& campaign) {
    std::set<std::string> names;
    for (int frame = 0; frame < 12; ++frame) {
      const Outcome outcome = run({"explain", campaign, std::to_string(frame), "--json"});
      const auto json = parse_json(outcome.output, "explain");
      if (json) names.insert(json->at("attempts").back().at("provenance").at("kernel"));
    }
    return names;
  }
};

TEST_F(CacheOfStartsTest, ACampaignThatIsAllThereStartsNoBlender) {
  submit("a");
  const std::size_t before = starts();
  EXPECT_GE(before, 2u) << "for its version, and as a worker";
  EXPECT_THAT(submit("b").output, HasSubstr("12 in this run, 12 of them found on this machine"));
  EXPECT_EQ(starts(), before);
  EXPECT_EQ(contents("a/frames"), contents("b/frames"));
  EXPECT_EQ(status("a").at("dataset_hash"), status("b").at("dataset_hash"));
  EXPECT_EQ(kernels("b"), std::set<std::string>{"avx2"});
  EXPECT_FALSE(exists("b/work"));
}

TEST_F(CacheOfStartsTest, WorkersStartForWhatIsNotThere) {
  submit("a");
  const std::size_t before = starts();
  EXPECT_THAT(submit("b", {"--set", "scenes=5", "--workers", "1"}).output,
              HasSubstr("15 in this run, 12 of them found on this machine"));
  EXPECT_EQ(starts(), before + 1);
}

TEST_F(CacheOfStartsTest, AFrameThatTurnsOutDamagedIsRendered) {
  submit("a");
  std::string image = *read_file(folder_ / "a/frames/000/000005/image.png");
  image[image.size() / 2] = static_cast<char>(image[image.size() / 2] ^ 1);
  write("a/frames/000/000005/image.png", image);
  EXPECT_THAT(submit("b").output, HasSubstr("12 in this run, 11 of them found on this machine"));
  EXPECT_EQ(run({"audit", "b", "--frames", "0"}).exit_code, 0);
}

TEST_F(CacheOfStartsTest, AWorkerThatIsNotAsRememberedIsNoticed) {
  submit("a");
  set_kernel("avx");
  const Outcome outcome = submit("b", {"--set", "scenes=5"});
  EXPECT_THAT(outcome.output, HasSubstr("15 in this run,"));
  EXPECT_THAT(outcome.output, Not(HasSubstr("found on this machine")));
  EXPECT_THAT(outcome.errors, HasSubstr("12 frames that were found on this machine were made with "
                                        "something else"));
  EXPECT_EQ(kernels("b"), std::set<std::string>{"avx"});
  EXPECT_EQ(run({"audit", "b", "--frames", "0"}).exit_code, 0);
  // Now it is remembered as it is, and what it made is found; what it did not make is not.
  const std::size_t before = starts();
  EXPECT_THAT(submit("c").output, HasSubstr("12 of them found on this machine"));
  EXPECT_EQ(starts(), before);
  EXPECT_EQ(kernels("c"), std::set<std::string>{"avx"});
}

TEST_F(CacheOfStartsTest, ABlenderThatWasReplacedIsStarted) {
  submit("a");
  const std::size_t before = starts();
  write("blender", *read_file(folder_ / "blender") + "# another one\n");
  EXPECT_THAT(submit("b").output, Not(HasSubstr("found on this machine")));
  EXPECT_GE(starts(), before + 2);
}

TEST_F(CacheTest, AFrameThatIsAskedForIsRendered) {
  submit("a");
  const Outcome outcome = with_cache({"resume", "a", "--frame", "3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("(1 in this run, "));
  EXPECT_THAT(outcome.output, Not(HasSubstr("found on")));
}

TEST_F(CacheTest, AnAuditRenders) {
  submit("a");
  const Outcome outcome = with_cache({"audit", "a", "--frames", "2", "--quiet"},
                                     R"({"brighter_frames": "all", "brighter_attempts": 99})");
  EXPECT_EQ(outcome.exit_code, 9) << outcome.output;
}

TEST_F(CacheTest, ACacheThatCannotBeUsedIsNone) {
  write("cache", "a file, where the folder should be");
  EXPECT_THAT(submit("a").output, Not(HasSubstr("found on")));
  std::filesystem::remove(folder_ / "cache");
  std::filesystem::create_directories(folder_ / "cache");
  write("cache/frames.sqlite", std::string(5000, 'x'));
  EXPECT_THAT(submit("b").output, Not(HasSubstr("found on")));
}

}  // namespace
}  // namespace seedframe
