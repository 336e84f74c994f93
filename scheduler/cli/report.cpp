// seedframe report: a campaign as a page.

#include <fstream>
#include <memory>
#include <string_view>

#include <CLI/CLI.hpp>

#include "base/cores.h"
#include "campaign/campaign.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/say.h"
#include "page/report_file.h"

namespace seedframe {
namespace {

struct ReportArguments {
  std::string folder;
  std::string output;
  std::vector<std::string> allowed;
};

void print_report(const WrittenReport& written, const std::filesystem::path& file) {
  constexpr double kMega = 1e6;
  say("{}: {} frames, {:.1f} MB\n", file.string(), written.frames,
      static_cast<double>(written.bytes) / kMega);
  if (!written.folder.empty()) {
    say("its pictures are in {}: keep the two together\n", written.folder.string());
  }
  if (written.shown < written.frames) {
    say("it shows {} of the frames, evenly spread\n", written.shown);
  }
  if (written.damaged > 0) {
    say("{} frames are not as they were written: 'seedframe audit' says which\n", written.damaged);
  }
  if (written.warnings > 0) {
    say("the dataset's health: {} warning{}, on its first page\n", written.warnings,
        written.warnings == 1 ? "" : "s");
  }
}

/// A file that is there is replaced only if it is a page.
Status check_replaceable(const std::filesystem::path& file) {
  constexpr std::string_view kBeginning = "<!doctype html>";
  std::ifstream stream(file, std::ios::binary);
  std::string beginning(kBeginning.size(), '\0');
  if (!stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()))) {
    beginning.resize(static_cast<std::size_t>(stream.gcount()));
  }
  if (beginning.empty() || beginning == kBeginning) return {};
  return fail(ErrorKind::kInput, "{} is there, and is no page: give another file with -o",
              file.string());
}

int make_report(const ReportArguments& arguments) {
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  const Result<PreparedCampaign> prepared =
      prepare_again(*campaign, seedframe_home(), arguments.allowed);
  if (!prepared) {
    say_aside(
        "seedframe: note: the config cannot be read here, so draws and constraints are left out:\n"
        "{}\n",
        prepared.error().message);
  }
  ReportWish wish;
  wish.page.threads = core_count();
  wish.file =
      arguments.output.empty() ? campaign->files.report() : std::filesystem::path(arguments.output);
  if (Status free = check_replaceable(wish.file); !free) return report(free.error());
  const Result<WrittenReport> written =
      write_report(*campaign, prepared ? &*prepared : nullptr,
                   prepared ? std::string() : prepared.error().message, wish);
  if (!written) return report(written.error());
  print_report(*written, wish.file);
  return kExitOk;
}

}  // namespace

void add_report_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* verb = app.add_subcommand(
      "report",
      "a page about a campaign, in one file: what is in the dataset, what is wrong with it, every "
      "frame with its labels");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  verb->add_option("-o,--output", arguments->output,
                   "the page (default: report.html in the campaign's folder)")
      ->type_name("FILE.html");
  add_allow_option(*verb, arguments->allowed);
  verb->footer("Example: seedframe report results/parts");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return make_report(*arguments); }); });
}

}  // namespace seedframe
