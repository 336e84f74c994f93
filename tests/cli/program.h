// Starts the seedframe program and its scheduler's worst enemies.
#pragma once

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/canonical_json.h"
#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {

struct Outcome {
  int exit_code = -1;  ///< 128 + signal if it was killed
  std::string output;
  std::string errors;
};

/// The fake Blender brings no colour config of its own.
inline const std::string kOcioConfig = "/usr/share/blender/datafiles/colormanagement/config.ocio";
inline const std::string kFakeBlender = SEEDFRAME_HOME "/tests/fake_blender/fake_blender.py";

/// A test with a folder of its own, which is the program's working directory.
class ProgramTest : public ::testing::Test {
 protected:
  /// Starts the program; `environment` are lines NAME=value.
  pid_t start(const std::vector<std::string>& arguments,
              const std::vector<std::string>& environment = {}) {
    const pid_t pid = ::fork();
    if (pid != 0) return pid;
    if (::chdir(folder_.c_str()) != 0) ::_exit(126);
    ::setenv("SEEDFRAME_CACHE", "off", 1);        // so that what is rendered is rendered
    ::setenv("SEEDFRAME_BLENDER", "blender", 0);  // not what the checkout has, unless asked for
    for (const std::string& entry : environment) ::putenv(const_cast<char*>(entry.c_str()));
    if (std::freopen("out.txt", "w", stdout) == nullptr) ::_exit(126);
    if (std::freopen("err.txt", "w", stderr) == nullptr) ::_exit(126);
    std::vector<char*> argv = {const_cast<char*>(SEEDFRAME_PROGRAM)};
    for (const std::string& argument : arguments) {
      argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    ::execv(SEEDFRAME_PROGRAM, argv.data());
    ::_exit(127);
  }

  Outcome wait(pid_t pid) {
    int status = 0;
    ::waitpid(pid, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return {code, *read_file(folder_ / "out.txt"), *read_file(folder_ / "err.txt")};
  }

  Outcome run(const std::vector<std::string>& arguments,
              const std::vector<std::string>& environment = {}) {
    return wait(start(arguments, environment));
  }

  /// Of a script in tests/export, which says everything in its output.
  Outcome python(const std::string& script_and_arguments) const {
    const std::string log = (folder_ / "python.txt").string();
    const std::string command = std::string("PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 ") +
                                SEEDFRAME_HOME + "/tests/export/" + script_and_arguments + " >" +
                                log + " 2>&1";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), *read_file(log), {}};
  }

  void write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(write_file(folder_ / name, text));
  }

  /// A config, and the colour config that the fake Blender needs.
  void write_config(const std::string& name, const std::string& text) {
    write(name, text + "image: {ocio_config: " + kOcioConfig + "}\n");
  }

  /// The built-in asset `original` as own/part, which configs know as `part`.
  void make_part(const std::string& original) {
    const std::filesystem::path part = folder_ / "own/part";
    std::filesystem::remove_all(part);
    std::filesystem::create_directories(folder_ / "own");
    std::filesystem::copy(SEEDFRAME_HOME "/assets/" + original, part,
                          std::filesystem::copy_options::recursive);
    std::string json = *read_file(part / "asset.json");
    const std::string name = "\"name\": \"" + original + "\"";
    json.replace(json.find(name), name.size(), R"("name": "part")");
    write("own/part/asset.json", json);
  }

  Json status(const std::string& campaign) {
    const Outcome outcome = run({"status", campaign, "--json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    const auto json = parse_json(outcome.output, "status");
    return json ? *json : Json::object();
  }

  /// Runs a statement of SQL on a campaign's job store.
  void change_store(const std::string& campaign, const std::string& statement) const {
    const std::string command = "/usr/bin/python3 -c \"import sqlite3; c = sqlite3.connect('" +
                                (folder_ / campaign / "campaign.sqlite").string() +
                                "'); c.execute('''" + statement + "'''); c.commit()\"";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
  }

  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  /// Every file below a folder by its path, with its bytes.
  std::map<std::string, std::string> contents(const std::string& name) const {
    std::map<std::string, std::string> files;
    const std::filesystem::path root = folder_ / name;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
      if (!entry.is_regular_file()) continue;
      files[std::filesystem::relative(entry.path(), root).string()] = *read_file(entry.path());
    }
    return files;
  }

  const ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_.path();  ///< the working directory
};

}  // namespace seedframe
