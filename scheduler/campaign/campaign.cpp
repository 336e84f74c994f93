#include "campaign/campaign.h"

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr const char* kConfigFileKey = "config_file";  // absolute: the job store is not the dataset
constexpr const char* kOverridesKey = "overrides";

Status write_campaign(const CampaignFiles& files, PreparedCampaign& prepared) {
  for (const fs::path& folder : {files.root(), files.frames(), files.logs(), files.work()}) {
    if (Status made = make_folders(folder); !made) return made;
  }
  if (Status written = write_file_atomically(files.config(), prepared.source.text); !written) {
    return written;
  }
  Result<JobStore> store = JobStore::create(files.store());
  if (!store) return forward_error(store);
  Json overrides = Json::array();
  for (const Override& change : prepared.source.overrides) {
    overrides.push_back({{"path", change.path}, {"value", change.value}});
  }
  std::error_code error;
  const std::string file = fs::absolute(prepared.source.file, error).string();
  if (Status set = store->set_meta(kConfigFileKey, file); !set) return set;
  if (Status set = store->set_meta(kOverridesKey, canonical_json(overrides)); !set) return set;
  std::int64_t next = 0;
  return store->add_frames([&]() -> Result<std::optional<FrameRow>> {
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

}  // namespace

Result<Campaign> create_campaign(const fs::path& folder, PreparedCampaign& prepared) {
  std::error_code error;
  const bool existed = fs::exists(folder, error);
  if (existed && (!fs::is_directory(folder, error) || !fs::is_empty(folder, error))) {
    const bool is_campaign = fs::exists(CampaignFiles(folder).store(), error);
    return fail(ErrorKind::kInput, "{} {}", folder.string(),
                is_campaign ? "holds a campaign already: 'seedframe resume' goes on with it, or "
                              "give another folder with -o"
                            : "is not empty: give another folder with -o");
  }
  const CampaignFiles files(folder);
  if (Status written = write_campaign(files, prepared); !written) {
    if (!existed) fs::remove_all(folder, error);
    // The user chose this place, so it is for the user to mend.
    return tl::unexpected(Error{ErrorKind::kInput, written.error().message});
  }
  return open_campaign(folder);
}

Result<Campaign> open_campaign(const fs::path& folder) {
  const CampaignFiles files(folder);
  Result<JobStore> store = JobStore::open(files.store());
  if (!store) return forward_error(store);
  return Campaign{files, std::move(*store)};
}

Result<CampaignSource> source_of(const Campaign& campaign, const fs::path& home) {
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
  return source;
}

Result<Reconciliation> reconcile(Campaign& campaign, VerifyDepth depth) {
  std::error_code error;
  fs::remove_all(campaign.files.work(), error);
  if (Status reset = campaign.store.reset_running(); !reset) return forward_error(reset);
  Reconciliation result;
  std::vector<std::pair<std::int64_t, Manifest>> adopted;
  std::vector<std::int64_t> invalid;
  const Status visited = campaign.store.for_each_frame([&](const FrameRow& row) -> Status {
    const fs::path folder = campaign.files.frame(row.frame);
    const bool done = row.state == FrameState::kDone;
    const bool there = done || fs::exists(folder, error);
    if (there) {
      // What the store did not see being committed is believed only after reading all of it.
      const auto manifest =
          verify_frame(folder, row.frame_id, done ? depth : VerifyDepth::kContents);
      const bool same = manifest && (!done || manifest->pixel_hash() == row.pixel_hash);
      if (same && done) {
        ++result.already_done;
        return {};
      }
      if (same) {
        adopted.emplace_back(row.frame, *manifest);
        return {};
      }
      if (done) {
        result.invalid.push_back(manifest ? folder.string() + ": its pixel hash is not the store's"
                                          : manifest.error().message);
        invalid.push_back(row.frame);
      }
    }
    result.to_render.push_back({row.frame, row.attempts});
    return {};
  });
  if (!visited) return forward_error(visited);
  for (const auto& [frame, manifest] : adopted) {
    const Status done = campaign.store.adopt(frame, manifest.pixel_hash(), manifest.twin);
    if (!done) return forward_error(done);
  }
  for (const std::int64_t frame : invalid) {
    if (Status done = campaign.store.reset(frame); !done) return forward_error(done);
  }
  result.adopted = static_cast<std::int64_t>(adopted.size());
  return result;
}

}  // namespace seedframe
