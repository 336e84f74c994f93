// seedframe stream: frames for values of variables, on demand.

#include <atomic>
#include <csignal>
#include <memory>

#include <CLI/CLI.hpp>

#include "base/cores.h"
#include "base/files.h"
#include "base/machine_folder.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/run_options.h"
#include "console/say.h"
#include "stream/frame_maker.h"
#include "stream/stream_server.h"

namespace seedframe {
namespace {

struct StreamArguments {
  std::string config;
  std::string keep;  ///< folder of the campaign that keeps what is rendered; empty: nothing is
  std::vector<std::string> set;
  std::vector<std::string> allowed;
  StreamOptions stream;
  RunOptions run;
};

std::atomic<StreamServer*> g_server = nullptr;

extern "C" void stop_stream(int) {
  if (StreamServer* server = g_server.load()) server->stop();
}

/// While this lives, SIGINT and SIGTERM stop the server.
class StopOnSignals {
 public:
  explicit StopOnSignals(StreamServer& server) {
    g_server = &server;
    struct sigaction action = {};
    action.sa_handler = stop_stream;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    ::signal(SIGPIPE, SIG_IGN);  // a client that is gone is seen when it is written to
  }
  ~StopOnSignals() { g_server = nullptr; }
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;
};

/// As a line of graphs is a scene with one frame, so is a request.
Result<PreparedCampaign> prepare_stream(const StreamArguments& arguments,
                                        const std::filesystem::path& folder) {
  Result<CampaignSource> source = read_source(arguments.config, arguments.set, seedframe_home(),
                                              with_own_assets(arguments.allowed));
  if (!source) return forward_error(source);
  source->graphs = folder / "graphs.jsonl";
  if (Status written = write_file_unsynced(source->graphs, "{}\n"); !written) {
    return forward_error(written);
  }
  Result<PreparedCampaign> prepared = prepare(std::move(*source));
  if (prepared && prepared->settings.quality) {
    return fail(ErrorKind::kInput,
                "{}: a section 'quality' is for campaigns, whose frames are calibrated before; "
                "take it out with --set quality=null",
                arguments.config);
  }
  if (prepared && prepared->settings.frames_per_scene != 1) {
    return fail(ErrorKind::kInput, "--set frames_per_scene: a scene of a stream has one frame");
  }
  return prepared;
}

Result<std::unique_ptr<FrameKeeper>> open_keeper(const StreamArguments& arguments,
                                                 const PreparedCampaign& prepared) {
  if (arguments.keep.empty()) return nullptr;
  auto keeper = FrameKeeper::open(arguments.keep, prepared);
  if (keeper && (*keeper)->pending_before() > 0) {
    say_aside(
        "seedframe: note: {0} frames of {1} are not made: 'seedframe resume {1}' makes them\n",
        (*keeper)->pending_before(), arguments.keep);
  }
  return keeper;
}

int stream(StreamArguments arguments) {
  const Result<MachineFolder> machine = MachineFolder::open({});
  if (!machine) return report(machine.error());
  const Result<MachineFolder::Own> own = machine->make_own();
  if (!own) return report(own.error());
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::absolute(own->folder(), ignored);
  if (Status made = make_folders(folder); !made) return report(made.error());
  const Result<PreparedCampaign> prepared = prepare_stream(arguments, folder);
  if (!prepared) return report(prepared.error());
  const Result<std::unique_ptr<FrameKeeper>> keeper = open_keeper(arguments, *prepared);
  if (!keeper) return report(keeper.error());
  if (*keeper) arguments.stream.kept = (*keeper)->frames_before();
  constexpr std::int64_t kAnyNumber = 1 << 20;
  const auto set_up = [&]() -> Result<RunSetup> {
    CampaignSettings settings = prepared->settings;
    settings.labels = LabelSource::kIndexPass;
    return set_up_run(arguments.run, settings, kAnyNumber);
  };
  const int threads = arguments.run.pool.workers > 0 ? arguments.run.pool.workers : core_count();
  StreamServer server(*prepared, arguments.stream);
  const StopOnSignals stop(server);
  FrameMaker maker(*prepared, threads, *keeper ? (*keeper)->files().workers() : folder, set_up,
                   keeper->get());
  if (Status ran = server.run(maker); !ran) return report(ran.error());
  return kExitOk;
}

}  // namespace

void add_stream_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<StreamArguments>();
  StreamOptions& options = arguments->stream;
  CLI::App* verb = app.add_subcommand(
      "stream",
      "make frames on demand: JSON lines of variables' values in, JSON lines with labels and "
      "pictures out (docs/formats/stream.md); nothing is stored, but what --keep names");
  verb->add_option("CONFIG", arguments->config, "campaign config (docs/config.md)")->required();
  verb->add_option("--set", arguments->set, "path=value: replaces a value of the config")
      ->allow_extra_args(false);
  add_allow_option(*verb, arguments->allowed);
  verb->add_option("--keep", arguments->keep,
                   "make the frames that are rendered a campaign in this folder, which is made, or "
                   "goes on if a stream of the same config has made it")
      ->type_name("DIR");
  const auto set_fidelity = [&options](const std::string& name) {
    for (const Fidelity each : {Fidelity::kLabels, Fidelity::kPreview, Fidelity::kRender}) {
      if (name == to_string(each)) options.fidelity = each;
    }
  };
  verb->add_option_function<std::string>(
          "--fidelity", set_fidelity,
          "of requests that do not say: labels (the twin: milliseconds), preview (the "
          "twin, shaded with textures and shadows, without reflections: tens of "
          "milliseconds), render (Cycles: tenths of a second and more)")
      ->check(CLI::IsMember({"labels", "preview", "render"}))
      ->default_str("labels");
  verb->add_option("--socket", options.socket,
                   "listen at this path for clients, this user's alone, instead of stdin")
      ->type_name("PATH");
  verb->add_option("--most-open", options.most_open,
                   "requests of a client that may wait for their answer; more are not read")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  verb->add_option("--heartbeat", options.heartbeat_s,
                   "seconds of silence after which a client is told that we live; 0: never")
      ->check(NotNegative())
      ->capture_default_str();
  add_run_options(*verb, arguments->run);
  verb->footer("Example: echo '{\"id\": 1, \"values\": {}}' | seedframe stream configs/parts.yaml");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return stream(*arguments); }); });
}

}  // namespace seedframe
