// The command line: finds the verb, and says what was meant when there is no such verb or option.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/nearest_name.h"
#include "cli/verb.h"
#include "console/exit_code.h"
#include "console/home.h"

namespace {

using seedframe::did_you_mean;

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands(nullptr)) names.push_back(verb->get_name());
  return names;
}

/// The verb that the arguments select, as deep as they go ("asset list").
const CLI::App& selected_verb(const CLI::App& app) {
  const auto selected = app.get_subcommands();
  return selected.empty() ? app : selected_verb(*selected.front());
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

int report_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& verb = selected_verb(app);
  std::string message = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::vector<std::string> extras = app.remaining(true);
    const std::string first = extras.empty() ? std::string() : extras.front();
    const bool is_option = first.starts_with("-");
    message = fmt::format("unknown {} '{}'{}", is_option ? "option" : "argument", first,
                          is_option ? did_you_mean(first, option_names(verb)) : "");
  }
  std::string name;
  for (const CLI::App* level = &verb; level != nullptr; level = level->get_parent()) {
    name.insert(0, level->get_name() + (name.empty() ? "" : " "));
  }
  const int code = seedframe::report(message, seedframe::kExitInput);
  std::fprintf(stderr, "seedframe: '%s --help' lists what there is\n", name.c_str());
  return code;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Seedframe turns a scene description and one seed into a labelled image dataset,\n"
      "and can prove it would do so again.",
      "seedframe");
  app.set_version_flag("--version", std::string("seedframe ") + SEEDFRAME_VERSION);
  app.require_subcommand(1);
  std::function<int()> action;
  const seedframe::OnSelected on_selected = [&action](std::function<int()> selected) {
    action = std::move(selected);
  };
  const seedframe::OnSelected with_home = [&on_selected](std::function<int()> selected) {
    on_selected([selected = std::move(selected)] {
      const auto home = seedframe::find_home();
      return home ? selected() : seedframe::report(home.error());
    });
  };
  seedframe::add_submit_verb(app, with_home);
  seedframe::add_resume_verb(app, with_home);
  seedframe::add_status_verb(app, on_selected);
  seedframe::add_explain_verb(app, with_home);
  seedframe::add_report_verb(app, with_home);
  seedframe::add_serve_verb(app, with_home);
  seedframe::add_render_verb(app, with_home);
  seedframe::add_preview_verb(app, with_home);
  seedframe::add_show_verb(app, with_home);
  seedframe::add_verify_error_verb(app, with_home);
  seedframe::add_export_verb(app, with_home);
  seedframe::add_check_verb(app, with_home);
  seedframe::add_asset_verb(app, on_selected);
  seedframe::add_audit_verb(app, with_home);
  seedframe::add_bench_verb(app, with_home);
  seedframe::add_compare_verb(app, on_selected);
  seedframe::add_doctor_verb(app, on_selected);
  seedframe::add_stream_verb(app, with_home);
  seedframe::add_run_batch_verb(app, with_home);
  seedframe::add_manual_verb(app, on_selected);
  app.footer("Example: seedframe submit configs/parts.yaml");

  const std::string first = argc > 1 ? argv[1] : "";
  if (!first.empty() && !first.starts_with("-")) {
    const std::vector<std::string> verbs = verb_names(app);
    if (std::find(verbs.begin(), verbs.end(), first) == verbs.end()) {
      return seedframe::report(
          fmt::format("there is no verb '{}'{}", first, did_you_mean(first, verbs)),
          seedframe::kExitInput);
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& done) {
    return app.exit(done);
  } catch (const CLI::ParseError& error) {
    if (argc <= 1) {
      std::fputs(app.help().c_str(), stdout);
      return seedframe::kExitInput;
    }
    return report_parse_error(app, error);
  }
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  seedframe::errors_as_json = std::any_of(argv, argv + argc, [](const char* argument) {
    return std::string_view(argument) == "--json";
  });
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return seedframe::report("there is not enough memory for this", seedframe::kExitEnvironment);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "seedframe: internal error: %s\n", error.what());
    return seedframe::kExitInternal;
  }
}
