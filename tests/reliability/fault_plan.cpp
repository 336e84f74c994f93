#include "fault_plan.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

namespace faulty_io {

Plan g_plan;
bool g_active = false;

namespace {

[[noreturn]] void give_up(const char* what, const char* value) {
  std::fprintf(stderr, "faulty_io: %s '%s' is not known\n", what, value);
  _exit(125);
}

unsigned parse_calls(char* names) {
  unsigned calls = 0;
  char* rest = nullptr;
  for (char* name = strtok_r(names, ",", &rest); name != nullptr;
       name = strtok_r(nullptr, ",", &rest)) {
    unsigned index = 0;
    while (index < static_cast<unsigned>(Call::kCount) && strcmp(name, kCallNames[index]) != 0) {
      ++index;
    }
    if (index == static_cast<unsigned>(Call::kCount)) give_up("call", name);
    calls |= 1u << index;
  }
  return calls;
}

void parse_action(const char* name) {
  struct Named {
    const char* name;
    Action action;
    int error;
  };
  constexpr Named kActions[] = {{"kill", Action::kKill, 0},
                                {"kill-after", Action::kKillAfter, 0},
                                {"kill-within", Action::kKillWithin, 0},
                                {"short-write", Action::kShortWrite, 0},
                                {"ENOSPC", Action::kFail, ENOSPC},
                                {"EIO", Action::kFail, EIO},
                                {"EROFS", Action::kFail, EROFS},
                                {"EMFILE", Action::kFail, EMFILE},
                                {"EDQUOT", Action::kFail, EDQUOT}};
  for (const Named& each : kActions) {
    if (strcmp(name, each.name) != 0) continue;
    g_plan.action = each.action;
    g_plan.error = each.error;
    return;
  }
  give_up("action", name);
}

void set(const char* key, char* value) {
  const auto copy = [&](char(&to)[PATH_MAX]) { std::snprintf(to, sizeof to, "%s", value); };
  if (strcmp(key, "under") == 0) return copy(g_plan.under);
  if (strcmp(key, "log") == 0) return copy(g_plan.log);
  if (strcmp(key, "until-file") == 0) return copy(g_plan.until_file);
  if (strcmp(key, "tell-file") == 0) return copy(g_plan.tell_file);
  if (strcmp(key, "do") == 0) return parse_action(value);
  if (strcmp(key, "at") == 0) {
    g_plan.at = std::atol(value);
  } else if (strcmp(key, "times") == 0) {
    g_plan.times = std::atol(value);
  } else if (strcmp(key, "calls") == 0) {
    g_plan.calls = parse_calls(value);
  } else {
    give_up("key", key);
  }
}

[[gnu::constructor]] void read_plan() {
  const char* text = getenv("FAULTY_IO");
  if (text == nullptr) return;
  static char copy[4 * PATH_MAX];
  std::snprintf(copy, sizeof copy, "%s", text);
  unsetenv("FAULTY_IO");
  unsetenv("LD_PRELOAD");
  char* rest = nullptr;
  for (char* entry = strtok_r(copy, ";", &rest); entry != nullptr;
       entry = strtok_r(nullptr, ";", &rest)) {
    char* equals = strchr(entry, '=');
    if (equals == nullptr) give_up("entry", entry);
    *equals = '\0';
    set(entry, equals + 1);
  }
  g_active = true;
}

}  // namespace
}  // namespace faulty_io
