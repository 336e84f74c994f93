#include "quality/probe.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/philox.h"
#include "quality/sample_counts.h"
#include "quality/side_renderer.h"

namespace seedframe {
namespace {

class ProbeClient : public SideClient {
 public:
  using Before = std::function<void(std::int64_t)>;
  using Told = std::function<void(std::size_t, Result<ProbedFrame>)>;

  ProbeClient(const std::vector<Probe>& probes, const PreparedCampaign& prepared,
              const ColorManagement& color, const Before& before, const Told& told)
      : probes_(probes), prepared_(prepared), color_(color), before_(before), told_(told) {}

  Result<ExpandedFrame> frame(std::int64_t job) override {
    before_(job);
    return expand_probe(prepared_, probes_[static_cast<std::size_t>(job)]);
  }
  Status rendered(std::int64_t job, const SideFrame& frame) override {
    Result<Image<std::uint8_t>> display = color_.apply(frame.passes.combined, frame.spec.image);
    if (!display) return forward_error(display);
    const int samples = frame.spec.render.samples;
    const double mean =
        frame.passes.sample_shares ? mean_samples(*frame.passes.sample_shares, samples) : samples;
    tell(job, ProbedFrame{{frame.passes.combined, std::move(*display)}, mean, frame.timings.cpu_s});
    return {};
  }
  bool wants_sample_counts(std::int64_t job) const override {
    return probes_[static_cast<std::size_t>(job)].choice.adaptive.threshold > 0.0;
  }
  void failed(std::int64_t job, const std::string& why) override {
    tell(job, fail(ErrorKind::kRender, "{}", why.substr(0, why.find('\n'))));
  }

 private:
  void tell(std::int64_t job, Result<ProbedFrame> frame) {
    const std::lock_guard lock(mutex_);
    told_(static_cast<std::size_t>(job), std::move(frame));
  }

  const std::vector<Probe>& probes_;
  const PreparedCampaign& prepared_;
  const ColorManagement& color_;
  const Before& before_;
  const Told& told_;
  std::mutex mutex_;
};

}  // namespace

void halve_resolution(FrameSpec& spec) {
  const auto half = [](int size) { return (size + 1) / 2; };
  spec.render.width = half(spec.render.width);
  spec.render.height = half(spec.render.height);
  if (spec.render.region) {  // outwards
    const PixelRect whole = *spec.render.region;
    PixelRect& region = *spec.render.region;
    region = {whole.x / 2, whole.y / 2, 0, 0};
    region.width = half(whole.end_x()) - region.x;
    region.height = half(whole.end_y()) - region.y;
  }
  for (double& focal : spec.camera.focal_px) focal /= 2.0;
  // Pixel centres are whole numbers, so the picture's corner is at -1/2.
  for (double& center : spec.camera.center_px) center = (center + 0.5) / 2.0 - 0.5;
}

Result<ExpandedFrame> expand_probe(const PreparedCampaign& prepared, const Probe& probe) {
  Result<ExpandedFrame> expanded = prepared.expander.expand(probe.frame, {.id = false});
  if (!expanded) return expanded;
  FrameSpec& spec = expanded->spec;
  spec.render.samples = probe.choice.samples;
  spec.render.adaptive = probe.choice.adaptive;
  spec.render.denoise = probe.choice.denoise;
  spec.render.depth = spec.render.normal = false;
  const PhiloxStream stream(prepared.settings.seed, "quality.probe." + probe.stream);
  spec.render.seed = stream.cycles_seed({.frame = static_cast<std::uint32_t>(probe.frame)});
  if (probe.quarter) halve_resolution(spec);
  expanded->id = frame_id(spec);
  return expanded;
}

Status render_probes(const std::vector<Probe>& probes, const PreparedCampaign& prepared,
                     const RunSetup& setup, const std::filesystem::path& scratch,
                     const std::function<void(std::int64_t probe)>& before,
                     const std::function<void(std::size_t probe, Result<ProbedFrame>)>& told) {
  ProbeClient client(probes, prepared, *setup.color, before, told);
  return render_aside(static_cast<std::int64_t>(probes.size()), setup, scratch, client);
}

}  // namespace seedframe
