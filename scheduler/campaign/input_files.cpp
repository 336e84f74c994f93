#include "campaign/input_files.h"

#include <algorithm>

#include <fmt/format.h>
#include <sys/stat.h>

#include "base/canonical_json.h"
#include "base/sha256.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostFiles = 50'000;

fs::path our_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error);
}

bool is_ourselves(const std::string& path) { return path == our_program(); }

void add_file(const fs::path& path, InputStamps& stamps) {
  struct stat info = {};
  const bool found = ::stat(path.c_str(), &info) == 0;
  stamps[path.string()] =
      found ? fmt::format("{} {}.{:09}", info.st_size, info.st_mtim.tv_sec, info.st_mtim.tv_nsec)
            : "missing";
}

/// False when there are too many files.
bool add_folder(const fs::path& folder, InputStamps& stamps) {
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (stamps.size() >= kMostFiles) return false;
    if (!entry->is_directory(error)) add_file(entry->path(), stamps);
  }
  return true;
}

Result<InputStamps> stamps_of_submission(const Campaign& campaign) {
  const Result<std::string> text = campaign.store.meta(kInputsKey);
  if (!text) return forward_error(text);
  if (text->empty()) return InputStamps();
  const std::string what = campaign.files.store().string();
  const Result<Json> json = parse_json(*text, what);
  if (!json) return forward_error(json);
  if (!json->is_object())
    return fail(ErrorKind::kCorrupt, "{}: its list of inputs is damaged", what);
  InputStamps stamps;
  for (const auto& [path, stamp] : json->items()) {
    if (stamp.is_string()) stamps[path] = stamp.get<std::string>();
  }
  return stamps;
}

/// New frame ids by frame, of those that are not what was submitted. `renewed` takes what there is
/// to tell of them, and the files of all.
Result<std::map<std::int64_t, std::string>> changed_frames(const Campaign& campaign,
                                                           const PreparedCampaign& prepared,
                                                           RenewedFrames& renewed) {
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return forward_error(counts);
  const std::int64_t wanted = prepared.expander.frame_count();
  const bool chosen = prepared.settings.quality.has_value();
  if (wanted < counts->total() || (wanted > counts->total() && chosen)) {
    return fail(
        ErrorKind::kInput,
        "{}: the campaign has {} frames, its config asks for {} now{}: submit it again, into "
        "another folder",
        campaign.files.root().string(), counts->total(), wanted,
        chosen ? ", and 'quality' chose for all of them together" : "");
  }
  renewed.added = wanted - counts->total();
  std::map<std::int64_t, std::string> changed;
  const Status visited = campaign.store.for_each_frame([&](const FrameRow& row) -> Status {
    Result<ExpandedFrame> expanded = prepared.expander.expand(row.frame);
    if (!expanded) return forward_error(expanded);
    renewed.used.add(expanded->used);
    if (expanded->id == row.frame_id) return {};
    changed[row.frame] = std::move(expanded->id);
    if (row.state == FrameState::kDone) ++renewed.finished;
    return {};
  });
  if (!visited) return forward_error(visited);
  return changed;
}

/// Frames that are done, and whose picture is to be another file now.
Result<std::vector<std::int64_t>> frames_to_encode_anew(const Campaign& campaign,
                                                        const CampaignSettings& settings) {
  std::vector<std::int64_t> frames;
  const Result<ImageEncoding> before = wanted_encoding(campaign);
  if (!before) return forward_error(before);
  const bool have_pictures = settings.labels == LabelSource::kIndexPass;
  if (*before == settings.image_encoding || !have_pictures) return frames;
  const Status visited = campaign.store.for_each_frame([&](const FrameRow& row) -> Status {
    if (row.state == FrameState::kDone) frames.push_back(row.frame);
    return {};
  });
  if (!visited) return forward_error(visited);
  return frames;
}

/// Whether its own graphs have lines of frames that the store does not know: whoever wrote them was
/// killed before it could add these.
Result<bool> has_grown(const Campaign& campaign, const PreparedCampaign& prepared) {
  if (prepared.source.graphs.empty()) return false;
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return forward_error(counts);
  return prepared.expander.frame_count() > counts->total();
}

tl::unexpected<Error> other_program(const fs::path& folder, std::int64_t frame,
                                    const std::string& how_many) {
  return fail(ErrorKind::kInput,
              "{}: no input has changed, but this Seedframe would make {} of its frames "
              "differently, for example frame {}: go on with the Seedframe (and the libraries) "
              "that made them, or submit the campaign again, into another folder",
              folder.string(), how_many, frame);
}

}  // namespace

InputStamps input_stamps(const PreparedCampaign& prepared) {
  std::error_code error;
  InputStamps stamps;
  Json config = {prepared.source.text};
  for (const Override& change : prepared.source.overrides) {
    config.push_back(change.path + "=" + change.value);
  }
  stamps["campaign.yaml"] = sha256_hex(canonical_json(config));
  add_file(our_program(), stamps);
  for (const fs::path& file : prepared.inputs.files) add_file(fs::absolute(file, error), stamps);
  for (const fs::path& folder : prepared.inputs.folders) {
    if (!add_folder(fs::absolute(folder, error), stamps)) return {};
  }
  return stamps;
}

std::vector<std::string> changed_inputs(const InputStamps& before, const InputStamps& now) {
  std::vector<std::string> changed;
  for (const auto& [path, stamp] : now) {
    const auto found = before.find(path);
    if (found == before.end() || found->second != stamp) changed.push_back(path);
  }
  for (const auto& [path, stamp] : before) {
    if (!now.contains(path)) changed.push_back(path);
  }
  return changed;
}

Result<std::vector<std::string>> inputs_changed_since(const Campaign& campaign,
                                                      const PreparedCampaign& prepared) {
  const Result<InputStamps> before = stamps_of_submission(campaign);
  if (!before) return forward_error(before);
  return changed_inputs(*before, input_stamps(prepared));
}

Result<std::vector<std::string>> inputs_touched(const Campaign& campaign) {
  const Result<InputStamps> before = stamps_of_submission(campaign);
  if (!before) return forward_error(before);
  std::vector<std::string> touched;
  for (const auto& [path, stamp] : *before) {
    if (!path.starts_with('/') || is_ourselves(path)) continue;
    InputStamps now;
    add_file(path, now);
    if (now[path] != stamp) touched.push_back(path);
  }
  return touched;
}

Result<HealedRows> heal_rows(Campaign& campaign, const PreparedCampaign& prepared) {
  std::vector<std::optional<std::string>> ids(
      static_cast<std::size_t>(prepared.expander.frame_count()));
  const Status visited = campaign.store.for_each_frame([&](const FrameRow& row) -> Status {
    if (row.frame < 0 || row.frame >= prepared.expander.frame_count()) {
      return fail(ErrorKind::kCorrupt, "{}: it has a frame {}, and the campaign has {} frames",
                  campaign.files.store().string(), row.frame, prepared.expander.frame_count());
    }
    ids[static_cast<std::size_t>(row.frame)] = row.frame_id;
    return {};
  });
  if (!visited) return forward_error(visited);
  HealedRows healed;
  std::vector<FrameRow> rows;
  for (std::int64_t frame = 0; frame < prepared.expander.frame_count(); ++frame) {
    const std::optional<std::string>& id = ids[static_cast<std::size_t>(frame)];
    Result<ExpandedFrame> expanded = prepared.expander.expand(frame);
    if (!expanded) return forward_error(expanded);
    if (id == expanded->id) continue;
    const Result<Manifest> there = read_manifest(campaign.files.frame(frame));
    if (id && there && there->frame_id == *id) {
      return other_program(campaign.files.root(), frame, "some");
    }
    (id ? healed.wrong : healed.lost).push_back(frame);
    FrameRow row;
    row.frame = frame;
    row.scene = expanded->scene;
    row.frame_id = std::move(expanded->id);
    rows.push_back(std::move(row));
  }
  const Status written = campaign.store.write_together(JobStore::Sync::kNow, [&]() -> Status {
    auto next = rows.begin();
    Status added = campaign.store.add_frames([&]() -> Result<std::optional<FrameRow>> {
      while (next != rows.end() && ids[static_cast<std::size_t>(next->frame)]) ++next;
      if (next == rows.end()) return std::nullopt;
      return *next++;
    });
    if (!added) return added;
    for (const FrameRow& row : rows) {
      if (!ids[static_cast<std::size_t>(row.frame)]) continue;
      if (Status done = campaign.store.renew(row.frame, row.frame_id); !done) return done;
    }
    return {};
  });
  if (!written) return forward_error(written);
  return healed;
}

Result<RenewedFrames> renew_changed_frames(
    Campaign& campaign, PreparedCampaign& prepared,
    const std::function<bool(const RenewedFrames&)>& may_replace) {
  const Result<InputStamps> before = stamps_of_submission(campaign);
  if (!before) return forward_error(before);
  const InputStamps now = input_stamps(prepared);
  RenewedFrames renewed;
  const Result<bool> grown = has_grown(campaign, prepared);
  if (!grown) return forward_error(grown);
  if (!now.empty() && now == *before && !*grown) return renewed;
  const auto changed = changed_frames(campaign, prepared, renewed);
  if (!changed) return forward_error(changed);
  const auto encoded = frames_to_encode_anew(campaign, prepared.settings);
  if (!encoded) return forward_error(encoded);
  renewed.frames = static_cast<std::int64_t>(changed->size());
  for (const std::int64_t frame : *encoded) {
    if (changed->contains(frame)) continue;
    ++renewed.frames;
    ++renewed.finished;
  }
  renewed.inputs = changed_inputs(*before, now);
  if (!changed->empty() &&
      std::all_of(renewed.inputs.begin(), renewed.inputs.end(), is_ourselves)) {
    return other_program(campaign.files.root(), changed->begin()->first,
                         std::to_string(changed->size()));
  }
  if (renewed.finished > 0 && !may_replace(renewed)) {
    return fail(
        ErrorKind::kInput,
        "{} finished frames would be replaced: 'seedframe resume {} --yes' does that. Nothing "
        "was changed",
        renewed.finished, campaign.files.root().string());
  }
  const Status written = campaign.store.write_together(JobStore::Sync::kNow, [&]() -> Status {
    for (const auto& [frame, id] : *changed) {
      if (Status done = campaign.store.renew(frame, id); !done) return done;
    }
    for (const std::int64_t frame : *encoded) {
      if (Status done = campaign.store.reset(frame); !done) return done;
    }
    const std::int64_t first = prepared.expander.frame_count() - renewed.added;
    if (Status done = add_frames_from(first, prepared, campaign.store); !done) return done;
    const std::string overrides = overrides_text(prepared.source);
    if (Status done = campaign.store.set_meta(kOverridesKey, overrides); !done) return done;
    const std::string encoding = canonical_json(to_json(prepared.settings.image_encoding));
    if (Status done = campaign.store.set_meta(kEncodingKey, encoding); !done) return done;
    const std::string quality = quality_text(prepared.settings);
    if (Status done = campaign.store.set_meta(kQualityKey, quality); !done) return done;
    return campaign.store.set_meta(kInputsKey, canonical_json(Json(now)));
  });
  if (!written) return forward_error(written);
  return renewed;
}

}  // namespace seedframe
