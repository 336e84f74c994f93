#include "quality/error_check.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <utility>

#include "base/philox.h"
#include "frames/campaign_files.h"
#include "quality/reference.h"
#include "quality/side_renderer.h"
#include "quality/variation.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// What the campaign has of a frame.
struct StoredFrame {
  FrameRow row;
  FrameSpec spec;
  Picture picture;
};

Result<StoredFrame> read_stored(const Campaign& campaign, const PreparedCampaign& prepared,
                                std::int64_t frame, const ColorManagement& color) {
  const auto row = campaign.store.frame(frame);
  if (!row) return forward_error(row);
  if (!*row || (*row)->state != FrameState::kDone) {
    return fail(ErrorKind::kInput, "frame {} of {} is not done", frame,
                campaign.files.root().string());
  }
  Result<ExpandedFrame> expanded = prepared.expander.expand(frame);
  if (!expanded) return forward_error(expanded);
  if (expanded->id != (*row)->frame_id) {
    return fail(ErrorKind::kInput,
                "frame {} would be another one today, since an input has changed: 'seedframe "
                "resume {}' renders it again",
                frame, campaign.files.root().string());
  }
  PassExpectation expected;
  const PixelRect rendered = expanded->spec.render.rendered_pixels();
  expected.width = rendered.width;
  expected.height = rendered.height;
  constexpr int kMostId = 32'767;
  expected.max_instance_id = kMostId;
  Result<FramePasses> passes =
      read_passes(campaign.files.frame(frame) / frame_files::kPasses, expected);
  if (!passes) return fail(ErrorKind::kCorrupt, "{}", passes.error().message);
  Result<Image<std::uint8_t>> display = color.apply(passes->combined, expanded->spec.image);
  if (!display) return forward_error(display);
  return StoredFrame{
      **row, std::move(expanded->spec), {std::move(passes->combined), std::move(*display)}};
}

class ErrorChecker : public SideClient {
 public:
  ErrorChecker(std::vector<StoredFrame> stored, const PreparedCampaign& reference,
               const ColorManagement& color, const std::function<void(std::int64_t)>& on_rendering)
      : stored_(std::move(stored)),
        reference_(reference),
        color_(color),
        on_rendering_(on_rendering),
        halves_(stored_.size()),
        errors_(stored_.size()) {}

  std::int64_t jobs() const { return static_cast<std::int64_t>(2 * stored_.size()); }

  Result<ErrorCheck> result() const {
    if (!failure_) return forward_error(failure_);
    ErrorCheck check;
    for (std::size_t i = 0; i < stored_.size(); ++i) {
      if (!errors_[i]) {
        return fail(ErrorKind::kRender, "frame {} has no reference", stored_[i].row.frame);
      }
      const FrameRow& row = stored_[i].row;
      check.frames.push_back({row.frame, row.frame_id, row.pixel_hash, *errors_[i]});
    }
    check.reference_cpu_s = cpu_s_ / static_cast<double>(std::max<std::size_t>(1, stored_.size()));
    return check;
  }

  Result<ExpandedFrame> frame(std::int64_t job) override {
    const StoredFrame& stored = stored_[index(job)];
    if (half(job) == 0) on_rendering_(stored.row.frame);
    return expand_half(reference_, stored.row.frame,
                       half(job) == 0 ? ReferenceHalf::kA : ReferenceHalf::kB);
  }

  Status rendered(std::int64_t job, const SideFrame& frame) override {
    const std::lock_guard lock(mutex_);
    cpu_s_ += frame.timings.cpu_s;
    auto& halves = halves_[index(job)];
    halves[half(job)] = frame.passes;
    if (!halves[0] || !halves[1]) return {};
    StoredFrame& stored = stored_[index(job)];
    const Result<Reference> reference =
        make_reference(*halves[0], *halves[1], color_, stored.spec.image);
    if (!reference) return forward_error(reference);
    errors_[index(job)] = error_against(*reference, stored.picture);
    halves = {};
    stored.picture = {};
    return {};
  }

  void failed(std::int64_t job, const std::string& why) override {
    const std::lock_guard lock(mutex_);
    if (!failure_) return;
    failure_ = fail(ErrorKind::kRender, "the reference of frame {} was not rendered: {}",
                    stored_[index(job)].row.frame, why);
  }

 private:
  static std::size_t index(std::int64_t job) { return static_cast<std::size_t>(job / 2); }
  static std::size_t half(std::int64_t job) { return static_cast<std::size_t>(job % 2); }

  std::vector<StoredFrame> stored_;
  const PreparedCampaign& reference_;
  const ColorManagement& color_;
  const std::function<void(std::int64_t)>& on_rendering_;
  std::mutex mutex_;
  std::vector<std::array<std::optional<FramePasses>, 2>> halves_;
  std::vector<std::optional<RenderingError>> errors_;
  double cpu_s_ = 0.0;
  Status failure_;
};

}  // namespace

std::vector<FrameError> ErrorCheck::errors_in(const Measure& measure) const {
  std::vector<FrameError> errors;
  for (const CheckedFrame& each : frames) errors.push_back({each.frame, measure.of(each.error)});
  return errors;
}

std::vector<std::int64_t> stratified_sample(const std::vector<std::int64_t>& done, int count,
                                            std::uint64_t seed) {
  const auto all = static_cast<std::int64_t>(done.size());
  if (count >= all) return done;
  const PhiloxStream stream(seed, "quality.sample");
  std::vector<std::int64_t> sample;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t first = i * all / count;
    const std::int64_t end = (i + 1) * all / count;
    const double at = stream.uniform({.frame = static_cast<std::uint32_t>(i)});
    const auto offset = static_cast<std::int64_t>(at * static_cast<double>(end - first));
    sample.push_back(done[static_cast<std::size_t>(first + offset)]);
  }
  return sample;
}

Result<ErrorCheck> check_errors(const Campaign& campaign, const PreparedCampaign& prepared,
                                const RunSetup& setup, const CheckWishes& wishes,
                                const fs::path& scratch,
                                const std::function<void(std::int64_t frame)>& on_rendering) {
  if (prepared.settings.labels == LabelSource::kTwin) {
    return fail(ErrorKind::kInput,
                "{} has labels without pictures (labels: geometry), so there is no error to check",
                campaign.files.root().string());
  }
  std::vector<StoredFrame> stored;
  for (const std::int64_t frame : wishes.frames) {
    Result<StoredFrame> read = read_stored(campaign, prepared, frame, *setup.color);
    if (!read) return forward_error(read);
    stored.push_back(std::move(*read));
  }
  CampaignSource source = prepared.source;
  const std::vector<Override> set = reference_variation(wishes.reference_samples / 2).set;
  source.overrides.insert(source.overrides.end(), set.begin(), set.end());
  const Result<PreparedCampaign> reference = prepare(std::move(source));
  if (!reference) return forward_error(reference);
  ErrorChecker checker(std::move(stored), *reference, *setup.color, on_rendering);
  if (Status done = render_aside(checker.jobs(), setup, scratch, checker); !done) {
    return forward_error(done);
  }
  Result<ErrorCheck> check = checker.result();
  if (check) check->reference_samples = wishes.reference_samples / 2 * 2;
  return check;
}

}  // namespace seedframe
