// seedframe audit: would this campaign come out as it did?

#include "audit/audit.h"

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>

#include "audit/audit_report.h"
#include "audit/file_check.h"
#include "base/cores.h"
#include "base/files.h"
#include "base/message_text.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/blender_option.h"
#include "console/executor_options.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/progress.h"
#include "console/run_options.h"
#include "console/say.h"
#include "console/tolerance_options.h"
#include "export/campaign_dataset.h"
#include "export/kept_inputs.h"
#include "formats/formats.h"
#include "manual/describe_command.h"
#include "slurm/cluster_state.h"
#include "slurm/slurm_factory.h"

namespace seedframe {
namespace {

struct AuditArguments {
  std::string folder;
  std::string output;
  std::string vary;
  std::vector<std::string> allowed;
  AuditOptions options;
  RunOptions run;
  ExecutorOptions executor;
  bool json = false;
};

Result<Conditions> conditions_to_vary(const AuditArguments& arguments,
                                      const PreparedCampaign& prepared) {
  if (!arguments.vary.empty()) return parse_conditions(arguments.vary);
  return promised_conditions(prepared.settings.determinism.mode);
}

/// Files and exports that are not as they were written outweigh how a frame comes out today.
ExitCode exit_code_of(const Audit& audit, const std::vector<AuditedExport>& exports) {
  const bool whole = audit.files.problems.empty() && audit.files.of_no_frame.empty() &&
                     std::all_of(exports.begin(), exports.end(),
                                 [](const AuditedExport& each) { return each.is_whole(); });
  return whole ? exit_code(audit.grade()) : kExitCorrupt;
}

Status render(Auditor& auditor, bool quiet) {
  {
    Progress progress(auditor.renderings(), 0, quiet || auditor.renderings() == 0);
    if (Status rendered = auditor.render(progress); !rendered) return rendered;
  }
  const std::int64_t unexplained = auditor.unexplained();
  if (unexplained > 0 && !quiet) {
    std::fprintf(stderr, "%lld frames differ: looking for the causes\n",
                 static_cast<long long>(unexplained));
  }
  Progress silent(0, 0, /*quiet=*/true);
  return auditor.explain(silent);
}

bool renders(const AuditOptions& options) {
  return options.sample.frames > 0 || options.sample.share > 0.0 || !options.sample.only.empty();
}

/// The report, and what is said of it; returns the exit code.
int tell(const Campaign& campaign, KeptInputs inputs, const Audit& result,
         const AuditArguments& arguments) {
  const auto dataset = campaign_dataset(campaign, std::move(inputs));
  if (!dataset) return report(dataset.error());
  const std::vector<AuditedExport> exports =
      check_exports(dataset->dataset, export_formats(), campaign.files.exports(), core_count());
  const std::filesystem::path& folder = arguments.options.folder;
  const std::string title = campaign.files.root().filename().string();
  if (Status written = write_audit_report(folder, title, result, exports); !written) {
    return report(written.error());
  }
  if (arguments.json) {
    fmt::print("{}", readable_json(to_json(result, exports)));
  } else {
    say("{}{} has the report\n", audit_summary(result, exports), folder.string());
  }
  return exit_code_of(result, exports);
}

/// Of the files alone, where the config, or what it needs, is not to be had.
int audit_alone(const Campaign& campaign, const Error& why, const AuditArguments& arguments) {
  Result<std::optional<KeptInputs>> kept = read_kept_inputs(campaign.files);
  if (!kept) return report(kept.error());
  if (why.kind != ErrorKind::kInput || !*kept) return report(why);
  if (renders(arguments.options)) {
    return report({why.kind, why.message +
                                 "\nTo render frames again, that is needed; '--frames 0' reads the "
                                 "campaign's files without it"});
  }
  if (Status taken = take_audit_folder(arguments.options.folder); !taken) {
    return report(taken.error());
  }
  Audit result;
  Result<FileCheck> files = check_files(campaign, {(*kept)->categories, nullptr});
  if (!files) return report(files.error());
  result.files = std::move(*files);
  result.why_alone = why.message;
  return tell(campaign, std::move(**kept), result, arguments);
}

/// Where --vary node renders: on the cluster that the campaign's last run was on, unless told
/// otherwise.
Result<OnOtherNodes> other_nodes(const Campaign& campaign, const ExecutorOptions& said) {
  const auto slurm = choose_executor(said, &campaign.store);
  if (!slurm) return forward_error(slurm);
  if (!*slurm) {
    return fail(ErrorKind::kInput,
                "--vary node renders frames again on other nodes of a Slurm cluster: give "
                "--executor slurm");
  }
  return OnOtherNodes([&campaign, options = **slurm](const std::vector<std::int64_t>& frames,
                                                     const RunOptions& run) -> Result<MakeRun> {
    auto makers = nodes_of(campaign, frames);
    if (!makers) return forward_error(makers);
    SlurmOptions others = options;
    others.avoid = std::move(*makers);
    RunOptions tasks = run;
    tasks.blender = run.worker.blender.path.empty() ? run.blender : run.worker.blender.name();
    return runs_by_slurm(others, tasks);
  });
}

int audit(AuditArguments& arguments) {
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  AuditOptions& options = arguments.options;
  options.folder = arguments.output.empty() ? campaign->files.root() / "audit"
                                            : std::filesystem::path(arguments.output);
  Result<PreparedCampaign> prepared = prepare_again(*campaign, seedframe_home(), arguments.allowed);
  if (!prepared) return audit_alone(*campaign, prepared.error(), arguments);
  const Result<Conditions> vary = conditions_to_vary(arguments, *prepared);
  if (!vary) return report(vary.error());
  options.vary = *vary;
  Result<RunSetup> setup = RunSetup{};
  if (renders(options)) {
    setup = set_up_run(arguments.run, prepared->settings, prepared->expander.frame_count());
    if (!setup) return report(setup.error());
    print_notes(*setup);
  }
  if (options.vary.contains(Condition::kNode)) {
    Result<OnOtherNodes> others = other_nodes(*campaign, arguments.executor);
    if (!others) return report(others.error());
    options.on_other_nodes = std::move(*others);
  }
  if (Status taken = take_audit_folder(options.folder); !taken) return report(taken.error());
  Auditor auditor(*campaign, *prepared, *setup, options);
  if (Status looked = auditor.look(); !looked) return report(looked.error());
  if (Status rendered = render(auditor, arguments.run.quiet); !rendered) {
    return report(rendered.error());
  }
  Result<KeptInputs> inputs = inputs_of(*prepared);
  if (!inputs) return report(inputs.error());
  return tell(*campaign, std::move(*inputs), auditor.result(), arguments);
}

std::vector<std::string> condition_words() {
  std::vector<std::string> words = {"all", "none", to_string(Condition::kIsa),
                                    to_string(Condition::kNode)};
  for (const Condition condition : usual_conditions()) words.emplace_back(to_string(condition));
  return words;
}

}  // namespace

void add_audit_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<AuditArguments>();
  AuditOptions& options = arguments->options;
  CLI::App* verb = app.add_subcommand("audit",
                                      "would this campaign come out as it did? Reads all its "
                                      "files, renders a sample again in other "
                                      "conditions, and finds the cause of what differs");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  verb->add_option("--frames", options.sample.frames,
                   "how many frames to render again; 0: only read files")
      ->check(NotNegative())
      ->capture_default_str();
  verb->add_option("--share", options.sample.share, "or which share of the frames, 0 to 1")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--frame", options.sample.only, "render just this frame again")
      ->allow_extra_args(false)
      ->check(NotNegative());
  verb->add_option("--sample-seed", options.sample.seed, "another one draws other frames")
      ->capture_default_str();
  verb->add_option(
          "--vary", arguments->vary,
          "conditions: threads, workers, order, fresh-worker, history, tmpdir, locale, "
          "timezone, isa, node (of a Slurm cluster); all (but node) or none (default: all that "
          "the campaign's mode covers)")
      ->check(offers(condition_words()));
  verb->add_option("--causes", options.most_causes,
                   "most frames whose cause is looked for by more renderings")
      ->check(NotNegative())
      ->capture_default_str();
  verb->add_option("-o,--output", arguments->output,
                   "folder for the report (default: audit/ in the campaign's)")
      ->type_name("DIR");
  add_tolerance_options(*verb, options.tolerance);
  add_blender_option(*verb, arguments->run.blender);
  add_executor_options(*verb, arguments->executor);
  add_allow_option(*verb, arguments->allowed);
  verb->add_flag("--quiet", arguments->run.quiet, "no progress");
  verb->add_flag("--json", arguments->json, "print report.json instead of a summary");
  verb->footer("Example: seedframe audit results/parts --frames 20");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return audit(*arguments); }); });
}

}  // namespace seedframe
