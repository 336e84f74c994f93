// seedframe stream as a client sees it: lines in, lines out.

#include <set>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "tests/cli/program.h"
#include "tests/cli/stream_program.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kConfig = R"(seedframe: 1
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

class StreamTest : public ProgramTest {
 protected:
  void SetUp() override { write_config("line.yaml", kConfig); }

  const std::vector<std::string> fake_ = {"--blender", kFakeBlender, "--workers", "2"};
};

TEST_F(StreamTest, AnswersWithLabels) {
  Stream stream(folder_, {});
  const Json ready = stream.hear();
  EXPECT_EQ(ready["ready"]["width"], 24);
  const Json turn = ready["ready"]["variables"]["turn"];
  EXPECT_EQ(turn["type"], "number");
  EXPECT_EQ(turn["unit"], "deg");
  EXPECT_EQ(turn["per_copy"], false);
  EXPECT_EQ(turn["range"], Json({0, 90}));
  EXPECT_EQ(turn["distribution"]["kind"], "uniform");
  EXPECT_EQ(turn["distribution"]["level"], "scene");
  stream.say(R"({"id": "a", "values": {"turn": 45}})");
  const Json answer = stream.hear();
  EXPECT_EQ(answer["id"], "a");
  EXPECT_EQ(answer["labels"]["instances"][0]["asset"], "gear");
  EXPECT_EQ(answer["frame_id"].get<std::string>().size(), 64U);
  EXPECT_FALSE(answer.contains("arrays"));
  stream.close_input();
  EXPECT_TRUE(stream.hear().is_null());
  EXPECT_EQ(stream.wait(), 0);
}

TEST_F(StreamTest, IsTheSameAsACampaignOfTheseValues) {
  const std::vector<std::string> values = {R"({"turn": 10, "height": 0.3})", R"({"turn": 80})",
                                           "{}"};
  write("g.jsonl", values[0] + "\n" + values[1] + "\n" + values[2] + "\n");
  for (const bool rendered : {false, true}) {
    std::vector<std::string> submit = {"submit",         "line.yaml",  "--set",
                                       "graphs=g.jsonl", "-o",         rendered ? "r" : "l",
                                       "--blender",      kFakeBlender, "--quiet"};
    std::vector<std::string> more = fake_;
    if (!rendered) {
      submit.insert(submit.end(), {"--set", "labels=geometry"});
      more.insert(more.end(), {"--set", "labels=geometry"});
    }
    const Outcome campaign = run(submit);
    ASSERT_EQ(campaign.exit_code, 0) << campaign.errors;
    Stream stream(folder_, more);
    stream.hear();
    for (std::size_t i = 0; i < values.size(); ++i) {
      stream.say(R"({"id": )" + std::to_string(i) + R"(, "scene": )" + std::to_string(i) +
                 R"(, "values": )" + values[i] + R"(, "fidelity": ")" +
                 (rendered ? "render" : "labels") + R"("})");
    }
    std::set<int> seen;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Json answer = stream.hear();
      ASSERT_TRUE(answer.contains("frame_id")) << answer;
      const int frame = answer["id"].get<int>();
      seen.insert(frame);
      const fs::path folder =
          folder_ / (rendered ? "r" : "l") / "frames/000" / ("00000" + std::to_string(frame));
      const Json manifest = Json::parse(*read_file(folder / "manifest.json"));
      EXPECT_EQ(answer["frame_id"], manifest["frame_id"]);
      EXPECT_EQ(answer["pixel_hashes"], manifest["pixels"]);
      EXPECT_EQ(answer["labels"], Json::parse(*read_file(folder / "labels.json")));
    }
    EXPECT_EQ(seen.size(), values.size());
  }
}

TEST_F(StreamTest, HandsOverArraysThatLeaveNothingBehind) {
  Stream stream(folder_, fake_);
  stream.hear();
  stream.say(R"({"id": 1, "fidelity": "preview", "want": ["image", "ids", "depth"]})");
  Json answer = stream.hear();
  ASSERT_TRUE(answer.contains("arrays")) << answer;
  EXPECT_FALSE(answer.contains("labels"));
  const Json& arrays = answer["arrays"];
  EXPECT_EQ(arrays["image"]["shape"], Json({16, 24, 3}));
  EXPECT_EQ(arrays["ids"]["shape"], Json({16, 24}));
  EXPECT_EQ(arrays["depth"]["dtype"], "float32");
  const int file = ::open(arrays["path"].get<std::string>().c_str(), O_RDONLY);
  ASSERT_GE(file, 0);
  const auto bytes = arrays["bytes"].get<std::size_t>();
  stream.say(R"({"release": 1})");
  void* memory = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file, 0);
  ASSERT_NE(memory, MAP_FAILED);
  const auto* ids = reinterpret_cast<const std::uint16_t*>(
      static_cast<const char*>(memory) + arrays["ids"]["offset"].get<std::size_t>());
  EXPECT_GT(std::count(ids, ids + 24 * 16, 1), 0) << "the gear is seen";
  // The same id may be used again.
  stream.say(R"({"id": 1, "fidelity": "render", "want": ["image"]})");
  answer = stream.hear();
  ASSERT_TRUE(answer.contains("arrays")) << answer;
  EXPECT_EQ(answer["arrays"]["image"]["shape"], Json({16, 24, 3}));
  ::kill(stream.process(), SIGKILL);
  stream.wait();
  EXPECT_GT(std::count(ids, ids + 24 * 16, 1), 0) << "what was mapped stays";
  ::munmap(memory, bytes);
  ::close(file);
}

TEST_F(StreamTest, NoLineEndsIt) {
  Stream stream(folder_, fake_);
  stream.hear();
  const std::vector<std::pair<const char*, const char*>> lines = {
      {"garbage", "a request"},
      {"[1]", "a request is a JSON object"},
      {"{}", "needs an id"},
      {R"({"id": 1, "valeus": {}})", "did you mean 'values'?"},
      {R"({"id": 1, "values": {"trun": 1}})", "did you mean 'turn'?"},
      {R"({"id": 1, "values": {"turn": "a lot"}})", "expected a number"},
      {R"({"id": 1, "values": 3})", "expected an object"},
      {R"({"id": 1, "fidelity": "best"})", "expected labels, preview or render"},
      {R"({"id": 1, "want": ["image"]})", "labels has no image"},
      {R"({"id": 1, "samples": 4})", "only fidelity render"},
      {R"({"id": 1, "fidelity": "render", "samples": 0})", "from 1 to 65536"},
      {R"({"id": 1, "fidelity": "render", "crop": [0, 0, 25, 1]})",
       "reaches beyond the image of 24"},
      {R"({"id": 1, "scene": -1})", "scene"},
      {R"({"id": 1, "deadline_s": 0})", "deadline_s"},
      {R"({"id": {}, "values": {}})", "a text or a whole number"},
      {R"({"cancel": 7, "id": 1})", "nothing else in the line"},
      {R"({"id": 1, "values": {"height": 1e999}})", ""},
  };
  for (const auto& [line, message] : lines) {
    stream.say(line);
    const Json answer = stream.hear();
    ASSERT_TRUE(answer.contains("error")) << line << answer;
    EXPECT_EQ(answer["error"]["kind"], "input") << line;
    EXPECT_THAT(answer["error"]["message"].get<std::string>(), HasSubstr(message)) << line;
  }
  stream.say("");
  stream.say(R"({"cancel": "nobody's"})");
  stream.say(R"({"release": "nobody's"})");
  stream.say(R"({"id": 2})");
  EXPECT_EQ(stream.hear()["id"], 2);
}

TEST_F(StreamTest, ALineThatIsCutOffIsAnsweredAtTheEnd) {
  Stream stream(folder_, {});
  stream.hear();
  stream.say(R"({"id": 1})");
  EXPECT_EQ(stream.hear()["id"], 1);
  stream.say(R"({"id": 2, "val)", "");
  stream.close_input();
  EXPECT_TRUE(stream.hear().contains("error"));
  EXPECT_TRUE(stream.hear().is_null());
  EXPECT_EQ(stream.wait(), 0);
}

TEST_F(StreamTest, WhatCrashesIsTriedAgainOrToldWithoutHarmToOthers) {
  Stream stream(
      folder_, fake_,
      R"({"crash_frames": [2], "crash_attempts": 1, "exit_frames": [3], "exit_attempts": 99})");
  stream.hear();
  for (int i = 1; i <= 5; ++i) {
    stream.say(R"({"id": )" + std::to_string(i) + R"(, "fidelity": "render", "scene": )" +
               std::to_string(i) + "}");
  }
  int good = 0;
  int bad = 0;
  for (int i = 1; i <= 5; ++i) {
    const Json answer = stream.hear();
    ASSERT_FALSE(answer.is_null());
    const bool failed = answer.contains("error");
    ++(failed ? bad : good);
    EXPECT_EQ(failed ? answer["error"]["kind"] : Json("render"), "render");
  }
  EXPECT_EQ(good, 4);
  EXPECT_EQ(bad, 1);
  stream.close_input();
  EXPECT_EQ(stream.wait(), 0);
}

TEST_F(StreamTest, CancelsAndKeepsDeadlines) {
  Stream stream(folder_, {"--blender", kFakeBlender, "--workers", "1"}, R"({"delay_s": 0.3})");
  stream.hear();
  for (int i = 0; i < 4; ++i) {
    stream.say(R"({"id": )" + std::to_string(i) + R"(, "fidelity": "render")" +
               (i == 2 ? R"(, "deadline_s": 0.1})" : "}"));
  }
  stream.say(R"({"cancel": 3})");
  std::map<int, Json> answers;
  for (int i = 0; i < 4; ++i) {
    const Json answer = stream.hear();
    answers[answer["id"].get<int>()] = answer;
  }
  EXPECT_TRUE(answers[0].contains("frame_id"));
  EXPECT_TRUE(answers[1].contains("frame_id"));
  EXPECT_THAT(answers[2]["error"]["message"].get<std::string>(), HasSubstr("deadline"));
  EXPECT_EQ(answers[3]["error"]["message"], "cancelled");
}

TEST_F(StreamTest, AFloodIsReadNoFasterThanItIsAnswered) {
  Stream stream(folder_, {"--most-open", "3", "--blender", kFakeBlender, "--workers", "1"},
                R"({"delay_s": 0.02})");
  stream.hear();
  std::jthread flood([&] {
    for (int i = 0; i < 60; ++i) {
      stream.say(R"({"id": )" + std::to_string(i) + R"(, "fidelity": "render"})");
    }
  });
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(stream.hear().contains("frame_id"));
}

TEST_F(StreamTest, WhoReleasesNothingGetsNoMoreArrays) {
  Stream stream(folder_, {});
  stream.hear();
  for (int i = 0; i < 256; ++i) {
    stream.say(R"({"id": )" + std::to_string(i) + R"(, "want": ["ids"]})");
    ASSERT_TRUE(stream.hear().contains("arrays"));
  }
  stream.say(R"({"id": 256, "want": ["ids"]})");
  EXPECT_THAT(stream.hear()["error"]["message"].get<std::string>(), HasSubstr("not released"));
  stream.say(R"({"id": 256})");
  EXPECT_TRUE(stream.hear().contains("labels"));
  stream.say(R"({"release": 17})");
  stream.say(R"({"id": 17, "want": ["ids"]})");
  EXPECT_TRUE(stream.hear().contains("arrays"));
}

TEST_F(StreamTest, AClientThatDiesEndsIt) {
  Stream stream(folder_, fake_, R"({"delay_s": 0.2})");
  stream.hear();
  stream.say(R"({"id": 1, "fidelity": "render"})");
  stream.close_output();
  stream.close_input();
  EXPECT_EQ(stream.wait(), 0);
}

TEST_F(StreamTest, TerminatedItAnswersWhatIsUnderWay) {
  Stream stream(folder_, {"--blender", kFakeBlender, "--workers", "1"}, R"({"delay_s": 0.3})");
  stream.hear();
  for (int i = 0; i < 3; ++i)
    stream.say(R"({"id": )" + std::to_string(i) + R"(, "fidelity": "render"})");
  EXPECT_TRUE(stream.hear().contains("frame_id"));
  ::kill(stream.process(), SIGTERM);
  for (int i = 1; i < 3; ++i) EXPECT_FALSE(stream.hear().is_null());
  EXPECT_TRUE(stream.hear().is_null());
  EXPECT_EQ(stream.wait(), 0);
}

TEST_F(StreamTest, SaysThatItLives) {
  Stream stream(folder_, {"--heartbeat", "0.05", "--blender", kFakeBlender, "--workers", "1"},
                R"({"delay_s": 0.5})");
  stream.hear();
  stream.say(R"({"id": 1, "fidelity": "render"})");
  EXPECT_TRUE(stream.hear().contains("frame_id"));
  EXPECT_GE(stream.signs_of_life, 2);
}

int connect_to(const fs::path& path) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  path.string().copy(address.sun_path, sizeof address.sun_path - 1);
  for (int i = 0; i < 2000; ++i) {
    const int client = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (::connect(client, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0)
      return client;
    ::close(client);
    ::usleep(5000);
  }
  return -1;
}

std::vector<Json> lines_of(int client, std::size_t count) {
  std::vector<Json> lines;
  std::string text;
  while (lines.size() < count) {
    char buffer[65536];
    const ssize_t bytes = ::read(client, buffer, sizeof buffer);
    if (bytes <= 0) break;
    text.append(buffer, static_cast<std::size_t>(bytes));
    for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1)) {
      lines.push_back(Json::parse(text.substr(0, end)));
    }
  }
  return lines;
}

TEST_F(StreamTest, TwoClientsOfASocketHaveIdsOfTheirOwn) {
  Stream stream(folder_, {"--socket", "s"});
  const int a = connect_to(folder_ / "s");
  const int b = connect_to(folder_ / "s");
  const int quits = connect_to(folder_ / "s");
  ASSERT_GE(quits, 0);
  const std::string asks = "{\"id\": 1, \"scene\": 1}\n";
  const std::string other = "{\"id\": 1, \"scene\": 2}\n";
  ASSERT_GT(::write(a, asks.data(), asks.size()), 0);
  ASSERT_GT(::write(quits, asks.data(), asks.size()), 0);
  ::close(quits);
  ASSERT_GT(::write(b, other.data(), other.size()), 0);
  const auto of_a = lines_of(a, 2);
  const auto of_b = lines_of(b, 2);
  ASSERT_EQ(of_a.size(), 2U);
  ASSERT_EQ(of_b.size(), 2U);
  EXPECT_TRUE(of_a[0].contains("ready"));
  EXPECT_NE(of_a[1]["frame_id"], of_b[1]["frame_id"]);
  ::close(a);
  const Outcome taken = run({"stream", "line.yaml", "--socket", "s"});
  EXPECT_EQ(taken.exit_code, 2);
  EXPECT_THAT(taken.errors, HasSubstr("another program listens there"));
  ::kill(stream.process(), SIGTERM);
  EXPECT_EQ(stream.wait(), 0);
  EXPECT_FALSE(exists("s"));
  ::close(b);
}

TEST_F(StreamTest, AMissingBlenderIsAnErrorOfRenderingsAlone) {
  Stream stream(folder_, {"--blender", "/nowhere/blender"});
  stream.hear();
  stream.say(R"({"id": 1, "fidelity": "render"})");
  const Json answer = stream.hear();
  EXPECT_EQ(answer["error"]["kind"], "environment");
  EXPECT_THAT(answer["error"]["message"].get<std::string>(), HasSubstr("/nowhere/blender"));
  stream.say(R"({"id": 2})");
  EXPECT_TRUE(stream.hear().contains("labels"));
}

TEST_F(StreamTest, CheckTellsTheVariables) {
  const Outcome outcome = run({"check", "line.yaml", "--describe"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const Json variables = Json::parse(outcome.output)["variables"];
  EXPECT_EQ(variables["height"]["unit"], "m");
  EXPECT_EQ(variables["height"]["range"], Json({0.2, 0.4}));
  EXPECT_GE(variables["height"]["value"].get<double>(), 0.2);
}

TEST_F(StreamTest, RefusesWhatItCannotDo) {
  EXPECT_EQ(run({"stream", "nowhere.yaml"}).exit_code, 2);
  const Outcome quality =
      run({"stream", "line.yaml", "--set", "quality={metric: rmse8, max_error: 4}"});
  EXPECT_EQ(quality.exit_code, 2);
  EXPECT_THAT(quality.errors, HasSubstr("--set quality=null"));
}

}  // namespace
}  // namespace seedframe
