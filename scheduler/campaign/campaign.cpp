#include "campaign/campaign.h"

#include <algorithm>
#include <array>

#include <unistd.h>

#include "base/clock.h"
#include "base/files.h"
#include "campaign/input_files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr const char* kConfigFileKey = "config_file";  // absolute: the job store is not the dataset
constexpr const char* kAllowedKey = "allowed_folders";  // a JSON list
constexpr const char* kGrowsKey = "grows";  // "yes": its frames are those of its own graphs

/// What the campaign was made from.
Status describe_campaign(const PreparedCampaign& prepared, JobStore& store) {
  std::error_code error;
  const std::string file = fs::absolute(prepared.source.file, error).string();
  if (Status set = store.set_meta(kConfigFileKey, file); !set) return set;
  if (Status set = store.set_meta(kOverridesKey, overrides_text(prepared.source)); !set) {
    return set;
  }
  Json allowed = Json::array();
  for (const fs::path& path : prepared.source.allowed.folders()) allowed.push_back(path.string());
  if (Status set = store.set_meta(kAllowedKey, canonical_json(allowed)); !set) return set;
  const std::string inputs = canonical_json(Json(input_stamps(prepared)));
  if (Status set = store.set_meta(kInputsKey, inputs); !set) return set;
  const std::string encoding = canonical_json(to_json(prepared.settings.image_encoding));
  if (Status set = store.set_meta(kEncodingKey, encoding); !set) return set;
  const std::shared_ptr<const RenderChoices>& choices = prepared.expander.choices();
  if (choices == nullptr) return {};
  if (Status set = store.set_meta(kQualityKey, quality_text(prepared.settings)); !set) return set;
  return store.set_meta(kChoicesKey, canonical_json(to_json(*choices)));
}

Status write_campaign(const CampaignFiles& files, const PreparedCampaign& prepared,
                      FirstFrames first) {
  const bool grows = first == FirstFrames::kNone;
  for (const fs::path& folder : {files.frames(), files.logs()}) {
    if (Status made = make_folders(folder); !made) return made;
  }
  if (Status written = write_file_atomically(files.config(), prepared.source.text); !written) {
    return written;
  }
  if (grows) {
    if (Status written = write_file_atomically(files.graphs(), ""); !written) return written;
  }
  Result<JobStore> store = JobStore::create(files.unfinished_store());
  if (!store) return forward_error(store);
  // Together, since each transaction waits for the disk several times.
  return store->write_together(JobStore::Sync::kNow, [&]() -> Status {
    if (Status described = describe_campaign(prepared, *store); !described) return described;
    return grows ? store->set_meta(kGrowsKey, "yes") : add_frames_from(0, prepared, *store);
  });
}

tl::unexpected<Error> not_empty(const fs::path& folder) {
  return fail(ErrorKind::kInput, "{} is not empty: give another folder", folder.string());
}

/// Removes what a submission left that was killed before its store had its name. Anything else in
/// the folder is somebody's.
Status clear_unfinished(const CampaignFiles& files) {
  const fs::path store = files.unfinished_store();
  const std::vector<fs::path> left = {files.config(),
                                      files.config().string() + ".tmp",
                                      files.graphs(),
                                      files.graphs().string() + ".tmp",
                                      store,
                                      store.string() + "-wal",
                                      store.string() + "-shm",
                                      store.string() + "-journal",
                                      files.frames(),
                                      files.logs(),
                                      files.lock()};
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(files.root(), error)) {
    const bool ours = std::find(left.begin(), left.end(), entry.path()) != left.end();
    const bool empty = !entry.is_directory() || fs::is_empty(entry.path(), error);
    if (!ours || !empty) {
      return not_empty(files.root());
    }
  }
  for (const fs::path& path : left) {
    if (path != files.lock()) fs::remove(path, error);
  }
  return {};
}

}  // namespace

Status check_new_campaign(const fs::path& folder) {
  const CampaignFiles files(folder);
  std::error_code error;
  if (!fs::exists(folder, error)) return {};
  if (!fs::is_directory(folder, error)) {
    return fail(ErrorKind::kInput, "{} is not a folder: give another one", folder.string());
  }
  // Every submission makes its lock first: without one, whatever is there is somebody else's.
  if (!fs::is_empty(folder, error) && !fs::exists(files.lock(), error)) return not_empty(folder);
  if (fs::exists(files.store(), error)) {
    return fail(ErrorKind::kInput,
                "{} holds a campaign already: 'seedframe resume' goes on with it, --overwrite "
                "removes it, -o names another folder",
                folder.string());
  }
  return {};
}

Result<LockedCampaign> create_campaign(const fs::path& folder, const PreparedCampaign& prepared,
                                       FirstFrames first) {
  const CampaignFiles files(folder);
  std::error_code error;
  const bool existed = fs::exists(folder, error);
  if (Status possible = check_new_campaign(folder); !possible) return forward_error(possible);
  const auto not_possible = [&](const Error& cause) {
    if (!existed) fs::remove_all(folder, error);
    // The user chose this place, so it is for the user to fix.
    const bool full = cause.kind == ErrorKind::kExhausted;
    return tl::unexpected(Error{full ? cause.kind : ErrorKind::kInput, cause.message});
  };
  if (Status made = make_folders(folder); !made) return not_possible(made.error());
  Result<FolderLock> lock = FolderLock::acquire(files.lock());
  if (!lock) return forward_error(lock);
  if (Status possible = check_new_campaign(folder); !possible) return forward_error(possible);
  if (Status cleared = clear_unfinished(files); !cleared) return forward_error(cleared);
  Status made = write_campaign(files, prepared, first);
  if (made) made = rename_file(files.unfinished_store(), files.store());
  if (!made) return not_possible(made.error());
  Result<Campaign> campaign = open_campaign(folder);
  if (!campaign) return forward_error(campaign);
  return LockedCampaign{std::move(*campaign), std::move(*lock)};
}

Result<Campaign> create_scratch_campaign(const fs::path& folder,
                                         const std::vector<std::int64_t>& frames,
                                         const PreparedCampaign& prepared, UsedFiles& used) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  if (Status made = make_folders(folder); !made) return forward_error(made);
  const CampaignFiles files(folder);
  Result<JobStore> store = JobStore::create(files.store());
  if (!store) return forward_error(store);
  auto next = frames.begin();
  const Status added = store->add_frames([&]() -> Result<std::optional<FrameRow>> {
    if (next == frames.end()) return std::nullopt;
    Result<ExpandedFrame> expanded = prepared.expander.expand(*next);
    if (!expanded) return forward_error(expanded);
    used.add(expanded->used);
    FrameRow row;
    row.frame = *next++;
    row.scene = expanded->scene;
    row.frame_id = std::move(expanded->id);
    return row;
  });
  if (!added) return forward_error(added);
  Campaign campaign{files, std::move(*store)};
  if (Status begun = begin_run(campaign); !begun) return forward_error(begun);
  return campaign;
}

std::string overrides_text(const CampaignSource& source) {
  Json overrides = Json::array();
  for (const Override& change : source.overrides) {
    overrides.push_back({{"path", change.path}, {"value", change.value}});
  }
  return canonical_json(overrides);
}

Status add_frames_from(std::int64_t first, const PreparedCampaign& prepared, JobStore& store) {
  std::int64_t next = first;
  return store.add_frames([&]() -> Result<std::optional<FrameRow>> {
    if (next == prepared.expander.frame_count()) return std::nullopt;
    Result<ExpandedFrame> expanded = prepared.expander.expand(next);
    if (!expanded) return forward_error(expanded);
    FrameRow row;
    row.frame = next++;
    row.scene = expanded->scene;
    row.frame_id = std::move(expanded->id);
    return row;
  });
}

std::string quality_text(const CampaignSettings& settings) {
  return settings.quality ? canonical_json(to_json(*settings.quality)) : std::string();
}

Result<Campaign> open_campaign(const fs::path& folder) {
  const CampaignFiles files(folder);
  Result<JobStore> store = JobStore::open(files.store());
  if (!store) return forward_error(store);
  return Campaign{files, std::move(*store)};
}

Result<ImageEncoding> wanted_encoding(const Campaign& campaign) {
  const Result<std::string> text = campaign.store.meta(kEncodingKey);
  if (!text) return forward_error(text);
  if (text->empty()) return ImageEncoding{};
  const std::string what = campaign.files.store().string();
  const Result<Json> json = parse_json(*text, what);
  if (!json) return forward_error(json);
  return image_encoding_from_json(*json, what);
}

Result<CampaignSource> source_of(const Campaign& campaign, const fs::path& home,
                                 const std::vector<std::string>& allowed) {
  const Result<std::string> text = read_file(campaign.files.config());
  if (!text) return forward_error(text);
  const Result<std::string> file = campaign.store.meta(kConfigFileKey);
  if (!file) return forward_error(file);
  const Result<std::string> overrides_text = campaign.store.meta(kOverridesKey);
  if (!overrides_text) return forward_error(overrides_text);
  const std::string what = campaign.files.store().string();
  const Result<Json> overrides = parse_json(*overrides_text, what);
  if (!overrides) return forward_error(overrides);
  CampaignSource source{*text, *file, {}, home};
  for (const Json& change : *overrides) {
    const auto path = json_field<std::string>(change, "path", what);
    if (!path) return forward_error(path);
    const auto value = json_field<std::string>(change, "value", what);
    if (!value) return forward_error(value);
    source.overrides.push_back({*path, *value});
  }
  const Result<std::string> folders = campaign.store.meta(kAllowedKey);
  if (!folders) return forward_error(folders);
  const Result<Json> remembered = parse_json(*folders, what);
  if (!remembered) return forward_error(remembered);
  for (const Json& folder : *remembered) {
    if (folder.is_string()) source.allowed.add(folder.get<std::string>());
  }
  for (const std::string& folder : allowed) source.allowed.add(folder);
  const Result<bool> grows = has_own_graphs(campaign);
  if (!grows) return forward_error(grows);
  std::error_code ignored;
  if (*grows) source.graphs = fs::absolute(campaign.files.graphs(), ignored);
  return source;
}

Result<bool> has_own_graphs(const Campaign& campaign) {
  const Result<std::string> grows = campaign.store.meta(kGrowsKey);
  if (!grows) return forward_error(grows);
  return !grows->empty();
}

namespace {

/// What was chosen when the campaign was submitted, of frames whose config wants it chosen.
Status take_choices(const Campaign& campaign, PreparedCampaign& prepared) {
  if (!prepared.settings.quality) return {};
  const std::string what = campaign.files.store().string();
  const Result<std::string> text = campaign.store.meta(kChoicesKey);
  if (!text) return forward_error(text);
  if (text->empty()) {
    return fail(ErrorKind::kCorrupt, "{} does not know what its frames are rendered with", what);
  }
  const Result<Json> json = parse_json(*text, what);
  if (!json) return forward_error(json);
  Result<RenderChoices> choices = render_choices_from_json(*json, what);
  if (!choices) return forward_error(choices);
  prepared.expander.set_choices(std::make_shared<const RenderChoices>(std::move(*choices)));
  return {};
}

/// What says how many frames there are cannot be set where that follows from the campaign's graphs.
Status check_overrides(const Campaign& campaign, const std::vector<Override>& more) {
  for (const Override& change : more) {
    for (const char* key : {"graphs", "scenes", "frames_per_scene", "sweep"}) {
      if (change.path != key && !change.path.starts_with(std::string(key) + ".")) continue;
      return fail(ErrorKind::kInput,
                  "--set {}: the frames of this campaign are those that 'seedframe stream --keep' "
                  "was asked for, a line each of {}",
                  change.path, campaign.files.graphs().string());
    }
  }
  return {};
}

/// Lines are on the disk before the frames that they are of.
Status check_graphs(const Campaign& campaign, std::int64_t frames, std::int64_t lines) {
  if (lines >= frames) return {};
  return fail(ErrorKind::kCorrupt,
              "{} has {} whole lines, and the campaign has {} frames: it was cut",
              campaign.files.graphs().string(), lines, frames);
}

}  // namespace

Result<PreparedCampaign> prepare_again(const Campaign& campaign, const fs::path& home,
                                       const std::vector<std::string>& allowed,
                                       const std::vector<Override>& more) {
  Result<CampaignSource> source = source_of(campaign, home, allowed);
  if (!source) return forward_error(source);
  const bool grows = !source->graphs.empty();
  const Result<FrameCounts> counts = grows ? campaign.store.counts() : FrameCounts();
  if (!counts) return forward_error(counts);
  if (Status possible = grows ? check_overrides(campaign, more) : Status(); !possible) {
    return forward_error(possible);
  }
  source->overrides.insert(source->overrides.end(), more.begin(), more.end());
  Result<PreparedCampaign> prepared = prepare(std::move(*source));
  if (prepared && grows) {
    const Status whole = check_graphs(campaign, counts->total(), prepared->expander.frame_count());
    if (!whole) return forward_error(whole);
  }
  if (prepared) {
    if (Status taken = take_choices(campaign, *prepared); !taken) return forward_error(taken);
    return prepared;
  }
  return tl::unexpected(
      Error{prepared.error().kind,
            fmt::format("{}\n(the text is that of {}, the campaign's copy)",
                        prepared.error().message, campaign.files.config().string())});
}

Status begin_run(Campaign& campaign) {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return campaign.store.begin_run(unix_time(), host.data(), ::getpid());
}

std::string command_to_reproduce(const fs::path& folder, std::int64_t frame) {
  return fmt::format("seedframe resume {} --frame {} --workers 1", folder.string(), frame);
}

}  // namespace seedframe
