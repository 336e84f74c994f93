// seedframe stream --keep: what it renders is a campaign like any other, whenever it ends.

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "store/job_store.h"
#include "tests/cli/program.h"
#include "tests/cli/stream_program.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kKeptConfig = R"(seedframe: 1
name: line
seed: 4
scenes: 3
frames_per_scene: 2
categories: [gear]
render: {width: 24, height: 16, samples: 1}
labels: {check: false}
variables: {scene: {turn: {uniform: [0deg, 90deg]}, height: {uniform: [0.2m, 0.4m]}}}
objects:
  gears: {asset: gear, rotation_deg: [0, 0, turn], scatter: {x: [-0.1, 0.1], y: [-0.1, 0.1]}, rest_on_ground: true}
camera: {position: [0m, -0.4m, height], target: [0, 0, 0], fov_deg: 50}
)";

std::string request(int id, const std::string& more) {
  return R"({"fidelity": "render", "id": )" + std::to_string(id) + (more.empty() ? "" : ", ") +
         more + "}";
}

class KeepTest : public ProgramTest {
 protected:
  void SetUp() override { write_config("line.yaml", kKeptConfig); }

  static std::vector<std::string> keeping(const std::string& folder, int workers = 2) {
    return {"--keep", folder, "--blender", kFakeBlender, "--workers", std::to_string(workers)};
  }
  /// Asks for scenes `first` to `last` and returns the answers by id.
  static std::map<int, Json> ask(Stream& stream, int first, int last) {
    for (int i = first; i <= last; ++i) {
      stream.say(request(i, R"("scene": )" + std::to_string(i)));
    }
    std::map<int, Json> answers;
    for (int i = first; i <= last; ++i) {
      const Json answer = stream.hear();
      if (answer.is_null()) break;
      answers[answer["id"].get<int>()] = answer;
    }
    return answers;
  }
  Json manifest(const std::string& campaign, std::int64_t frame) const {
    return Json::parse(*read_file(folder_ / campaign / "frames/000" / fmt::format("{:06}", frame) /
                                  "manifest.json"));
  }
  Outcome resume(const std::string& campaign) {
    return run({"resume", campaign, "--blender", kFakeBlender, "--verify"});
  }
};

TEST_F(KeepTest, WhatItRendersIsACampaignLikeAnyOther) {
  const std::vector<std::string> requests = {R"("values": {"turn": 10, "height": 0.3})",
                                             R"("values": {"turn": 80}, "scene": 7)",
                                             R"("scene": 7)",
                                             R"("scene": 7, "samples": 3)",
                                             R"("scene": 7, "denoise": true)",
                                             R"("scene": 7, "crop": [2, 3, 10, 8])",
                                             R"("scene": 7, "want": ["labels", "image", "depth"])"};
  Stream stream(folder_, keeping("k"));
  EXPECT_EQ(stream.hear()["ready"]["kept"], 0);
  std::map<std::int64_t, Json> kept;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    stream.say(request(static_cast<int>(i), requests[i]));
  }
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const Json answer = stream.hear();
    ASSERT_TRUE(answer.contains("kept")) << answer;
    const auto number = answer["kept"].get<std::int64_t>();
    kept[number] = answer;
    // An answer means that it is there.
    EXPECT_EQ(answer["frame_id"], manifest("k", number)["frame_id"]);
    EXPECT_EQ(answer["pixel_hashes"], manifest("k", number)["pixels"]);
  }
  EXPECT_EQ(kept.size(), requests.size());
  stream.say(R"({"id": "l"})");
  stream.say(R"({"id": "p", "fidelity": "preview", "want": ["image"]})");
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(stream.hear().contains("kept"));
  stream.close_input();
  ASSERT_EQ(stream.wait(), 0);

  const Outcome status = run({"status", "k", "--json"});
  ASSERT_EQ(status.exit_code, 0) << status.errors;
  EXPECT_EQ(Json::parse(status.output)["done"], requests.size());
  EXPECT_EQ(Json::parse(status.output)["inputs_touched"], Json::array());
  for (const std::vector<std::string>& verb : std::vector<std::vector<std::string>>{
           {"explain", "k", "3"},
           {"show", "k", "-o", "show.png"},
           {"report", "k"},
           {"export", "k", "--format", "coco"},
           {"audit", "k", "--blender", kFakeBlender, "--frames", "4"}}) {
    const Outcome outcome = run(verb);
    EXPECT_EQ(outcome.exit_code, 0) << verb.front() << outcome.output << outcome.errors;
  }
  const Outcome resumed = resume("k");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_THAT(resumed.output, HasSubstr("(0 in this run"));
  EXPECT_FALSE(exists("k/work"));

  // Its lines are what another campaign can be made of.
  const Outcome submitted = run({"submit", "line.yaml", "--set", "graphs=k/graphs.jsonl", "-o", "s",
                                 "--blender", kFakeBlender, "--quiet"});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.errors;
  for (const auto& [number, answer] : kept) EXPECT_EQ(manifest("s", number), manifest("k", number));
}

TEST_F(KeepTest, IsWhatTheConfigWouldMakeWithTheseSettings) {
  Stream stream(folder_, keeping("k", 1));
  stream.hear();
  stream.say(request(0, R"("samples": 5, "denoise": true, "crop": [1, 2, 9, 7])"));
  stream.say(request(1, R"("denoise": false)"));
  stream.hear();
  stream.hear();
  write("one.jsonl", "{}\n");
  for (const std::string& denoised : {std::string("oidn"), std::string("off")}) {
    std::vector<std::string> submit = {"submit",    "line.yaml",
                                       "--set",     "graphs=one.jsonl",
                                       "--set",     "render.denoise=" + denoised,
                                       "-o",        denoised,
                                       "--blender", kFakeBlender};
    if (denoised == "oidn") {
      submit.insert(submit.end(), {"--set", "render.samples=5", "--set",
                                   "render.region={x: 1, y: 2, width: 9, height: 7}"});
    }
    const Outcome outcome = run(submit, {R"(SEEDFRAME_FAKE={"denoisers": "OpenImageDenoise"})"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  }
  EXPECT_EQ(manifest("oidn", 0), manifest("k", 0));
  EXPECT_EQ(manifest("off", 0), manifest("k", 1));
}

TEST_F(KeepTest, ABlenderWithoutADenoiserIsAnErrorOfThatFrameAlone) {
  Stream stream(folder_, keeping("k", 1), R"({"no_denoiser": true})");
  stream.hear();
  stream.say(request(0, R"("denoise": true)"));
  const Json answer = stream.hear();
  EXPECT_EQ(answer["error"]["kind"], "render") << answer;
  EXPECT_THAT(answer["error"]["message"].get<std::string>(), HasSubstr("Open Image Denoise"));
  stream.say(request(1, ""));
  EXPECT_EQ(stream.hear()["kept"], 0) << "what fails leaves nothing";
}

TEST_F(KeepTest, TheSameFrameIsKeptOnceAndTheNextStreamGoesOn) {
  {
    Stream stream(folder_, keeping("k"));
    stream.hear();
    std::set<std::int64_t> numbers;
    for (int i = 0; i < 6; ++i) stream.say(request(i, R"("scene": )" + std::to_string(i % 2)));
    for (int i = 0; i < 6; ++i) numbers.insert(stream.hear()["kept"].get<std::int64_t>());
    EXPECT_EQ(numbers, (std::set<std::int64_t>{0, 1}));
    stream.close_input();
    EXPECT_EQ(stream.wait(), 0);
  }
  Stream stream(folder_, keeping("k"));
  EXPECT_EQ(stream.hear()["ready"]["kept"], 2);
  std::map<int, Json> answers = ask(stream, 0, 3);
  EXPECT_LT(answers[0]["kept"], 2);
  EXPECT_LT(answers[1]["kept"], 2);
  EXPECT_GE(answers[2]["kept"], 2);
  const Outcome second = run({"stream", "line.yaml", "--keep", "k"});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.errors, HasSubstr("another seedframe is at work"));
  stream.close_input();
  EXPECT_EQ(stream.wait(), 0);
  EXPECT_EQ(resume("k").exit_code, 0);
  EXPECT_EQ(Json::parse(run({"status", "k", "--json"}).output)["done"], 4);
}

TEST_F(KeepTest, RefusesWhatItWouldSpoil) {
  {
    Stream stream(folder_, keeping("k", 1));
    stream.hear();
    ask(stream, 0, 1);
    stream.close_input();
    EXPECT_EQ(stream.wait(), 0);
  }
  const auto refused = [&](std::vector<std::string> more, const std::string& why) {
    more.insert(more.begin(), {"stream", "line.yaml"});
    const Outcome outcome = run(more);
    EXPECT_EQ(outcome.exit_code, 2) << why;
    EXPECT_THAT(outcome.errors, HasSubstr(why));
  };
  refused({"--keep", "k", "--set", "render.samples=2"}, "of another config");
  refused({"--keep", "k", "--set", "labels=geometry"}, "renders nothing");
  refused({"--set", "frames_per_scene=2"}, "has one frame");
  fs::create_directories(folder_ / "full");
  write("full/thesis.tex", "precious");
  refused({"--keep", "full"}, "is not empty");
  ASSERT_EQ(run({"submit", "line.yaml", "-o", "s", "--blender", kFakeBlender}).exit_code, 0);
  refused({"--keep", "s"}, "not made by a stream");
  const Outcome resumed = run({"resume", "k", "--set", "graphs=else.jsonl"});
  EXPECT_EQ(resumed.exit_code, 2);
  EXPECT_THAT(resumed.errors, HasSubstr("stream --keep"));
  // Lines that are gone are no smaller campaign.
  write("k/graphs.jsonl", "{}\n");
  EXPECT_THAT(run({"resume", "k"}).errors, HasSubstr("it was cut"));
}

TEST_F(KeepTest, WhatCrashedBeforeIsToldOfTheFrame) {
  Stream stream(folder_, keeping("k", 1), R"({"crash_frames": [1], "crash_attempts": 1})");
  stream.hear();
  EXPECT_EQ(ask(stream, 0, 0)[0]["kept"], 0);
  stream.close_input();
  EXPECT_EQ(stream.wait(), 0);
  const auto store = JobStore::open(folder_ / "k/campaign.sqlite");
  ASSERT_TRUE(store) << store.error().message;
  const auto attempts = store->attempts(0);
  ASSERT_EQ(attempts->size(), 2U);
  EXPECT_EQ(attempts->at(0).outcome, AttemptOutcome::kCrash);
  EXPECT_EQ(attempts->at(1).outcome, AttemptOutcome::kDone);
  EXPECT_THAT(attempts->at(1).provenance, HasSubstr("\"blender\""));
}

TEST_F(KeepTest, AnEmptyOneIsACampaignToo) {
  {
    Stream stream(folder_, keeping("k"));
    stream.hear();
    ::kill(stream.process(), SIGKILL);
  }
  EXPECT_EQ(run({"status", "k"}).exit_code, 0);
  EXPECT_EQ(resume("k").exit_code, 0);
  Stream stream(folder_, keeping("k"));
  stream.hear();
  EXPECT_EQ(ask(stream, 0, 0)[0]["kept"], 0);
}

TEST_F(KeepTest, KilledAtAnyMomentItKeepsWhatWasAnswered) {
  std::map<std::int64_t, std::string> answered;
  for (int round = 0; round < 6; ++round) {
    Stream stream(folder_, keeping("k"), R"({"delay_s": 0.01})");
    ASSERT_FALSE(stream.hear().is_null()) << *read_file(folder_ / "err.txt");
    for (int i = 0; i < 30; ++i) {
      stream.say(request(i, R"("scene": )" + std::to_string(30 * round + i)));
    }
    for (int i = 0; i < 3 + 4 * round; ++i) {
      const Json answer = stream.hear();
      ASSERT_TRUE(answer.contains("kept")) << answer;
      answered[answer["kept"].get<std::int64_t>()] = answer["frame_id"].get<std::string>();
    }
    ::usleep(static_cast<useconds_t>(3000 * round));
    ::kill(stream.process(), SIGKILL);
    stream.wait();
    if (round % 2 == 0) continue;  // sometimes the next stream finds it as it is
    const Outcome resumed = resume("k");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  }
  EXPECT_EQ(resume("k").exit_code, 0);
  for (const auto& [number, id] : answered) EXPECT_EQ(manifest("k", number)["frame_id"], id);
  const Json status = Json::parse(run({"status", "k", "--json"}).output);
  EXPECT_EQ(status["done"], status["frames"]);
  EXPECT_EQ(run({"audit", "k", "--blender", kFakeBlender, "--frames", "3"}).exit_code, 0);
}

TEST_F(KeepTest, ALineThatIsCutIsNone) {
  {
    Stream stream(folder_, keeping("k", 1));
    stream.hear();
    ask(stream, 0, 1);
    stream.close_input();
    EXPECT_EQ(stream.wait(), 0);
  }
  const std::string lines = *read_file(folder_ / "k/graphs.jsonl");
  write("k/graphs.jsonl", lines + R"({"@sce)");  // killed while it wrote
  EXPECT_EQ(resume("k").exit_code, 0);
  write("k/graphs.jsonl", lines + "{\"@scene\":9}\n{\"@sce");  // and before the frame had a row
  const Outcome resumed = resume("k");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_EQ(Json::parse(run({"status", "k", "--json"}).output)["done"], 3);
  Stream stream(folder_, keeping("k", 1));
  stream.hear();
  EXPECT_EQ(ask(stream, 9, 9)[9]["kept"], 2);
  EXPECT_EQ(ask(stream, 10, 10)[10]["kept"], 3);
  EXPECT_THAT(*read_file(folder_ / "k/graphs.jsonl"),
              HasSubstr("{\"@scene\":9}\n{\"@scene\":10}\n"));
}

TEST_F(KeepTest, SeveralClientsKeepInOneFolder) {
  write("ask.py", R"(import json, socket, sys, time
clients = []
for _ in range(400):
    try:
        while len(clients) < 3:
            client = socket.socket(socket.AF_UNIX)
            client.connect("s")
            clients.append(client.makefile("rw"))
        break
    except OSError:
        time.sleep(0.05)
for client in clients:
    client.readline()
    for k in range(5):
        client.write(json.dumps({"id": k, "fidelity": "render", "scene": k + 4 * clients.index(client)}) + "\n")
    client.flush()
print(sorted({json.loads(client.readline())["kept"] for client in clients for _ in range(5)}))
)");
  std::vector<std::string> arguments = keeping("k");
  arguments.insert(arguments.end(), {"--socket", "s"});
  Stream stream(folder_, arguments);
  const std::string command =
      "cd '" + folder_.string() + "' && /usr/bin/python3 ask.py > asked.txt";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(*read_file(folder_ / "asked.txt"), "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]\n");
  ::kill(stream.process(), SIGTERM);
  EXPECT_EQ(stream.wait(), 0);
  EXPECT_EQ(Json::parse(run({"status", "k", "--json"}).output)["done"], 13);
}

}  // namespace
}  // namespace seedframe
