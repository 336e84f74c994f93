#include "live/live_site.h"

#include <charconv>

#include "page/page_text.h"

namespace seedframe {
namespace {

HttpResponse not_found() { return {.status = 404, .body = "There is no such page.\n"}; }

HttpResponse json_response(int status, const Json& json) {
  return {.status = status,
          .type = "application/json",
          .body = json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

HttpResponse failed(const Error& error) {
  const int status = error.kind == ErrorKind::kInput ? 409 : 500;
  return json_response(status, {{"error", error.message}});
}

/// A whole number, and nothing else.
std::optional<std::int64_t> number_in(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size() && number >= 0;
  return whole ? std::optional(number) : std::nullopt;
}

/// What follows the prefix, if the text begins with it.
std::optional<std::string> after(const std::string& text, std::string_view prefix) {
  return text.starts_with(prefix) ? std::optional(text.substr(prefix.size())) : std::nullopt;
}

}  // namespace

Result<std::unique_ptr<LiveSite>> LiveSite::open(const std::vector<std::filesystem::path>& folders,
                                                 const std::filesystem::path& home, Gate gate,
                                                 RunControl& control, const LiveClock& clock) {
  std::unique_ptr<LiveSite> site(new LiveSite(std::move(gate), control));
  for (const std::filesystem::path& folder : folders) {
    Result<LiveCampaign> campaign = LiveCampaign::open(folder, home, clock);
    if (!campaign) return forward_error(campaign);
    auto shown = std::make_unique<Shown>();
    shown->campaign = std::make_unique<LiveCampaign>(std::move(*campaign));
    site->shown_.push_back(std::move(shown));
  }
  return site;
}

HttpResponse LiveSite::answer(const HttpRequest& request) {
  if (auto refusal = gate_.refusal(request)) return hardened(std::move(*refusal));
  return hardened(route(request));
}

HttpResponse LiveSite::route(const HttpRequest& request) {
  const bool posts = request.method == "POST";
  if (request.path == "/" && !posts) {
    if (shown_.size() == 1) return {.status = 303, .body = {}, .headers = {{"Location", "/c/0/"}}};
    return list();
  }
  const auto rest = after(request.path, "/c/");
  const std::size_t slash = rest ? rest->find('/') : std::string::npos;
  if (slash == std::string::npos) return not_found();
  const auto number = number_in(std::string_view(*rest).substr(0, slash));
  if (!number || static_cast<std::size_t>(*number) >= shown_.size()) return not_found();
  return of_campaign(static_cast<std::size_t>(*number), rest->substr(slash + 1), posts);
}

Json LiveSite::others(std::size_t number) const {
  Json links = Json::array();
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    if (i != number) {
      links.push_back({{"name", shown_[i]->campaign->name()}, {"href", fmt::format("/c/{}/", i)}});
    }
  }
  return links;
}

HttpResponse LiveSite::list() {
  std::string items;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    Shown& shown = *shown_[i];
    const std::lock_guard both(shown.mutex);
    const std::lock_guard control(control_mutex_);
    const Result<Json> state = shown.campaign->state(control_);
    const std::string told =
        state ? fmt::format("{} of {} frames{}", state->at("done").get<std::int64_t>(),
                            state->at("frames").get<std::int64_t>(),
                            state->at("at_work").get<bool>() ? ", at work" : "")
              : html_text(state.error().message);
    items += fmt::format("<li><a href=\"/c/{}/\"><bdi>{}</bdi></a>: {}</li>\n", i,
                         html_text(shown.campaign->name()), told);
  }
  return {
      .type = "text/html; charset=utf-8",
      .body =
          "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
          "<meta name=\"color-scheme\" content=\"light dark\">"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src "
          "data:\">"
          "<link rel=\"icon\" "
          "href=\"data:,\"><title>Campaigns</title></head><body><main><h1>Campaigns</h1>\n<ul>\n" +
          items + "</ul></main></body></html>\n"};
}

HttpResponse LiveSite::of_campaign(std::size_t number, const std::string& rest, bool posts) {
  Shown& shown = *shown_[number];
  const std::lock_guard alone(shown.mutex);
  LiveCampaign& campaign = *shown.campaign;
  if (posts) {
    const std::lock_guard control(control_mutex_);
    const auto frame = after(rest, "retry/");
    Status done;
    if (rest == "pause") {
      done = control_.pause(campaign.campaign());
    } else if (rest == "resume") {
      done = control_.resume(campaign.campaign(), std::nullopt);
    } else if (frame && number_in(*frame)) {
      done = control_.resume(campaign.campaign(), number_in(*frame));
    } else {
      return not_found();
    }
    return done ? json_response(202, Json::object()) : failed(done.error());
  }
  if (rest.empty()) {
    Result<std::string> page = campaign.page(others(number));
    if (!page) return failed(page.error());
    return {.type = "text/html; charset=utf-8", .body = std::move(*page)};
  }
  if (rest == "live") {
    const std::lock_guard control(control_mutex_);
    const Result<Json> state = campaign.state(control_);
    return state ? json_response(200, *state) : failed(state.error());
  }
  const auto frame = after(rest, "thumbnail/");
  if (!frame || !number_in(*frame)) return not_found();
  Result<std::string> picture = campaign.thumbnail(*number_in(*frame));
  if (!picture && picture.error().kind == ErrorKind::kInput) return not_found();
  if (!picture) return failed(picture.error());
  return {.type = "image/webp", .body = std::move(*picture)};
}

}  // namespace seedframe
