// seedframe verify-error: how far are the frames of a campaign from what they would be with endless
// samples?

#include <algorithm>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "campaign/campaign.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/run_options.h"
#include "console/say.h"
#include "console/temporary_folder.h"
#include "manual/describe_command.h"
#include "quality/error_check.h"
#include "quality/error_record.h"

namespace seedframe {
namespace {

struct VerifyErrorArguments {
  std::string folder;
  std::vector<std::int64_t> only;
  int frames = 12;
  std::uint64_t sample_seed = 0;
  int reference_samples = 1024;
  std::string measure = "rmse8";
  double max_error = 0.0;  ///< 0: none is promised
  double share = 0.95;
  std::vector<std::string> allowed;
  RunOptions run;
  bool json = false;
};

Result<std::vector<std::int64_t>> frames_to_check(const VerifyErrorArguments& arguments,
                                                  const JobStore& store) {
  if (!arguments.only.empty()) return arguments.only;
  std::vector<std::int64_t> done;
  const Status read = store.for_each_frame([&](const FrameRow& row) -> Status {
    if (row.state == FrameState::kDone) done.push_back(row.frame);
    return {};
  });
  if (!read) return forward_error(read);
  if (done.empty()) return fail(ErrorKind::kInput, "no frame of {} is done", arguments.folder);
  return stratified_sample(done, arguments.frames, arguments.sample_seed);
}

Json to_json(const ErrorCheck& check, const ErrorPromise& promise, const PromiseCheck* outcome) {
  Json frames = Json::array();
  for (const CheckedFrame& frame : check.frames) {
    Json json = {{"frame", frame.frame}, {"display_bias", frame.error.display.bias}};
    for (const Measure& measure : measures()) json[measure.key] = measure.of(frame.error);
    frames.push_back(std::move(json));
  }
  Json json = {{"reference_samples", check.reference_samples},
               {"reference_cpu_s", check.reference_cpu_s},
               {"frames", frames}};
  if (outcome != nullptr) {
    json["promise"] = {{"measure", promise.measure->key},
                       {"max_error", promise.max_error},
                       {"share", promise.share},
                       {"within", outcome->within.value},
                       {"within_least", outcome->within.least},
                       {"within_most", outcome->within.most},
                       {"beyond", outcome->beyond},
                       {"kept", outcome->is_kept}};
  }
  return json;
}

void print_check(const ErrorCheck& check, const ErrorPromise& promise) {
  say("{} frames against references of {} samples ({:.1f} CPU s each)\n", check.frames.size(),
      check.reference_samples, check.reference_cpu_s);
  say("{:>8}  {:>8}  {:>9}  {:>8}  {:>12}\n", "frame", "rmse8", "relmse", "flip", "bias, codes");
  for (const CheckedFrame& frame : check.frames) {
    say("{:>8}  {:>8.2f}  {:>9.2g}  {:>8.4f}  {:>+12.2f}\n", frame.frame,
        frame.error.display.rmse(), frame.error.linear.squared.rel_mse, frame.error.display.flip,
        frame.error.display.bias);
  }
  constexpr double kMost = 0.95;
  const std::vector<FrameError> errors = check.errors_in(*promise.measure);
  say("{}: half of them within {:.3g}, 95 % within {:.3g}, all within {:.3g}\n",
      promise.measure->key, quantile_of_error(errors, 0.5), quantile_of_error(errors, kMost),
      quantile_of_error(errors, 1.0));
}

void print_promise(const PromiseCheck& outcome, const ErrorPromise& promise) {
  say("{:.1f} % of the frames are within {} of {} (between {:.1f} and {:.1f} % with 95 % "
      "confidence); {:.1f} % were promised: {}\n",
      100.0 * outcome.within.value, promise.measure->key, promise.max_error,
      100.0 * outcome.within.least, 100.0 * outcome.within.most, 100.0 * promise.share,
      outcome.is_kept ? "kept" : "BROKEN");
  if (outcome.beyond.empty()) return;
  say("beyond it: {}\n", fmt::join(outcome.beyond, ", "));
}

/// What the command line says, or else the config.
ErrorPromise promise_of(const VerifyErrorArguments& arguments, const CampaignSettings& settings) {
  if (arguments.max_error > 0.0 || !settings.quality) {
    return {&measure_named(arguments.measure), arguments.max_error, arguments.share};
  }
  return promise_of(*settings.quality);
}

/// For 'status' and 'resume --raise'; of a campaign that promises nothing, nobody asks later.
bool keep(Campaign& campaign, const PreparedCampaign& prepared, const ErrorCheck& check) {
  if (!prepared.settings.quality) return false;
  const Status kept = keep_errors(campaign, check);
  if (!kept) {
    say_aside("seedframe: note: the campaign does not keep what was measured: {}\n",
              kept.error().message);
  }
  return kept.has_value();
}

int verify_error(const VerifyErrorArguments& arguments) {
  Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  const Result<PreparedCampaign> prepared =
      prepare_again(*campaign, seedframe_home(), arguments.allowed);
  if (!prepared) return report(prepared.error());
  const auto frames = frames_to_check(arguments, campaign->store);
  if (!frames) return report(frames.error());
  RunOptions options = arguments.run;
  options.no_cache = true;
  const Result<RunSetup> setup =
      set_up_run(options, prepared->settings, static_cast<std::int64_t>(2 * frames->size()));
  if (!setup) return report(setup.error());
  print_notes(*setup);
  const Result<TemporaryFolder> scratch = TemporaryFolder::make("seedframe-verify");
  if (!scratch) return report(scratch.error());
  const Result<ErrorCheck> check =
      check_errors(*campaign, *prepared, *setup, {*frames, arguments.reference_samples},
                   scratch->path(), [&](std::int64_t frame) {
                     if (arguments.run.quiet) return;
                     std::fprintf(stderr, "frame %lld\n", static_cast<long long>(frame));
                   });
  if (!check) return report(check.error());
  const ErrorPromise promise = promise_of(arguments, prepared->settings);
  const bool is_promised = promise.max_error > 0.0;
  const PromiseCheck outcome = check_promise(check->errors_in(*promise.measure), promise);
  const bool is_recorded = keep(*campaign, *prepared, *check);
  if (arguments.json) {
    Json json = to_json(*check, promise, is_promised ? &outcome : nullptr);
    json["recorded"] = is_recorded;
    fmt::print("{}", readable_json(json));
  } else {
    print_check(*check, promise);
    if (is_promised) print_promise(outcome, promise);
  }
  return is_promised && !outcome.is_kept ? kExitErrorBound : kExitOk;
}

std::vector<std::string> measure_words() {
  std::vector<std::string> words;
  for (const Measure& measure : measures()) words.emplace_back(measure.key);
  return words;
}

}  // namespace

void add_verify_error_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<VerifyErrorArguments>();
  CLI::App* verb = app.add_subcommand("verify-error",
                                      "how far frames are from what they would be with endless "
                                      "samples: renders a sample of them to "
                                      "that quality, beside the campaign");
  verb->add_option("DIR", arguments->folder, "folder of the campaign")->required();
  verb->add_option("--frames", arguments->frames, "how many, spread over those that are done")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--frame", arguments->only, "just this frame; may be given again")
      ->allow_extra_args(false)
      ->check(NotNegative());
  verb->add_option("--sample-seed", arguments->sample_seed, "another one draws other frames")
      ->capture_default_str();
  verb->add_option("--samples", arguments->reference_samples, "of a reference")
      ->check(CLI::Range(16, 1 << 20))
      ->capture_default_str();
  verb->add_option("--measure", arguments->measure,
                   "what is bounded: rmse8, relmse, flip, mrse, dissimilarity or edge_noise")
      ->check(offers(measure_words()))
      ->capture_default_str();
  verb->add_option(
          "--max-error", arguments->max_error,
          "how wrong a frame may be (default: what the config's section 'quality' says; if there "
          "is none, nothing is judged)")
      ->check(CLI::PositiveNumber);
  verb->add_option("--share", arguments->share, "of the frames that are to be within it, 0 to 1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  add_run_options(*verb, arguments->run);
  add_allow_option(*verb, arguments->allowed);
  verb->add_flag("--json", arguments->json, "print it as JSON");
  verb->footer("Example: seedframe verify-error results/parts --max-error 4");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return verify_error(*arguments); }); });
}

}  // namespace seedframe
