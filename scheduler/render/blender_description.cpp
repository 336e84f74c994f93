#include "render/blender_description.h"

#include <chrono>

#include <fmt/format.h>

#include "base/canonical_json.h"
#include "render/child_process.h"
#include "render/worker_conditions.h"

namespace seedframe {

Result<BlenderDescription> parse_blender_description(const std::string& output) {
  // Blender and its libraries print lines of their own.
  constexpr std::string_view kWord = "DESCRIPTION ";
  const std::size_t begin = output.starts_with(kWord) ? 0 : output.find(fmt::format("\n{}", kWord));
  if (begin == std::string::npos) {
    return fail(ErrorKind::kEnvironment, "expected a description of Blender, got \"{}\"",
                output.substr(0, 200));
  }
  const std::size_t json_begin = output.find('{', begin);
  const std::string line = output.substr(json_begin, output.find('\n', json_begin) - json_begin);
  try {
    const Json json = Json::parse(line);
    BlenderDescription found;
    json.at("devices").get_to(found.devices);
    json.at("denoisers").get_to(found.denoisers);
    json.at("kernel").get_to(found.kernel);
    json.at("embree").get_to(found.embree);
    return found;
  } catch (const Json::exception& exception) {
    return fail(ErrorKind::kEnvironment, "expected a description of Blender, got \"{}\": {}",
                line.substr(0, 200), exception.what());
  }
}

Result<BlenderDescription> describe_blender(const BlenderProgram& blender,
                                            const std::filesystem::path& scripts,
                                            const std::filesystem::path& preload) {
  constexpr auto kLongest = std::chrono::seconds(60);  // a cold disk is slow
  const auto changes = environment_of({}, preload);
  const Result<std::string> output =
      output_of(blender_command(blender, scripts, 1, scripts / "describe_blender.py"), kLongest,
                {changes.begin(), changes.end()});
  if (!output) return forward_error(output);
  return parse_blender_description(*output);
}

}  // namespace seedframe
