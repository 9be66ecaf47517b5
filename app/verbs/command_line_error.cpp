#include "app/verbs/command_line_error.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/suggestion.h"

namespace noonmark {
namespace {

bool looks_like_an_option(const std::string& word) { return word.size() > 1 && word.starts_with('-'); }

// The long options of a verb, with their dashes.
std::vector<std::string> options_of(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

}  // namespace

std::string command_line_error(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  const CLI::App& verb = parsed.empty() ? app : *parsed.front();
  const std::string help =
      fmt::format("(noonmark {}--help lists what there is)", parsed.empty() ? "" : verb.get_name() + " ");
  const std::vector<std::string> left = app.remaining(true);
  const bool left_over = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !left.empty();
  // A value that stood behind an unknown option is left over too. Such an option comes before what else is wrong.
  const auto option = std::find_if(left.begin(), left.end(), looks_like_an_option);
  if (option == left.end())
    return left_over ? fmt::format("{} has no use for '{}' {}", verb.get_name(), left.front(), help)
                     : fmt::format("{} {}", error.what(), help);
  const std::string name = option->substr(0, option->find('='));
  const std::vector<std::string> known = options_of(verb);
  const std::vector<std::string_view> names(known.begin(), known.end());
  return fmt::format("{} has no option '{}'{} {}", verb.get_name(), name, did_you_mean(name, names), help);
}

void require_verb(const std::string& name) {
  std::vector<std::string_view> verbs;
  for (const Verb& verb : verb_table()) verbs.emplace_back(verb.name);
  if (std::find(verbs.begin(), verbs.end(), name) == verbs.end())
    throw Error(ErrorKind::usage,
                fmt::format("there is no verb '{}'{} (noonmark --help lists them)", name, did_you_mean(name, verbs)));
}

void refuse_unknown(const std::string& first) {
  if (!first.starts_with('-')) return require_verb(first);
  constexpr std::string_view options[] = {"--help", "--version"};
  if (first == "-h" || std::find(std::begin(options), std::end(options), first) != std::end(options)) return;
  throw Error(ErrorKind::usage, fmt::format("there is no option '{}' before the verb{} (noonmark --help lists them)",
                                            first, did_you_mean(first, options)));
}

void refuse_empty_values(std::span<const std::string> words) {
  for (const std::string& word : words) {
    if (word == "--") return;
    if (word.size() > 3 && word.starts_with("--") && word.find('=') == word.size() - 1)
      throw Error(ErrorKind::usage,
                  fmt::format("{} has no value: nothing stands behind the '='", word.substr(0, word.size() - 1)));
  }
}

}  // namespace noonmark
