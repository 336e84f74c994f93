// seedframe render: one frame of a campaign, rendered beside it with other settings.

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "base/cores.h"
#include "base/files.h"
#include "campaign/campaign.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/blender_option.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/run_options.h"
#include "console/say.h"
#include "console/temporary_folder.h"
#include "frames/rendered_frame.h"
#include "image/exr_file.h"
#include "image_files/image_writer.h"
#include "quality/side_renderer.h"
#include "sensor/camera_sensor.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

struct RenderArguments {
  std::string folder;
  std::int64_t frame = 0;
  int samples = 0;
  std::vector<std::string> set;
  std::string output;
  std::string blend;  ///< file for the scene; empty: none
  std::vector<std::string> allowed;
  RunOptions run;
};

/// The format that a file's ending names; nothing for EXR.
Result<std::optional<ImageFormat>> format_of(const fs::path& file) {
  const std::string ending = file.extension();
  if (ending == ".exr") return std::nullopt;
  for (const ImageFormat format :
       {ImageFormat::kPng, ImageFormat::kJpeg, ImageFormat::kWebp, ImageFormat::kTiff}) {
    if (ending == ending_of(format)) return format;
  }
  return fail(ErrorKind::kInput, "{}: expected a name that ends in .png, .jpg, .webp, .tif or .exr",
              file.string());
}

Status write_picture(const SideFrame& frame, const ColorManagement& color, const fs::path& file) {
  const auto format = format_of(file);
  if (!format) return forward_error(format);
  const FramePasses passes = on_whole_image(frame.passes, frame.spec.render);
  if (!*format) return write_exr(file, passes.combined, {"R", "G", "B", "A"});
  auto display = color.apply(passes.combined, frame.spec.image);
  if (display && frame.spec.sensor) display = through_sensor(*display, *frame.spec.sensor);
  if (!display) return forward_error(display);
  const auto bytes = encode_image(*display, {.format = **format});
  if (!bytes) return forward_error(bytes);
  return write_file(file, *bytes);
}

/// The campaign's frames with what is set.
Result<PreparedCampaign> prepare_with(const Campaign& campaign, const RenderArguments& arguments) {
  Result<std::vector<Override>> more = read_overrides(arguments.set);
  if (!more) return forward_error(more);
  if (arguments.samples > 0) {
    more->push_back({"render.samples", std::to_string(arguments.samples)});
    more->push_back({"quality", "null"});  // which would choose others
  }
  Result<PreparedCampaign> prepared =
      prepare_again(campaign, seedframe_home(), arguments.allowed, *more);
  if (!prepared) return prepared;
  if (prepared->settings.labels == LabelSource::kTwin) {
    return fail(ErrorKind::kInput,
                "{} has labels without pictures: '--set labels=render' gives the frame one",
                arguments.folder);
  }
  const std::int64_t all = prepared->expander.frame_count();
  if (arguments.frame >= all) {
    return fail(ErrorKind::kInput, "there is no frame {}: {} has frames 0 to {}", arguments.frame,
                arguments.folder, all - 1);
  }
  return prepared;
}

/// One frame, kept.
class OneFrame : public SideClient {
 public:
  OneFrame(const SceneExpander& expander, std::int64_t frame, const ColorManagement& color,
           fs::path file, fs::path blend)
      : expander_(expander),
        frame_(frame),
        color_(color),
        file_(std::move(file)),
        blend_(std::move(blend)) {}

  Result<ExpandedFrame> frame(std::int64_t) override { return expander_.expand(frame_); }
  Status rendered(std::int64_t, const SideFrame& frame) override {
    timings = frame.timings;
    samples = frame.spec.render.samples;
    if (!blend_.empty()) {
      const Result<std::string> scene = read_file(frame.scene);
      if (!scene) return forward_error(scene);
      if (Status written = write_file(blend_, *scene); !written) return written;
    }
    return write_picture(frame, color_, file_);
  }
  bool wants_scene(std::int64_t) const override { return !blend_.empty(); }
  void failed(std::int64_t, const std::string& why) override {
    failure = fail(ErrorKind::kRender, "frame {} was not rendered: {}", frame_, why);
  }

  RenderTimings timings;
  int samples = 0;
  Status failure;

 private:
  const SceneExpander& expander_;
  std::int64_t frame_;
  const ColorManagement& color_;
  fs::path file_;
  fs::path blend_;
};

int render(const RenderArguments& arguments) {
  const Result<Campaign> campaign = open_campaign(arguments.folder);
  if (!campaign) return report(campaign.error());
  const fs::path file = arguments.output.empty()
                            ? fs::path(fmt::format("frame-{}.png", arguments.frame))
                            : fs::path(arguments.output);
  if (const auto format = format_of(file); !format) return report(format.error());
  const Result<PreparedCampaign> prepared = prepare_with(*campaign, arguments);
  if (!prepared) return report(prepared.error());
  RunOptions options = arguments.run;
  options.pool.workers = 1;
  options.no_cache = true;
  if (options.worker.threads == 0) options.worker.threads = core_count();
  const Result<RunSetup> setup = set_up_run(options, prepared->settings, 1);
  if (!setup) return report(setup.error());
  print_notes(*setup);
  const Result<TemporaryFolder> scratch = TemporaryFolder::make("seedframe-render");
  if (!scratch) return report(scratch.error());
  OneFrame frame(prepared->expander, arguments.frame, *setup->color, file, arguments.blend);
  if (Status done = render_aside(1, *setup, scratch->path(), frame); !done) {
    return report(done.error());
  }
  if (!frame.failure) return report(frame.failure.error());
  say("{} is frame {} at {} samples: {:.1f} s, {:.1f} CPU s\n", file.string(), arguments.frame,
      frame.samples, frame.timings.build_s + frame.timings.render_s, frame.timings.cpu_s);
  if (!arguments.blend.empty()) {
    say("{} is its scene, for Blender {} or later\n", arguments.blend, setup->blender.version);
  }
  return kExitOk;
}

}  // namespace

void add_render_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* verb = app.add_subcommand(
      "render", "one frame of a campaign with other settings, into a file beside the campaign");
  verb->add_option("DIR", arguments->folder, "folder of the campaign, which is only read")
      ->required();
  verb->add_option("--frame", arguments->frame, "its index, from 0")
      ->required()
      ->check(NotNegative());
  verb->add_option("--samples", arguments->samples, "of a pixel (default: the campaign's)")
      ->check(CLI::Range(1, 1 << 20));
  verb->add_option("--set", arguments->set, "path=value: replaces a value of the config")
      ->allow_extra_args(false);
  verb->add_option("-o,--output", arguments->output,
                   "file: .png, .jpg, .webp or .tif as displayed, .exr scene-linear (default: "
                   "frame-N.png)")
      ->type_name("FILE");
  verb->add_option("--save-blend", arguments->blend,
                   "file for the frame's scene, to be opened in Blender, its images in it")
      ->type_name("FILE.blend")
      ->check([](const std::string& file) {
        return file.ends_with(".blend") ? "" : "'" + file + "' does not end in .blend";
      });
  verb->add_option("--threads", arguments->run.worker.threads, "of Blender (default: all cores)")
      ->check(CLI::Range(1, 1024));
  add_blender_option(*verb, arguments->run.blender);
  add_allow_option(*verb, arguments->allowed);
  verb->footer("Example: seedframe render results/parts --frame 7 --samples 1024 -o frame.png");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return render(*arguments); }); });
}

}  // namespace seedframe
