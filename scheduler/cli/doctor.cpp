// seedframe doctor: is everything here that rendering needs?

#include <algorithm>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "assets/asset_library.h"
#include "base/canonical_json.h"
#include "base/sha256.h"
#include "campaign/color_config.h"
#include "campaign/provenance.h"
#include "cli/verb.h"
#include "console/blender_option.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/say.h"
#include "image/color_management.h"
#include "render/blender_description.h"
#include "render/blender_info.h"
#include "render/sandbox.h"
#include "scene/material_library.h"
#include "scene/prepared_campaign.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

/// What was found, in order, and whether any of it was bad.
class Findings {
 public:
  /// Prints each finding on a line of its own as it comes, unless all are wanted as JSON.
  explicit Findings(bool print) : print_(print) {}

  void good(const std::string& what, const std::string& text) { add(true, what, text); }
  void bad(const std::string& what, const std::string& text) { add(false, what, text); }
  bool any_bad() const { return any_bad_; }
  const Json& json() const { return json_; }

 private:
  void add(bool good, const std::string& what, const std::string& text) {
    if (print_) say("{:<5} {:<12} {}\n", good ? "ok" : "FAIL", what, text);
    json_.push_back({{"what", what}, {"good", good}, {"found", text}});
    any_bad_ = any_bad_ || !good;
  }

  bool print_;
  bool any_bad_ = false;
  Json json_ = Json::array();
};

void examine_abilities(const BlenderProgram& blender, Findings& findings) {
  const auto can =
      describe_blender(blender, seedframe_home() / "blender_scripts", worker_preload());
  if (!can) return findings.bad("renders", can.error().message);
  findings.good("renders",
                fmt::format("on {}; kernels: Cycles' {}, Embree's {}; denoisers: {}", can->devices,
                            can->kernel, can->embree.empty() ? "unknown" : can->embree,
                            can->denoisers.empty() ? "none" : can->denoisers));
}

void examine_blender(const std::string& program, Findings& findings) {
  const Result<BlenderInfo> blender = probe_blender(program);
  if (!blender) {
    findings.bad("Blender", blender.error().message);
    return;
  }
  findings.good("Blender", fmt::format("{} at {}{}", blender->version, blender->program.name(),
                                       blender->tested ? "" : " (not a version we test with)"));
  examine_abilities(blender->program, findings);
  const auto ocio = find_ocio_config(*blender);
  if (!ocio) {
    findings.bad("colour", ocio.error().message);
    return;
  }
  const Result<ColorManagement> color = ColorManagement::load(*ocio);
  if (color) {
    findings.good("colour", fmt::format("{} (SHA-256 {}…)", ocio->string(),
                                        color->config_hash().substr(0, 12)));
  } else {
    findings.bad("colour", color.error().message);
  }
}

/// What --blender can name: those that scripts/setup.sh has made.
std::vector<std::string> modules_of_checkout() {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(seedframe_home() / "venv", error)) {
    if (!entry.path().filename().string().starts_with("blender-")) continue;
    found.push_back("python:" + fs::canonical(entry.path(), error).string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

void examine_home(Findings& findings) {
  const Result<fs::path> found = find_home();
  if (!found) return findings.bad("home", found.error().message);
  const fs::path& home = *found;
  findings.good("home", home.string());
  std::error_code error;
  const fs::path preload = worker_preload();
  if (fs::exists(preload, error)) {
    findings.good("preload", preload.string());
  } else {
    findings.bad("preload", preload.string() + " is missing: it is installed with the program");
  }
  const auto assets = AssetLibrary::open({home / "assets"});
  std::size_t readable = 0;
  if (assets) {
    for (const std::string& name : assets->names()) {
      const auto asset = assets->load(name);
      if (!asset) findings.bad("assets", asset.error().message);
      readable += asset ? 1 : 0;
    }
    findings.good("assets", fmt::format("{} built in", readable));
  } else {
    findings.bad("assets", assets.error().message);
  }
  const auto materials = MaterialLibrary::open({home / "materials"}, {});
  if (materials) {
    const auto& all = materials->materials();
    const auto textured = std::count_if(
        all.begin(), all.end(), [](const auto& m) { return m.second.textures.has_value(); });
    findings.good("materials",
                  fmt::format("{} built in, {} of them with textures", all.size(), textured));
  } else {
    findings.bad("materials", materials.error().message);
  }
}

struct DoctorArguments {
  std::string blender;
  bool only_that = false;
  bool json = false;

  /// The one that was named, or all that there are: first the one that is used.
  std::vector<std::string> blenders() const {
    std::vector<std::string> all = {blender};
    if (only_that) return all;
    std::vector<std::string> others = modules_of_checkout();
    if (find_blender("blender")) others.emplace_back("blender");
    for (std::string& other : others) {
      if (other != blender) all.push_back(std::move(other));
    }
    return all;
  }
};

int examine(const DoctorArguments& arguments) {
  Findings findings(!arguments.json);
  findings.good("seedframe", SEEDFRAME_VERSION);
  for (const std::string& blender : arguments.blenders()) examine_blender(blender, findings);
  examine_home(findings);
  std::string libraries;
  const Json versions = library_versions();
  for (const auto& [name, version] : versions.items()) {
    libraries += (libraries.empty() ? "" : ", ") + name + " " + version.get<std::string>();
  }
  findings.good("libraries", libraries);
  findings.good("cores", std::to_string(std::thread::hardware_concurrency()));
  // Nothing needs it unless asked for.
  const Status sandbox = check_sandbox();
  findings.good("sandbox", sandbox ? "works (--sandbox)" : "not here: " + sandbox.error().message);
  std::error_code error;
  const fs::space_info space = fs::space(fs::current_path(), error);
  findings.good("disk", fmt::format("{} GB free here", space.available / 1'000'000'000));
  if (arguments.json) fmt::print("{}", readable_json(findings.json()));
  return findings.any_bad() ? kExitEnvironment : kExitOk;
}

}  // namespace

void add_doctor_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<DoctorArguments>();
  CLI::App* verb = app.add_subcommand("doctor", "what is installed, and whether it is enough");
  CLI::Option* blender = add_blender_option(*verb, arguments->blender);
  verb->add_flag("--json", arguments->json, "print it as JSON");
  verb->footer(
      "Without --blender it looks first at the one that is used then, and at the others after it:\n"
      "those that scripts/setup.sh has made, and the one in PATH.\n"
      "Example: seedframe doctor --blender /opt/blender/blender");
  verb->callback([arguments, blender, on_selected] {
    arguments->only_that = blender->count() > 0;
    on_selected([arguments] { return examine(*arguments); });
  });
}

}  // namespace seedframe
