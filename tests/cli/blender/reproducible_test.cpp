// The main job with the real Blender: the same bytes whatever the workers and whatever happened on
// the way.

#include <chrono>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/formats.h"
#include "tests/cli/program.h"
#include "tests/fixtures/real_blender.h"
#include "tests/fixtures/script.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

constexpr const char* kConfig = R"(seedframe: 1
name: real
seed: 11
scenes: 4
frames_per_scene: 3
categories: [gear, hex_bolt]
render: {width: 96, height: 72, samples: 4, passes: [depth, normal]}
objects:
  gears:
    asset: gear
    count: {integer: [1, 3]}
    scatter: {x: [-0.1, 0.1], y: [-0.1, 0.1]}
    rest_on_ground: true
    material: {choice: [brass, plastic]}
  bolts:
    asset: hex_bolt
    count: 2
    redraw: frame
    scatter: {x: [-0.1, 0.1], y: [-0.1, 0.1]}
    rest_on_ground: true
    rotation_deg: [90, 0, {uniform: [0, 360]}]
    material: steel
  balls: {asset: sphere, category: none, position: [0, 0, 0.1], scale: 0.4, material: painted_metal}
ground: {width_m: 2, depth_m: 2, material: {choice: [Concrete01, Planks01]}}
lights: {key: {type: area, position: [0.3, -0.4, 0.8], power: {uniform: [5, 12]}}}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.3, 0.5]}, azimuth_deg: {uniform: [0, 360]}}
)";

class RealBlenderCampaign : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("real.yaml", kConfig);
    // Blender, and a line for each of its starts.
    const auto blender = find_blender(test_blender());
    ASSERT_TRUE(blender) << blender.error().message;
    const bool is_module = !blender->module.empty();
    if (is_module) {
      std::filesystem::create_directories(folder_ / "blender/bin");
      std::filesystem::create_symlink(blender->path.parent_path().parent_path() / "lib",
                                      folder_ / "blender/lib");
    }
    write_script(folder_ / (is_module ? "blender/bin/python" : "blender.sh"),
                 "#!/bin/sh\n[ \"$1\" = --version ] || echo start >> " +
                     (folder_ / "starts.txt").string() + "\nexec " + blender->path.string() +
                     " \"$@\"\n");
    counted_blender_ = is_module ? "python:blender" : "./blender.sh";
  }
  std::vector<std::string> submit(const std::string& campaign, const std::string& workers) {
    return {"submit",    "real.yaml", "-o",        campaign,
            "--workers", workers,     "--blender", counted_blender_};
  }
  std::string counted_blender_;
  int starts() const {
    const auto text = read_file(folder_ / "starts.txt");
    return text ? static_cast<int>(std::count(text->begin(), text->end(), '\n')) : 0;
  }
  void export_all(const std::string& campaign) {
    std::vector<std::string> arguments = {"export", campaign, "--split", "train=0.5,val=0.5"};
    for (const FormatEntry& format : export_formats()) {
      arguments.emplace_back("--format");
      arguments.emplace_back(format.name);
    }
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  }
};

TEST_F(RealBlenderCampaign, OneWorkerTwoWorkersAndAKilledRunGiveTheSameBytes) {
  const Outcome one = run(submit("one", "1"));
  ASSERT_EQ(one.exit_code, 0) << one.errors;
  EXPECT_EQ(starts(), 1) << "one Blender start per worker and campaign";
  const Outcome two = run(submit("two", "2"));
  ASSERT_EQ(two.exit_code, 0) << two.errors;
  EXPECT_EQ(starts(), 3);

  const pid_t pid = start(submit("killed", "2"));
  while (!exists("killed/frames/000/000004")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_EQ(::kill(pid, 0), 0);
  }
  ::kill(pid, SIGKILL);
  wait(pid);
  EXPECT_FALSE(exists("killed/frames/000/000011")) << "the kill came too late to mean anything";
  const Outcome resumed =
      run({"resume", "killed", "--workers", "1", "--blender", counted_blender_});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;

  const std::string hash = status("one").at("dataset_hash");
  EXPECT_EQ(hash.size(), 64u);
  EXPECT_EQ(status("two").at("dataset_hash"), hash);
  EXPECT_EQ(status("killed").at("dataset_hash"), hash);
  const auto frames = contents("one/frames");
  EXPECT_EQ(frames.size(), 12u * 9u);
  EXPECT_EQ(contents("two/frames"), frames);
  EXPECT_EQ(contents("killed/frames"), frames);
  for (const char* campaign : {"one", "two", "killed"}) export_all(campaign);
  const auto exports = contents("one/exports");
  EXPECT_EQ(contents("two/exports"), exports);
  EXPECT_EQ(contents("killed/exports"), exports);
  const std::string one_folder = (folder_ / "one").string();
  const Outcome decoded =
      python("decoders/agreement.py " + one_folder + " " + one_folder + "/exports");
  EXPECT_EQ(decoded.exit_code, 0) << decoded.output;
  const Outcome pages = python("run_pages.py " + one_folder + "/exports");
  EXPECT_EQ(pages.exit_code, 0) << pages.output;
  const Outcome verified = run({"export", "one", "--verify"});
  EXPECT_EQ(verified.exit_code, 0) << verified.errors;
  const auto made_with = [&](const char* campaign) {
    Json json = *parse_json(*read_file(folder_ / campaign / "provenance.json"), campaign);
    for (Json& attempt : json.at("attempts")) attempt.erase("threads");
    return json;
  };
  EXPECT_EQ(made_with("two"), made_with("one"));

  // No clock time, host name or absolute path in what is given away.
  char host[256] = {};
  ::gethostname(host, sizeof host - 1);
  for (const auto& [name, bytes] : frames) {
    EXPECT_EQ(bytes.find(folder_.string()), std::string::npos) << name;
    if (std::string(host).size() > 4) {
      EXPECT_EQ(bytes.find(host), std::string::npos) << name;
    }
  }

  const Outcome explained = run({"explain", "one", "7"});
  EXPECT_EQ(explained.exit_code, 0);
  EXPECT_THAT(explained.output, HasSubstr("objects.bolts.scatter.x/1"));
  EXPECT_THAT(explained.output, HasSubstr("seedframe resume one --frame 7"));
}

TEST_F(RealBlenderCampaign, JpegsAreExportedAsTheyAre) {
  auto arguments = submit("jpeg", "2");
  arguments.insert(arguments.end(), {"--set", "image.format=jpeg"});
  const Outcome made = run(arguments);
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  export_all("jpeg");
  const std::string folder = (folder_ / "jpeg").string();
  for (const char* script : {"decoders/agreement.py ", "pictures.py "}) {
    const Outcome decoded = python(script + folder + " " + folder + "/exports");
    EXPECT_EQ(decoded.exit_code, 0) << decoded.output;
  }
  const Outcome pages = python("run_pages.py " + folder + "/exports");
  EXPECT_EQ(pages.exit_code, 0) << pages.output;
  const Outcome verified = run({"export", "jpeg", "--verify"});
  EXPECT_EQ(verified.exit_code, 0) << verified.errors;
}

TEST_F(RealBlenderCampaign, AFrameIsTheSameInAnotherCampaignThatHoldsIt) {
  auto arguments = submit("few", "1");
  arguments.insert(arguments.end(), {"--frames", "2"});
  ASSERT_EQ(run(arguments).exit_code, 0);
  const auto before = contents("few/frames/000/000001");
  ASSERT_EQ(run({"resume", "few", "--frame", "1", "--blender", counted_blender_}).exit_code, 0);
  EXPECT_EQ(contents("few/frames/000/000001"), before);
}

TEST_F(RealBlenderCampaign, DoctorFindsWhatItNeeds) {
  const Outcome outcome = run({"doctor"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("ok    Blender"));
}

}  // namespace
}  // namespace seedframe
