// seedframe manual: the man page, and completions for shells, of the program as it is.

#include "manual/manual.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "cli/verb.h"
#include "console/exit_code.h"
#include "console/say.h"
#include "manual/describe_command.h"

namespace seedframe {
namespace {

ManualNotes notes() {
  const auto code = [](ExitCode value) { return std::to_string(value); };
  return {
      SEEDFRAME_VERSION,
      {{code(kExitOk), "done"},
       {code(kExitInternal), "a mistake in Seedframe itself"},
       {code(kExitInput),
        "the config, an argument or the output folder is wrong; nothing was "
        "written"},
       {code(kExitSomeFailed),
        "some frames failed, or some of several export formats are impossible"},
       {code(kExitEnvironment), "Blender, the disk or the system is not as needed"},
       {code(kExitCorrupt), "files are not as Seedframe wrote them"},
       {code(kExitRounding), "compared: labels identical, colours differ by rounding"},
       {code(kExitTolerance), "compared: labels identical, colours within the tolerance"},
       {code(kExitLabels), "compared: labels differ"},
       {code(kExitNotReproducible), "compared: colours beyond the tolerance, or frames missing"},
       {code(kExitInterrupted), "stopped by a signal; 'resume' goes on"}},
      {{"SEEDFRAME_HOME",
        "the folder with blender_scripts/, assets/ and materials/, instead of "
        "the one that the program was installed with"},
       {"SEEDFRAME_CACHE",
        "the folder that notes which frames this machine has rendered, "
        "instead of ~/.cache/seedframe; 'off': none"},
       {"TMPDIR", "where files of a moment go"}},
      {{"results/<name>",
        "where 'submit' puts the campaign of a config, unless -o says another "
        "folder"},
       {"share/seedframe/configs", "configs to begin with"},
       {"share/doc/seedframe", "the documentation; begin with README.md and docs/README.md"}}};
}

int print_manual(CLI::App& app, const std::string& kind) {
  const CommandText program = describe_command(app);
  const std::string text = kind == "bash"   ? bash_completion(program)
                           : kind == "zsh"  ? zsh_completion(program)
                           : kind == "fish" ? fish_completion(program)
                                            : man_page(program, notes());
  say("{}", text);
  return kExitOk;
}

}  // namespace

void add_manual_verb(CLI::App& app, const OnSelected& on_selected) {
  auto kind = std::make_shared<std::string>();
  CLI::App* verb =
      app.add_subcommand("manual", "print the man page, or completions for bash, zsh or fish");
  verb->add_option("KIND", *kind, "what to print")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish", "man"}));
  verb->footer(
      "Example: seedframe manual bash > ~/.local/share/bash-completion/completions/seedframe");
  verb->callback([kind, &app, on_selected] {
    on_selected([kind, &app] { return print_manual(app, *kind); });
  });
}

}  // namespace seedframe
