#include "manual/describe_command.h"

#include <algorithm>

#include <CLI/CLI.hpp>

namespace seedframe {
namespace {

constexpr const char* kOffers = "offers";

std::vector<std::string> words_of(const std::string& list, char separator) {
  std::vector<std::string> words;
  for (std::size_t start = 0; start < list.size();) {
    const std::size_t end = std::min(list.find(separator, start), list.size());
    words.push_back(list.substr(start, end - start));
    start = end + 1;
  }
  return words;
}

/// Of `offers`, or of "TEXT:{exact,simplified}", which is how CLI::IsMember shows itself.
std::vector<std::string> offered_words(CLI::Option& option) {
  try {
    CLI::Validator& offered = *option.get_validator(kOffers);
    offered.active(true);  // an inactive one does not say its description
    const std::string list = offered.get_description();
    offered.active(false);
    return words_of(list, ',');
  } catch (const CLI::OptionNotFound&) {
  }
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  const std::size_t close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return words_of(type.substr(open + 1, close - open - 1), ',');
}

Offer offer_for(const OptionText& text) {
  if (!text.words.empty()) return Offer::kWords;
  if (text.value == "DIR") return Offer::kFolders;
  if (text.value == "FILE") return Offer::kFiles;
  if (text.value == "CONFIG") return Offer::kConfigs;
  return Offer::kNothing;
}

OptionText describe_option(CLI::Option& option) {
  OptionText text;
  for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  text.help = option.get_description();
  text.default_value = option.get_default_str();
  text.required = option.get_required();
  if (option.get_items_expected_max() == 0) return text;
  text.repeated = option.get_items_expected_max() > 1;
  text.words = offered_words(option);
  const std::string type = option.get_type_name();
  // CLI::ExistingDirectory shows itself as "TEXT:DIR", a range as "INT in [1 - 9]".
  const bool folder = type == "DIR" || type.ends_with(":DIR");
  text.value = folder                    ? "DIR"
               : option.get_positional() ? option.get_name()
                                         : type.substr(0, type.find_first_of(": "));
  text.offer = offer_for(text);
  if (option.get_positional()) text.value = option.get_name();
  return text;
}

std::string example_in(const std::string& footer) {
  constexpr std::string_view kMark = "Example: ";
  return footer.starts_with(kMark) ? footer.substr(kMark.size()) : std::string();
}

CommandText describe(CLI::App& app, std::vector<std::string> path) {
  CommandText text;
  path.push_back(app.get_name());
  text.path = path;
  text.help = app.get_description();
  text.example = example_in(app.get_footer());
  const std::function<bool(CLI::Option*)> all_options;
  for (CLI::Option* option : app.get_options(all_options)) {
    OptionText described = describe_option(*option);
    (described.names.empty() ? text.arguments : text.options).push_back(std::move(described));
  }
  const std::function<bool(CLI::App*)> all_verbs;
  for (CLI::App* verb : app.get_subcommands(all_verbs)) {
    text.verbs.push_back(describe(*verb, path));
  }
  return text;
}

}  // namespace

CommandText describe_command(CLI::App& app) { return describe(app, {}); }

CLI::Validator offers(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ",") + word;
  CLI::Validator validator([](std::string&) { return std::string(); }, list, kOffers);
  validator.active(false);
  return validator;
}

}  // namespace seedframe
