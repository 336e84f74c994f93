// seedframe serve: the pages of campaigns, live.

#include <atomic>
#include <csignal>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/say.h"
#include "live/gate.h"
#include "live/http_server.h"
#include "live/live_site.h"

namespace seedframe {
namespace {

struct ServeArguments {
  std::vector<std::string> folders;
  int port = 0;
  std::string blender;
};

/// SIGINT and SIGTERM, for a thread that waits for them. To be made before any other thread.
sigset_t blocked_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

int serve(const ServeArguments& arguments) {
  const sigset_t signals = blocked_signals();
  Result<HttpServer> server = HttpServer::bind(arguments.port);
  if (!server) return report(server.error());
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return report("cannot find the program itself: " + error.message(), kExitEnvironment);
  std::vector<std::string> options;
  if (!arguments.blender.empty()) options = {"--blender", arguments.blender};
  ProcessControl control(program, options);
  const Gate gate(Gate::random_token(), server->port());
  std::vector<std::filesystem::path> folders(arguments.folders.begin(), arguments.folders.end());
  const auto site = LiveSite::open(folders, seedframe_home(), gate, control,
                                   [] { return std::chrono::steady_clock::now(); });
  if (!site) return report(site.error());
  say("{}\nOpen it in a browser on this machine. Ctrl-C ends the server, not the campaigns.\n",
      gate.address());
  std::fflush(stdout);
  std::thread stopper([&signals, &server] {
    int signal = 0;
    sigwait(&signals, &signal);
    server->stop();
  });
  server->serve([&site](const HttpRequest& request) { return (*site)->answer(request); });
  ::kill(::getpid(), SIGTERM);  // where it ended by itself, the thread still waits
  stopper.join();
  return kExitOk;
}

}  // namespace

void add_serve_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<ServeArguments>();
  CLI::App* verb = app.add_subcommand(
      "serve",
      "the reports of campaigns as they grow, in a browser on this machine: progress, workers, "
      "newest frames, pause, resume, retry");
  verb->add_option("DIR", arguments->folders, "folders of campaigns")->required();
  verb->add_option("--port", arguments->port, "port of 127.0.0.1 (default: any that is free)")
      ->check(CLI::Range(0, 65'535));
  verb->add_option("--blender", arguments->blender,
                   "with which runs are resumed (default: as resume)");
  verb->footer("Example: seedframe serve results/parts");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return serve(*arguments); }); });
}

}  // namespace seedframe
