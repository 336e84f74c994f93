// What seedframe audit sees without rendering: files that were changed together with what vouches
// for them, frames that are missing from the store, provenance, exports, and what belongs to
// nothing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/sha256.h"
#include "tests/cli/program.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kSmallCampaign = R"(seedframe: 1
name: audited
seed: 3
scenes: 2
frames_per_scene: 2
categories: [gear]
render: {width: 32, height: 24, samples: 1, passes: [depth, normal]}
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
camera: {distance_m: {uniform: [0.2, 0.5]}}
labels: {check: false}
)";

class AuditContents : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("audited.yaml", kSmallCampaign);
    const Outcome made = run({"submit", "audited.yaml", "-o", "c", "--blender", kFakeBlender});
    ASSERT_EQ(made.exit_code, 0) << made.errors;
  }
  Outcome audit() { return run({"audit", "c", "--frames", "0"}); }
  /// The audit ends with exit code 5, or the one that is asked for, and says all of this.
  void expect_found(const std::vector<std::string>& texts, int exit_code = 5) {
    const Outcome outcome = audit();
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.output << outcome.errors;
    for (const std::string& text : texts) EXPECT_THAT(outcome.output, HasSubstr(text));
  }
  static std::string file_of(int frame, const std::string& name) {
    return fmt::format("c/frames/000/{:06}/{}", frame, name);
  }
  /// Changes a file of a frame, and its entry in the manifest.
  void replace_file(int frame, const std::string& name, const std::string& bytes) {
    write(file_of(frame, name), bytes);
    Json manifest = Json::parse(*read_file(folder_ / file_of(frame, "manifest.json")));
    manifest["files"][name] = {{"bytes", bytes.size()}, {"sha256", sha256_hex(bytes)}};
    write(file_of(frame, "manifest.json"), readable_json(manifest));
  }
  void replace_by_that_of(int frame, const std::string& name, int other) {
    replace_file(frame, name, *read_file(folder_ / file_of(other, name)));
  }
};

TEST_F(AuditContents, AGoodCampaignHasNothingToComplainOf) { expect_found({}, 0); }

TEST_F(AuditContents, FilesChangedTogetherWithTheirManifestAreNamed) {
  Json labels = Json::parse(*read_file(folder_ / file_of(0, "labels.json")));
  labels["instances"][0]["name"] = "gears/7";
  replace_file(0, "labels.json", readable_json(labels));
  replace_by_that_of(1, "image.png", 0);
  replace_by_that_of(2, "depth.exr", 0);
  replace_by_that_of(3, "passes.exr", 0);
  expect_found({"4 are not as they were written", "000000/labels.json does not follow from",
                "000001/image.png has other pixels", "000002/depth.exr has other pixels",
                "000003/passes.exr has other pixels"});
}

TEST_F(AuditContents, LabelsAndTheirImageChangedTogetherAreNamed) {
  for (const char* name : {"labels.json", "instances.png", "semantic.png"}) {
    replace_by_that_of(1, name, 0);
  }
  expect_found({"000001/instances.png has other pixels"});
}

TEST_F(AuditContents, FramesThatTheStoreLostAreNamed) {
  change_store("c", "DELETE FROM frames WHERE frame = 3");
  expect_found({"the job store does not know frame 3", "frames/000/000003 is of no frame"});
  change_store("c", "DELETE FROM frames WHERE frame = 1");
  expect_found({"the job store does not know frame 1", "the job store does not know frame 3"});
}

TEST_F(AuditContents, AFrameIdThatIsNotThatOfItsSpecIsNamed) {
  const std::string id(64, 'a');
  change_store("c", "UPDATE frames SET frame_id = '" + id + "' WHERE frame = 2");
  Json manifest = Json::parse(*read_file(folder_ / file_of(2, "manifest.json")));
  manifest["frame_id"] = id;
  write(file_of(2, "manifest.json"), readable_json(manifest));
  expect_found({"000002/frame.json is not the spec of its frame id",
                "inputs: of 1 frames something else is asked today: 2"});
}

TEST_F(AuditContents, WhatBelongsToNoFrameIsNamed) {
  write(file_of(2, "notes.txt"), "mine");
  fs::create_directories(folder_ / "c/frames/000/000099");
  write("c/frames/list.txt", "mine");
  expect_found({"000002/notes.txt is not one of the frame's files",
                "frames/000/000099 is of no frame", "frames/list.txt is of no frame"});
}

TEST_F(AuditContents, ProvenanceIsComparedWithTheCampaign) {
  const std::string right = *read_file(folder_ / "c/provenance.json");
  Json provenance = Json::parse(right);
  provenance["seed"] = 4;
  provenance["assets"]["gear"] = std::string(64, '0');
  provenance["attempts"][0]["blender"] = "4.5";
  write("c/provenance.json", readable_json(provenance));
  expect_found({"provenance.json: seed is 4 instead of 3", "provenance.json: assets: gear has",
                "does not have what attempts were made with"});
  write("c/provenance.json", "{");
  expect_found({"provenance.json"});
  fs::remove(folder_ / "c/provenance.json");
  expect_found({"provenance.json"});
  write("c/provenance.json", right);
  expect_found({}, 0);
}

TEST_F(AuditContents, EveryFileOfEveryExportIsLookedAt) {
  std::vector<std::string> arguments = {"export", "c"};
  for (const char* format : {"yolo-detect", "voc", "bop", "patches", "statistics"}) {
    arguments.insert(arguments.end(), {"--format", format});
  }
  ASSERT_EQ(run(arguments).exit_code, 0);
  ASSERT_EQ(audit().exit_code, 0);
  const auto replace = [&](const std::string& path, const std::string& from,
                           const std::string& to) {
    std::string text = *read_file(folder_ / "c/exports" / path);
    ASSERT_THAT(text, HasSubstr(from)) << path;
    text.replace(text.find(from), from.size(), to);
    write("c/exports/" + path, text);
  };
  replace("yolo-detect/data.yaml", "gear", "rear");
  replace("voc/VOCdevkit/VOC2012/labelmap.txt", "gear", "rear");
  replace("bop/models/models_info.json", "diameter", "diametre");
  replace("bop/models.json", "gear", "rear");
  replace("bop/models/obj_000001.ply", "end_header", "end_hewder");
  replace("patches/classes.json", "gear", "rear");
  replace("statistics/statistics.json", "\"images\": 4", "\"images\": 5");
  replace("statistics/seedframe.json", "\"frames\": 4", "\"frames\": 5");
  write("c/exports/bop/notes.txt", "mine");
  fs::create_directories(folder_ / "c/exports/mine");
  expect_found({"data.yaml is not what it should be", "labelmap.txt is not what it should be",
                "models_info.json is not what it should be", "models.json is not what it should be",
                "obj_000001.ply is not what it should be", "classes.json is not what it should be",
                "statistics.json is not what it should be",
                "seedframe.json is not what it should be", "notes.txt belongs to no frame",
                "exports/mine is not an export"});
  fs::remove(folder_ / "c/exports/voc/seedframe.json");
  expect_found({"exports/voc is not an export"});
}

}  // namespace
}  // namespace seedframe
