// seedframe stream with pipes to it.
#pragma once

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/canonical_json.h"

namespace seedframe {

/// Of line.yaml in a folder; the fake Blender does what `fake` says.
class Stream {
 public:
  Stream(const std::filesystem::path& folder, std::vector<std::string> arguments,
         const std::string& fake = "{}") {
    int in[2];
    int out[2];
    if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(out, O_CLOEXEC) != 0) std::abort();
    process_ = ::fork();
    if (process_ == 0) {
      if (::chdir(folder.c_str()) != 0) ::_exit(126);
      ::dup2(in[0], STDIN_FILENO);
      ::dup2(out[1], STDOUT_FILENO);
      if (std::freopen("err.txt", "w", stderr) == nullptr) ::_exit(126);
      ::setenv("TMPDIR", folder.c_str(), 1);
      ::setenv("SEEDFRAME_FAKE", fake.c_str(), 1);
      arguments.insert(arguments.begin(), {SEEDFRAME_PROGRAM, "stream", "line.yaml"});
      std::vector<char*> argv;
      for (std::string& argument : arguments) argv.push_back(argument.data());
      argv.push_back(nullptr);
      ::execv(SEEDFRAME_PROGRAM, argv.data());
      ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    in_ = in[1];
    out_ = out[0];
  }
  ~Stream() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
    close_input();
    ::close(out_);
  }

  void say(const std::string& line, const std::string& end = "\n") const {
    const std::string text = line + end;
    ASSERT_EQ(::write(in_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// The next line that is no sign of life; null at the end.
  Json hear() {
    while (true) {
      const std::size_t end = heard_.find('\n');
      if (end != std::string::npos) {
        Json json = Json::parse(heard_.substr(0, end));
        heard_.erase(0, end + 1);
        if (!json.contains("alive")) return json;
        ++signs_of_life;
        continue;
      }
      char buffer[65536];
      const ssize_t bytes = ::read(out_, buffer, sizeof buffer);
      if (bytes <= 0) return {};
      heard_.append(buffer, static_cast<std::size_t>(bytes));
    }
  }
  void close_input() {
    if (in_ >= 0) ::close(in_);
    in_ = -1;
  }
  void close_output() { ::close(std::exchange(out_, -1)); }
  int wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  pid_t process() const { return process_; }
  int signs_of_life = 0;

 private:
  pid_t process_ = -1;
  int in_ = -1;
  int out_ = -1;
  std::string heard_;
};

}  // namespace seedframe
