#include "scene/offered_assets.h"

#include <map>

namespace seedframe {
namespace {

/// Names of the assets of an object, and of all in it, with the categories that each may have.
using Offers = std::map<std::string, std::set<std::string>>;

Status add_offers(const CompiledObject& object, const AssetLibrary& assets,
                  const std::vector<std::string>& categories, Offers& offers) {
  for (const CompiledObject& child : object.objects) {
    if (Status added = add_offers(child, assets, categories, offers); !added) return added;
  }
  if (!object.asset) return {};
  for (const std::string& name : object.asset->possible_values().value_or(assets.names())) {
    std::set<std::string>& offered = offers[name];
    if (object.category) {
      const auto possible = object.category->possible_values().value_or(categories);
      offered.insert(possible.begin(), possible.end());
      continue;
    }
    if (!object.category_of_asset.empty()) {
      const auto found = object.category_of_asset.find(name);
      if (found != object.category_of_asset.end()) offered.insert(found->second.name);
      continue;
    }
    const auto asset = assets.load(name);
    if (!asset) return forward_error(asset);
    offered.insert((*asset)->category);
  }
  return {};
}

}  // namespace

Result<std::vector<OfferedAsset>> offered_assets(const std::vector<CompiledObject>& objects,
                                                 const AssetLibrary& assets,
                                                 const std::vector<std::string>& categories) {
  Offers offers;
  for (const CompiledObject& object : objects) {
    const Status added = add_offers(object, assets, categories, offers);
    if (!added) return forward_error(added);
  }
  std::vector<OfferedAsset> offered;
  offered.reserve(offers.size());
  for (auto& [name, names] : offers) {
    const auto asset = assets.load(name);
    if (!asset) return forward_error(asset);
    OfferedAsset offer{*asset, {}};
    for (const std::string& category : categories) {
      if (names.count(category) > 0) offer.categories.insert(category);
    }
    offered.push_back(std::move(offer));
  }
  return offered;
}

}  // namespace seedframe
