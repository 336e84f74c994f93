#include "stream/request.h"

#include <array>
#include <limits>
#include <vector>

#include "base/nearest_name.h"

namespace seedframe {
namespace {

constexpr std::array<const char*, 3> kFidelityNames = {"labels", "preview", "render"};
const std::vector<std::string>& known_keys() {
  static const std::vector<std::string> keys = {
      "id", "values", "scene", "fidelity", "samples", "denoise", "crop", "deadline_s", "want"};
  return keys;
}

template <class... Args>
tl::unexpected<Error> wrong(fmt::format_string<Args...> format, Args&&... args) {
  return fail(ErrorKind::kInput, format, std::forward<Args>(args)...);
}

Result<Json> parsed(std::string_view line) {
  Result<Json> json = parse_json(line, "a request");
  if (!json) return wrong("{}", json.error().message);
  if (json->is_object()) return json;
  return wrong("a request is a JSON object, such as {{\"id\": 1, \"values\": {{\"yaw\": 90}}}}");
}

Status take_fidelity(const Json& value, FrameRequest& request) {
  for (std::size_t i = 0; i < kFidelityNames.size(); ++i) {
    if (value == kFidelityNames[i]) {
      request.fidelity = static_cast<Fidelity>(i);
      return {};
    }
  }
  return wrong("fidelity: expected labels, preview or render, found {}",
               value.dump().substr(0, 60));
}

Status take_want(const Json& value, FrameRequest& request) {
  request.labels = false;
  if (!value.is_array()) return wrong("want: expected a list of labels, image, ids, depth");
  for (const Json& each : value) {
    if (each == "labels") {
      request.labels = true;
    } else if (each == "image") {
      request.image = true;
    } else if (each == "ids") {
      request.ids = true;
    } else if (each == "depth") {
      request.depth = request.rendering.depth = true;
    } else {
      return wrong("want: there are labels, image, ids and depth, found {}",
                   each.dump().substr(0, 60));
    }
  }
  return {};
}

Status take(const std::string& key, const Json& value, FrameRequest& request) {
  if (key == "id") {
    request.id = value;
    return {};
  }
  if (key == "values") {
    request.values = value;
    return {};
  }
  if (key == "fidelity") return take_fidelity(value, request);
  if (key == "want") return take_want(value, request);
  if (key == "scene") {
    const auto scene = integer_in<std::uint32_t>(value);
    if (!scene || *scene == std::numeric_limits<std::uint32_t>::max()) {
      return wrong("scene: expected a whole number from 0 to 4294967294");
    }
    request.scene = *scene;
    return {};
  }
  if (key == "deadline_s") {
    if (!value.is_number() || !(value.get<double>() > 0.0)) {
      return wrong("deadline_s: expected seconds, more than 0");
    }
    request.deadline_s = value.get<double>();
    return {};
  }
  const Result<bool> taken = key == "depth" ? Result<bool>(false)  // that is wanted, not said here
                                            : take_rendering_wish(key, value, request.rendering);
  if (!taken) return forward_error(taken);
  if (*taken) return {};
  return wrong("unknown key '{}'{}", key, did_you_mean(key, known_keys()));
}

Status check(const FrameRequest& request) {
  if (request.id.is_null()) {
    return wrong("a request needs an id, a text or a whole number, by which it is answered");
  }
  if (request.image && request.fidelity == Fidelity::kLabels) {
    return wrong("fidelity labels has no image: ask for preview or render");
  }
  const bool renders = request.fidelity == Fidelity::kRender;
  const RenderingWish& rendering = request.rendering;
  if (!renders && rendering.samples) return wrong("samples: only fidelity render has any");
  if (!renders && rendering.denoise) return wrong("denoise: only fidelity render has noise");
  if (!renders && rendering.crop) return wrong("crop: only fidelity render saves anything by it");
  return {};
}

bool is_id(const Json& id) { return id.is_string() || id.is_number_integer(); }

}  // namespace

const char* to_string(Fidelity fidelity) {
  return kFidelityNames[static_cast<std::size_t>(fidelity)];
}

Json id_of_line(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return {};
  const auto id = json.find("id");
  return id != json.end() && is_id(*id) ? *id : Json();
}

Result<StreamRequest> read_stream_request(std::string_view line, Fidelity usual) {
  const Result<Json> json = parsed(line);
  if (!json) return forward_error(json);
  for (const char* other : {"cancel", "release"}) {
    const auto found = json->find(other);
    if (found == json->end()) continue;
    if (json->size() > 1 || !is_id(*found)) {
      return wrong("{}: expected nothing else in the line, and the id of a request", other);
    }
    if (other == std::string_view("cancel")) return CancelRequest{*found};
    return ReleaseRequest{*found};
  }
  FrameRequest request;
  request.fidelity = usual;
  for (const auto& [key, value] : json->items()) {
    if (Status taken = take(key, value, request); !taken) return forward_error(taken);
  }
  if (!request.id.is_null() && !is_id(request.id)) {
    return wrong("id: expected a text or a whole number");
  }
  if (Status good = check(request); !good) return forward_error(good);
  return request;
}

}  // namespace seedframe
