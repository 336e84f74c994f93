// seedframe asset import|list|check: the asset library from the command line.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace seedframe {

/// Adds the subcommand. When it is the one that the user named, on_selected gets what to do: a
/// function that returns the program's exit code.
void add_asset_verb(CLI::App& app, std::function<void(std::function<int()>)> on_selected);

}  // namespace seedframe
