#include "app/verbs/command_line_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <vector>

#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "base/suggestion.h"
#include "base/text.h"
#include "technique/settings.h"

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

// Each setting as an option that someone may have typed, with its group and without, and the names of the settings that are
// meant, with '|' between them.
std::map<std::string, std::string> settings_as_options() {
  std::map<std::string, std::string> meant;
  for (const Setting& row : settings_table()) {
    const std::string name(row.name);
    meant["--" + name] = name;
    std::string& last = meant["--" + name.substr(name.rfind('.') + 1)];
    last += (last.empty() ? "" : "|") + name;  // "size" is the last part of several
  }
  return meant;
}

bool takes(std::string_view setting, const std::string& value) {
  Settings any;
  try {
    find_setting(setting).set(any, value);
    return true;
  } catch (const Error&) {
    return false;
  }
}

// "--set map.resolution=512", of the settings that take the value; empty if none does. left: what was not understood, with the
// option at `option`.
std::string as_setting(const std::string& names, const std::vector<std::string>& left,
                       std::vector<std::string>::const_iterator option) {
  std::string value;
  if (const size_t equals = option->find('='); equals != std::string::npos)
    value = option->substr(equals + 1);
  else if (option + 1 != left.end() && !looks_like_an_option(*(option + 1)))
    value = *(option + 1);
  std::string text;
  for (size_t begin = 0; begin <= names.size();) {
    const size_t end = std::min(names.find('|', begin), names.size());
    if (const std::string name = names.substr(begin, end - begin); value.empty() || takes(name, value))
      text += fmt::format("{}'--set {}={}'", text.empty() ? "" : " or ", name,
                          value.empty() ? "VALUE" : shell_quoted(value));
    begin = end + 1;
  }
  return text;
}

// "; it is an option of judge": the verbs, other than this one, that have the option, which may be typed with capital letters.
// Empty if there are none.
std::string verbs_with(const CLI::App& app, const CLI::App& verb, const std::string& typed) {
  const std::string option = CLI::detail::to_lower(typed);
  std::vector<std::string> names;
  for (const CLI::App* other : app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::vector<std::string> options = options_of(*other);
    if (other == &verb || std::find(options.begin(), options.end(), option) == options.end()) continue;
    names.push_back(other->get_name());
  }
  if (names.empty()) return "";
  // What the verb has in place of it.
  const char* const instead = option == "--max" ? ", and a bound of an experiment stands in its [[bound]]" : "";
  return fmt::format("; it is an option of {}{}", fmt::join(names, ", "), instead);
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
  const std::vector<std::string_view> options(known.begin(), known.end());
  std::vector<std::string_view> names = options;
  std::map<std::string, std::string> settings;
  if (std::find(known.begin(), known.end(), "--set") != known.end()) settings = settings_as_options();
  for (const auto& [as_option, setting] : settings)
    names.push_back(as_option);  // of equally near ones an option is meant
  const std::string elsewhere = verbs_with(app, verb, name);
  const auto setting = settings.find(nearest_name(name, names));
  // An option that another verb has is meant as it stands, and not as a setting with a similar name.
  const bool is_meant = setting != settings.end() && (elsewhere.empty() || setting->first == name);
  const bool is_setting = is_meant && std::none_of(options.begin(), options.end(), [&](auto one) {
                            return one == setting->first || one.starts_with(name);
                          });
  const std::string as_set = is_setting ? as_setting(setting->second, left, option) : "";
  return fmt::format("{} has no option '{}'{} {}", verb.get_name(), name,
                     !as_set.empty()     ? "; did you mean " + as_set + "?"
                     : elsewhere.empty() ? did_you_mean(name, options)
                                         : elsewhere,
                     help);
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
