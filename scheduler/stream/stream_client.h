// One client of a stream: what has come from it in part, and what it has not read yet.
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "stream/shared_arrays.h"
#include "stream/stream_server.h"

namespace seedframe {

class StreamServer::Client {
 public:
  /// Closes both ends when it goes; they may be the same. Until then writing to it does not block.
  Client(int in, int out);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  int in() const { return in_; }
  int out() const { return out_; }

  /// Reads what is there; complete lines. A line that is too long is told as such, once.
  std::vector<std::string> receive();
  /// Writes what fits.
  void flush();
  void say(const std::string& line);

  bool has_ended() const { return ended_; }  ///< nothing more comes from it
  bool is_gone() const { return gone_; }     ///< nobody reads what we say
  bool has_output() const { return !output_.empty(); }

  std::map<std::string, std::shared_ptr<std::atomic<bool>>> open;  ///< by id, as JSON
  std::map<std::string, SharedArrays> unreleased;
  std::chrono::steady_clock::time_point last_said = std::chrono::steady_clock::now();

 private:
  int in_;
  int out_;
  int flags_;  ///< of `out`, as it was: others may have it open, too
  std::string input_;
  std::string output_;
  bool skips_line_ = false;
  bool ended_ = false;
  bool gone_ = false;
};

}  // namespace seedframe
