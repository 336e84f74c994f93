#include "render/message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/canonical_json.h"

namespace seedframe {
namespace {

using testing::HasSubstr;

TEST(Message, ARenderRequestIsOneLineOfJson) {
  RenderRequest request;
  request.spec = R"({"version":1})";
  request.frame_id = "f00";
  request.output = "/out/a \"quoted\"\nname.exr";
  request.meshes["abc"] = "/meshes/abc.mesh";
  request.textures["def"] = "/textures/def.png";
  const std::string line = encode_render_message({42, 2}, request);
  ASSERT_EQ(line.find('\n'), line.size() - 1);
  const Json json = Json::parse(line);
  EXPECT_EQ(json, (Json{{"type", "render"},
                        {"frame", 42},
                        {"attempt", 2},
                        {"frame_id", "f00"},
                        {"spec", {{"version", 1}}},
                        {"output", "/out/a \"quoted\"\nname.exr"},
                        {"meshes", {{"abc", "/meshes/abc.mesh"}}},
                        {"textures", {{"def", "/textures/def.png"}}}}));
}

TEST(Message, AsksForSampleCountsOnlyWhereTheyAreWanted) {
  RenderRequest request;
  request.spec = "{}";
  EXPECT_FALSE(Json::parse(encode_render_message({0, 1}, request)).contains("sample_counts"));
  EXPECT_FALSE(Json::parse(encode_render_message({0, 1}, request)).contains("save_scene"));
  request.save_scene = true;
  EXPECT_EQ(Json::parse(encode_render_message({0, 1}, request))["save_scene"], true);
  request.sample_counts = true;
  EXPECT_EQ(Json::parse(encode_render_message({0, 1}, request))["sample_counts"], true);
}

TEST(Message, EmptyTablesAreObjects) {
  const Json json = Json::parse(encode_render_message({0, 1}, {"{}", "id", "/x", {}, {}}));
  EXPECT_TRUE(json["meshes"].is_object());
  EXPECT_TRUE(json["textures"].is_object());
}

TEST(Message, ReadsReady) {
  const auto message = parse_worker_message(
      R"({"type":"ready","protocol":1,"blender":"3.4.1","build":"b","ocio_config":"/c","kernel":"avx2","embree":"avx512","reciprocals":"0123","libc":"glibc 2.36","device":"cpu","devices":"CPU","denoisers":"OpenImageDenoise"})");
  ASSERT_TRUE(message);
  const auto& ready = std::get<ReadyMessage>(*message);
  EXPECT_EQ(ready.protocol, 1);
  EXPECT_EQ(ready.blender, "3.4.1");
  EXPECT_EQ(ready.build, "b");
  EXPECT_EQ(ready.ocio_config, "/c");
  EXPECT_EQ(ready.kernel, "avx2");
  EXPECT_EQ(ready.embree, "avx512");
  EXPECT_EQ(ready.reciprocals, "0123");
  EXPECT_EQ(ready.libc, "glibc 2.36");
  EXPECT_EQ(ready.device, "cpu");
  EXPECT_EQ(ready.devices, "CPU");
  EXPECT_EQ(ready.denoisers, "OpenImageDenoise");
}

TEST(Message, ReadsDone) {
  const auto message = parse_worker_message(
      R"({"type":"done","frame":42,"attempt":2,"build_s":0.5,"render_s":1,"cpu_s":1.75})");
  ASSERT_TRUE(message);
  const auto& done = std::get<DoneMessage>(*message);
  EXPECT_EQ(done.job, (FrameJob{42, 2}));
  EXPECT_EQ(done.build_s, 0.5);
  EXPECT_EQ(done.render_s, 1.0);
  EXPECT_EQ(done.cpu_s, 1.75);
}

TEST(Message, ReadsSignsOfLife) {
  const auto message = parse_worker_message(R"({"type":"alive","memory_bytes":123})");
  ASSERT_TRUE(message);
  EXPECT_EQ(std::get<AliveMessage>(*message).memory_bytes, 123);
}

TEST(Message, ReadsFailed) {
  const auto message =
      parse_worker_message(R"({"type":"failed","frame":1,"attempt":1,"error":"no"})");
  ASSERT_TRUE(message);
  EXPECT_EQ(std::get<FailedMessage>(*message).error, "no");
}

TEST(Message, AnythingElseIsAnErrorThatQuotesIt) {
  for (const char* line :
       {"", "Fra:1 Mem:22M", "{", "[]", "1", "null", "{}", R"({"type":"render"})",
        R"({"type":"done","frame":42})", R"({"type":"done","frame":"x","attempt":1})",
        R"({"type":"ready","protocol":"1"})", R"({"type":"failed","frame":1,"attempt":1})",
        R"({"type":"done","frame":1,"attempt":4294967297,"build_s":0,"render_s":0,"cpu_s":0})",
        R"({"type":"done","frame":1e300,"attempt":1,"build_s":0,"render_s":0,"cpu_s":0})",
        R"({"type":"done","frame":1,"attempt":true,"build_s":0,"render_s":0,"cpu_s":0})",
        "\xff\xfe\x00garbage"}) {
    const auto message = parse_worker_message(line);
    ASSERT_FALSE(message) << line;
    EXPECT_EQ(message.error().kind, ErrorKind::kRender);
    EXPECT_THAT(message.error().message, HasSubstr("worker protocol"));
  }
  EXPECT_THAT(parse_worker_message("Fra:1 Mem:22M").error().message, HasSubstr("Fra:1 Mem:22M"));
}

TEST(Message, ALongLineIsQuotedInPart) {
  EXPECT_LT(parse_worker_message(std::string(100'000, 'x')).error().message.size(), 600u);
}

}  // namespace
}  // namespace seedframe
