// The lines of `seedframe stream`: of one client by stdin and stdout, or of several by a socket.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/prepared_campaign.h"
#include "stream/frame_maker.h"
#include "stream/request.h"
#include "stream/shared_arrays.h"

namespace seedframe {

struct StreamOptions {
  Fidelity fidelity = Fidelity::kLabels;  ///< of requests that do not say
  int most_open = 64;                     ///< requests of a client that are not answered
  int most_unreleased = 256;              ///< answers of a client whose arrays it still has
  double heartbeat_s = 10.0;              ///< to clients to whom nothing else was said; 0: none
  std::filesystem::path socket;           ///< to be made; empty: stdin and stdout
  std::optional<std::int64_t> kept;       ///< frames that are there already; none: nothing is kept
};

class StreamServer {
 public:
  /// Both must outlive it.
  StreamServer(const PreparedCampaign& prepared, const StreamOptions& options);
  ~StreamServer();
  StreamServer(const StreamServer&) = delete;
  StreamServer& operator=(const StreamServer&) = delete;

  /// Returns when stdin has ended and everything is answered, when nobody reads the answers, or
  /// after stop(). What `maker` still makes then is told to nobody; it has to end before this does.
  /// kInput: the socket cannot be made.
  Status run(FrameMaker& maker);

  /// What is under way is answered, what waits is cancelled. Async-signal-safe.
  void stop();

 private:
  class Client;
  /// From the threads of the maker to the one of run().
  struct Answer {
    std::weak_ptr<Client> client;
    std::string id;  ///< as JSON
    std::string line;
    SharedArrays arrays;
  };

  Status listen();
  void accept();
  void take_answers();
  void take_lines(const std::shared_ptr<Client>& client);
  void take_line(const std::shared_ptr<Client>& client, const std::string& line);
  void order(const std::shared_ptr<Client>& client, FrameRequest request);
  /// Why it is not made; empty if it is.
  std::string refusal(const Client& client, const FrameRequest& request) const;
  void beat();
  void remove_gone();
  bool is_over() const;
  std::string ready_line() const;
  void post(Answer answer);

  const PreparedCampaign& prepared_;
  const StreamOptions& options_;
  FrameMaker* maker_ = nullptr;  ///< while it runs
  int wake_ = -1;
  int listener_ = -1;
  bool stopping_ = false;
  std::vector<std::shared_ptr<Client>> clients_;
  std::mutex mutex_;  ///< guards answers_
  std::vector<Answer> answers_;
};

}  // namespace seedframe
