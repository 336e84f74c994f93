#include "render/message.h"

#include <fmt/format.h>

#include "base/canonical_json.h"

namespace seedframe {
namespace {

Json path_table(const std::map<std::string, std::filesystem::path>& paths) {
  Json table = Json::object();
  for (const auto& [name, path] : paths) table[name] = path.string();
  return table;
}

// For error messages: the beginning of what came, as printable ASCII.
std::string quote(std::string_view line) {
  constexpr std::size_t kLongest = 120;
  std::string text;
  for (const char c : line.substr(0, kLongest)) text += (c >= ' ' && c < 127) ? c : '?';
  return line.size() > kLongest ? text + "…" : text;
}

tl::unexpected<Error> not_a_message(std::string_view line, const std::string& why) {
  return fail(ErrorKind::kRender, "expected a message of the worker protocol, got \"{}\" ({})",
              quote(line), why);
}

WorkerMessage read_message(const Json& json) {
  const auto type = json.at("type").get<std::string>();
  if (type == "ready") {
    return ReadyMessage{
        integer_of<int>(json.at("protocol")),      json.at("blender").get<std::string>(),
        json.at("build").get<std::string>(),       json.at("ocio_config").get<std::string>(),
        json.at("kernel").get<std::string>(),      json.at("embree").get<std::string>(),
        json.at("reciprocals").get<std::string>(), json.at("libc").get<std::string>(),
        json.at("device").get<std::string>(),      json.at("devices").get<std::string>(),
        json.at("denoisers").get<std::string>()};
  }
  if (type == "alive") return AliveMessage{integer_of<std::int64_t>(json.at("memory_bytes"))};
  const FrameJob job = {integer_of<std::int64_t>(json.at("frame")),
                        integer_of<int>(json.at("attempt"))};
  if (type == "done") {
    return DoneMessage{job, json.at("build_s").get<double>(), json.at("render_s").get<double>(),
                       json.at("cpu_s").get<double>()};
  }
  if (type == "failed") return FailedMessage{job, json.at("error").get<std::string>()};
  throw Json::other_error::create(501, "unknown type '" + type + "'", nullptr);
}

}  // namespace

std::filesystem::path saved_scene(const std::filesystem::path& output) {
  return output.string() + ".blend";
}

std::string encode_render_message(const FrameJob& job, const RenderRequest& request) {
  // The spec is JSON already; reading it again would cost more than sending it.
  const auto replace = Json::error_handler_t::replace;
  return fmt::format(
      R"({{"type":"render","frame":{},"attempt":{},"frame_id":{},"output":{},"meshes":{},"textures":{}{}{},"spec":{}}})"
      "\n",
      job.frame, job.attempt, Json(request.frame_id).dump(),
      Json(request.output.string()).dump(-1, ' ', false, replace),
      path_table(request.meshes).dump(-1, ' ', false, replace),
      path_table(request.textures).dump(-1, ' ', false, replace),
      request.sample_counts ? R"(,"sample_counts":true)" : "",
      request.save_scene ? R"(,"save_scene":true)" : "", request.spec);
}

Result<WorkerMessage> parse_worker_message(std::string_view line) {
  try {
    return read_message(Json::parse(line));
  } catch (const Json::exception& error) {
    return not_a_message(line, error.what());
  }
}

}  // namespace seedframe
