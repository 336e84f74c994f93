// seedframe preview: some frames of a config, in seconds, before any long rendering.

#include <filesystem>
#include <future>
#include <memory>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "base/spread.h"
#include "campaign/disk_space.h"
#include "campaign/input_images.h"
#include "campaign/run_setup.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/open_file.h"
#include "console/progress.h"
#include "console/run_options.h"
#include "console/say.h"
#include "console/temporary_folder.h"
#include "picture/picture_file.h"
#include "plan/frame_bytes.h"
#include "preview/object_sizes.h"
#include "preview/preview_sheet.h"
#include "preview/rendered_preview.h"
#include "preview/twin_preview.h"
#include "report/scene_survey.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

struct PreviewArguments {
  std::string config;
  std::vector<std::string> set;
  std::vector<std::string> allowed;
  std::string output;
  int frames = 8;
  bool labels_only = false;
  bool overwrite = false;
  bool open = false;
  RunOptions run;
};

constexpr int kPictureWidth = 320;

/// What is drawn and what is said, however the pictures came about.
struct Preview {
  std::vector<PreviewedFrame> frames;
  std::vector<std::string> failures;
  std::string how;    ///< "shaded by the twin, not rendered"
  std::string costs;  ///< a sentence
};

std::string disk_text(const CampaignSettings& settings) {
  return bytes_text(typical_frame_bytes(settings) *
                    static_cast<std::uint64_t>(settings.frame_count()));
}

Result<Preview> preview_by_labels(const PreparedCampaign& prepared,
                                  const std::vector<std::int64_t>& frames, bool told_by_config,
                                  const std::string& config) {
  auto seen =
      preview_by_twin(prepared.expander, prepared.settings.categories, frames, kPictureWidth);
  if (!seen) return forward_error(seen);
  Preview preview;
  preview.frames = std::move(*seen);
  preview.how = "shaded by the twin, not rendered";
  preview.costs = fmt::format(
      "All {} frames: about {} on the disk; {}", prepared.settings.frame_count(),
      disk_text(prepared.settings),
      told_by_config
          ? fmt::format("'seedframe submit {} --dry-run --pilot 8' tells the time", config)
          : fmt::format("'seedframe preview {}' renders, and tells the time", config));
  return preview;
}

std::string costs_text(const PreparedCampaign& prepared, const RenderedPreview& rendered,
                       const RunSetup& setup, const std::string& config) {
  const std::string all = fmt::format("All {} frames", prepared.settings.frame_count());
  const std::string disk = disk_text(prepared.settings) + " on the disk";
  if (prepared.settings.quality) {
    return fmt::format(
        "{}: about {}; with 'quality' samples are chosen when it is submitted, and "
        "the time with them",
        all, disk);
  }
  if (!rendered.costs) return fmt::format("{}: about {}", all, disk);
  return fmt::format(
      "{}: {} {} by {} ({:.2g} s a frame) and {}; 'seedframe submit {} --dry-run --pilot 8' tells "
      "it "
      "more exactly",
      all, rendered.costs->is_at_most ? "at most about" : "about",
      duration_text(rendered.costs->wall_s), describe(setup), rendered.costs->frame_s, disk,
      config);
}

Result<Preview> preview_by_blender(const PreparedCampaign& prepared,
                                   const PreviewArguments& arguments,
                                   const std::vector<std::int64_t>& frames) {
  RunOptions options = arguments.run;
  options.no_cache = true;
  const std::int64_t all = prepared.settings.frame_count();
  const PreviewWish wish{.frames = frames, .most_width = kPictureWidth};
  Result<RunSetup> setup = set_up_run(options, prepared.settings, all);
  if (!setup) return forward_error(setup);
  print_notes(*setup);
  setup->options.pool.begin_together = true;
  const Result<TemporaryFolder> scratch = TemporaryFolder::make("seedframe-preview");
  if (!scratch) return forward_error(scratch);
  const bool is_watched = !options.quiet && ::isatty(STDERR_FILENO) != 0;
  Result<RenderedPreview> rendered = preview_by_rendering(
      prepared, *setup, wish, scratch->path() / "frames", [&](std::int64_t done, std::int64_t of) {
        if (is_watched) fmt::print(stderr, "\r{} of {} small renderings", done, of);
      });
  if (is_watched) fmt::print(stderr, "\n");
  if (!rendered) return forward_error(rendered);
  if (rendered->frames.empty()) {
    return fail(ErrorKind::kRender, "no frame could be rendered\n{}",
                rendered->failures.empty() ? "" : rendered->failures.front());
  }
  Preview preview;
  preview.how = fmt::format("rendered with {} samples{}", rendered->samples,
                            rendered->denoised ? ", denoised" : "");
  preview.costs = costs_text(prepared, *rendered, *setup, arguments.config);
  preview.frames = std::move(rendered->frames);
  preview.failures = std::move(rendered->failures);
  return preview;
}

int draw(const Preview& preview, const CampaignSettings& settings,
         const std::vector<std::string>& warnings, const fs::path& output, bool overwrite) {
  ObjectSizes sizes(settings.categories);
  for (const PreviewedFrame& frame : preview.frames) sizes.add(frame.content.labels, frame.scale);
  PreviewText text;
  text.title = settings.name;
  text.subtitle = fmt::format("{} of {} frames · {} × {} px · {}", preview.frames.size(),
                              settings.frame_count(), settings.render.width, settings.render.height,
                              preview.how);
  for (const std::string& warning : warnings) text.remarks.push_back("Warning: " + warning);
  for (const std::string& failure : preview.failures) text.remarks.push_back(failure);
  text.remarks.push_back(preview.costs);
  const auto picture = draw_sheet(preview_sheet(preview.frames, sizes.by_class(), text));
  if (!picture) return report(picture.error());
  if (Status written = write_picture(*picture, output, overwrite); !written) {
    return report(written.error());
  }
  say("{}: {} of {} frames, {} ({} × {} pixels)\n", output.string(), preview.frames.size(),
      settings.frame_count(), preview.how, picture->width, picture->height);
  const auto frames = static_cast<std::int64_t>(preview.frames.size());
  for (const std::string& line : lines_of(sizes.by_class(), frames)) say("{}\n", line);
  for (const std::string& warning : warnings) say("warning: {}\n", warning);
  for (const std::string& failure : preview.failures) say_aside("seedframe: note: {}\n", failure);
  say("{}\n", preview.costs);
  return preview.failures.empty() ? kExitOk : kExitSomeFailed;
}

int preview(const PreviewArguments& arguments) {
  Result<CampaignSource> source = read_source(arguments.config, arguments.set, seedframe_home(),
                                              with_own_assets(arguments.allowed));
  if (!source) return report(source.error());
  Result<PreparedCampaign> prepared = prepare(std::move(*source));
  if (!prepared) return report(prepared.error());
  const CampaignSettings& settings = prepared->settings;
  const fs::path output = arguments.output.empty() ? fs::path(settings.name + "-preview.png")
                                                   : fs::path(arguments.output);
  if (Status possible = check_picture_file(output, arguments.overwrite); !possible) {
    return report(possible.error());
  }
  const bool without_pictures = settings.labels == LabelSource::kTwin;
  const bool by_twin = arguments.labels_only || without_pictures;
  if (!by_twin) {
    if (Status good = check_input_images(*prepared, cache_folder()); !good) {
      return report(good.error());
    }
  }
  auto surveying = std::async(
      std::launch::async, [&] { return survey_scenes(prepared->expander, settings.categories); });
  const std::vector<std::int64_t> frames = spread_over(settings.frame_count(), arguments.frames);
  const Result<Preview> made =
      by_twin ? preview_by_labels(*prepared, frames, without_pictures, arguments.config)
              : preview_by_blender(*prepared, arguments, frames);
  const Result<SceneSurvey> survey = surveying.get();
  if (!made) return report(made.error());
  if (!survey) return report(survey.error());
  const int code = draw(*made, settings, survey->warnings, output, arguments.overwrite);
  if (arguments.open && (code == kExitOk || code == kExitSomeFailed)) open_file(output);
  return code;
}

}  // namespace

void add_preview_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<PreviewArguments>();
  CLI::App* verb = app.add_subcommand(
      "preview",
      "some frames of a config in seconds: boxes, object sizes, warnings, time and disk of all");
  verb->add_option("CONFIG", arguments->config, "campaign config (docs/config.md)")->required();
  verb->add_option("-o,--output", arguments->output,
                   "the picture, .png or .jpg (default: <name of the campaign>-preview.png here)")
      ->type_name("FILE");
  verb->add_option("--frames", arguments->frames, "so many, spread over the campaign (default: 8)")
      ->check(CLI::Range(1, 100));
  verb->add_flag("--labels-only", arguments->labels_only,
                 "without Blender: shaded by the twin with textures and shadows, but no "
                 "reflections, in about a second");
  verb->add_option("--set", arguments->set, "path=value: replaces a value of the config")
      ->allow_extra_args(false);
  verb->add_flag("--overwrite", arguments->overwrite,
                 "also where there is a file that Seedframe did not draw");
  verb->add_flag("--open", arguments->open, "show it on the screen");
  add_allow_option(*verb, arguments->allowed);
  add_run_options(*verb, arguments->run);
  verb->footer("Example: seedframe preview configs/parts.yaml --labels-only");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return preview(*arguments); }); });
}

}  // namespace seedframe
