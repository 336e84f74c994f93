#include "stream/stream_server.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/clock.h"
#include "report/variable_description.h"
#include "stream/stream_client.h"

namespace seedframe {
namespace {

constexpr int kStreamProtocol = 1;
constexpr std::uint64_t kStop = 1ULL << 32U;  // in the counter that wakes: more than answers add

const char* name_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInput:
      return "input";
    case ErrorKind::kEnvironment:
    case ErrorKind::kExhausted:
      return "environment";
    case ErrorKind::kCorrupt:
      return "corrupt";
    case ErrorKind::kRender:
      break;
  }
  return "render";
}

std::string error_line(const Json& id, const Error& error) {
  return Json{{"id", id}, {"error", {{"kind", name_of(error.kind)}, {"message", error.message}}}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <class T>
Status add(SharedArrays& arrays, const char* name, const std::optional<Image<T>>& image,
           const char* dtype) {
  if (!image) return {};
  std::vector<int> shape = {image->height, image->width};
  if (image->channels > 1) shape.push_back(image->channels);
  return arrays.add(name, image->values.data(), image->values.size() * sizeof(T), dtype, shape);
}

Result<std::string> answer_line(const Json& id, const FrameRequest& request, const MadeFrame& made,
                                double waited_s, SharedArrays& arrays) {
  Status added = add(arrays, "image", made.image, "uint8");
  if (added) added = add(arrays, "ids", made.ids, "uint16");
  if (added) added = add(arrays, "depth", made.depth, "float32");
  if (!added) return forward_error(added);
  Json answer = {{"id", id},
                 {"frame_id", made.frame_id},
                 {"fidelity", to_string(request.fidelity)},
                 {"width", made.width},
                 {"height", made.height},
                 {"pixel_hashes", made.pixel_hashes},
                 {"seconds",
                  {{"waited", std::max(0.0, waited_s - made.made_s)},
                   {"made", made.made_s},
                   {"worker", made.worker_s}}}};
  if (made.kept) answer["kept"] = *made.kept;
  if (!arrays.empty()) answer["arrays"] = arrays.to_json();
  std::string line = answer.dump();
  if (made.labels) {
    line.back() = ',';
    line += "\"labels\":" + canonical_text(*made.labels) + "}";
  }
  return line;
}

}  // namespace

StreamServer::StreamServer(const PreparedCampaign& prepared, const StreamOptions& options)
    : prepared_(prepared), options_(options), wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

StreamServer::~StreamServer() {
  if (listener_ >= 0) {
    ::close(listener_);
    ::unlink(options_.socket.c_str());
  }
  ::close(wake_);
}

void StreamServer::stop() {
  const std::uint64_t stop = kStop;
  if (::write(wake_, &stop, sizeof stop) < 0) return;
}

Status StreamServer::listen() {
  const std::string path = options_.socket.string();
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    return fail(ErrorKind::kInput, "--socket {}: a socket's path has at most {} bytes", path,
                sizeof address.sun_path - 1);
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  if (::connect(listener_, generic, sizeof address) == 0) {
    ::close(std::exchange(listener_, -1));
    return fail(ErrorKind::kInput, "--socket {}: another program listens there", path);
  }
  // What a stream has left that was killed; nothing that is no socket.
  std::error_code error;
  if (std::filesystem::is_socket(path, error)) ::unlink(path.c_str());
  const mode_t before = ::umask(0077);  // for this user alone
  const int bound = ::bind(listener_, generic, sizeof address);
  const int why = errno;
  ::umask(before);
  if (bound == 0 && ::listen(listener_, 16) == 0) return {};
  ::close(std::exchange(listener_, -1));
  return fail(ErrorKind::kInput, "--socket {}: cannot listen there: {}", path, std::strerror(why));
}

void StreamServer::accept() {
  while (true) {
    const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (client < 0) return;
    clients_.push_back(std::make_shared<Client>(client, client));
    clients_.back()->say(ready_line());
  }
}

Status StreamServer::run(FrameMaker& maker) {
  maker_ = &maker;
  if (!options_.socket.empty()) {
    if (Status listens = listen(); !listens) return listens;
  } else {
    clients_.push_back(std::make_shared<Client>(STDIN_FILENO, STDOUT_FILENO));
    clients_.back()->say(ready_line());
  }
  while (!is_over()) {
    std::vector<pollfd> waiting = {{wake_, POLLIN, 0}};
    if (listener_ >= 0 && !stopping_) waiting.push_back({listener_, POLLIN, 0});
    const std::size_t first = waiting.size();
    for (const auto& client : clients_) {
      // Who has much to be answered or has not read its answers waits before we read on.
      const bool reads = !stopping_ && !client->has_ended() && !client->has_output() &&
                         static_cast<int>(client->open.size()) < options_.most_open;
      waiting.push_back({reads ? client->in() : -1, POLLIN, 0});
      waiting.push_back({client->has_output() ? client->out() : -1, POLLOUT, 0});
    }
    const int longest =
        options_.heartbeat_s > 0.0 ? static_cast<int>(options_.heartbeat_s * 500.0) + 1 : -1;
    ::poll(waiting.data(), waiting.size(), longest);
    std::uint64_t woken = 0;
    if (::read(wake_, &woken, sizeof woken) > 0 && woken >= kStop) {
      stopping_ = true;
      for (const auto& client : clients_) {
        for (const auto& [id, cancelled] : client->open) *cancelled = true;
      }
    }
    const std::vector<std::shared_ptr<Client>> known = clients_;
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (waiting[first + 2 * i].revents != 0) take_lines(known[i]);
      if (waiting[first + 2 * i + 1].revents != 0) known[i]->flush();
    }
    if (listener_ >= 0) accept();
    take_answers();
    beat();
    remove_gone();
  }
  return {};
}

bool StreamServer::is_over() const {
  const bool answered =
      std::all_of(clients_.begin(), clients_.end(), [](const std::shared_ptr<Client>& client) {
        return client->is_gone() || (client->open.empty() && !client->has_output());
      });
  if (stopping_) return answered;
  return listener_ < 0 && answered && (clients_.empty() || clients_.front()->has_ended());
}

void StreamServer::take_lines(const std::shared_ptr<Client>& client) {
  for (const std::string& line : client->receive()) take_line(client, line);
}

void StreamServer::take_line(const std::shared_ptr<Client>& client, const std::string& line) {
  if (line.find_first_not_of(" \t\r") == std::string::npos) return;
  Result<StreamRequest> request = read_stream_request(line, options_.fidelity);
  if (!request) return client->say(error_line(id_of_line(line), request.error()));
  if (const auto* cancel = std::get_if<CancelRequest>(&*request)) {
    const auto found = client->open.find(cancel->id.dump());
    if (found != client->open.end()) *found->second = true;  // of what is answered, nothing
    return;
  }
  if (const auto* release = std::get_if<ReleaseRequest>(&*request)) {
    client->unreleased.erase(release->id.dump());
    return;
  }
  order(client, std::get<FrameRequest>(std::move(*request)));
}

void StreamServer::order(const std::shared_ptr<Client>& client, FrameRequest request) {
  const std::string id = request.id.dump();
  if (const std::string refused = refusal(*client, request); !refused.empty()) {
    return client->say(error_line(request.id, {ErrorKind::kInput, refused}));
  }
  FrameOrder order;
  order.request = std::move(request);
  order.done = [this, weak = std::weak_ptr<Client>(client), id, asked = order.request,
                came = order.came](const Result<MadeFrame>& made) {
    Answer answer{weak, id, {}, {}};
    const double waited_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - came).count();
    Result<std::string> line =
        made ? answer_line(asked.id, asked, *made, waited_s, answer.arrays) : forward_error(made);
    answer.line = line ? std::move(*line) : error_line(asked.id, line.error());
    post(std::move(answer));
  };
  client->open[id] = order.cancelled;
  maker_->make(std::move(order));
}

std::string StreamServer::refusal(const Client& client, const FrameRequest& request) const {
  const std::string id = request.id.dump();
  if (client.open.contains(id) || client.unreleased.contains(id)) {
    return "this id is another request's that is not answered or released yet";
  }
  if (request.has_arrays() &&
      static_cast<int>(client.unreleased.size()) >= options_.most_unreleased) {
    return fmt::format(
        "the arrays of {} answers are not released: open and map them, and send {{\"release\": "
        "id}}",
        client.unreleased.size());
  }
  return {};
}

void StreamServer::post(Answer answer) {
  {
    const std::lock_guard lock(mutex_);
    answers_.push_back(std::move(answer));
  }
  const std::uint64_t one = 1;
  if (::write(wake_, &one, sizeof one) < 0) return;
}

void StreamServer::take_answers() {
  std::vector<Answer> answers;
  {
    const std::lock_guard lock(mutex_);
    answers.swap(answers_);
  }
  for (Answer& answer : answers) {
    const std::shared_ptr<Client> client = answer.client.lock();
    if (client == nullptr) continue;
    client->open.erase(answer.id);
    if (!answer.arrays.empty()) client->unreleased[answer.id] = std::move(answer.arrays);
    client->say(answer.line);
  }
}

void StreamServer::beat() {
  if (options_.heartbeat_s <= 0.0) return;
  const auto now = std::chrono::steady_clock::now();
  for (const auto& client : clients_) {
    if (client->has_output()) continue;
    if (std::chrono::duration<double>(now - client->last_said).count() < options_.heartbeat_s) {
      continue;
    }
    client->say(Json{{"alive", {{"open", client->open.size()}, {"time", unix_time()}}}}.dump());
  }
}

void StreamServer::remove_gone() {
  if (options_.socket.empty()) return;  // the only one ends the stream
  std::erase_if(clients_, [](const std::shared_ptr<Client>& client) {
    // Who has sent its last line may still wait for answers, until it closes its end.
    return client->is_gone() ||
           (client->has_ended() && client->open.empty() && !client->has_output());
  });
}

std::string StreamServer::ready_line() const {
  const Result<Json> variables = describe_variables(prepared_.expander);
  const CampaignSettings& settings = prepared_.settings;
  return Json{{"ready",
               {{"protocol", kStreamProtocol},
                {"seedframe", SEEDFRAME_VERSION},
                {"process", ::getpid()},
                {"name", settings.name},
                {"seed", settings.seed},
                {"width", settings.render.width},
                {"height", settings.render.height},
                {"categories", settings.categories},
                {"most_open", options_.most_open},
                {"kept", options_.kept ? Json(*options_.kept) : Json()},
                {"variables", variables ? *variables : Json()}}}}
      .dump();
}

}  // namespace seedframe
