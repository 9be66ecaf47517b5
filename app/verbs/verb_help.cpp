#include <fmt/format.h>

#include <memory>

#include "app/verbs/command_line_error.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"

namespace noonmark {
namespace {

// The same as noonmark --help, or noonmark VERB --help.
int print_help(const CLI::App& program, const std::string& name) {
  if (name.empty()) {
    fmt::print("{}", program.get_formatter()->make_help(&program, program.get_name(), CLI::AppFormatMode::Normal));
    return 0;
  }
  require_verb(name);
  fmt::print("{}", program.get_subcommand(name)->help(program.get_name()));
  return 0;
}

RunVerb add_help(CLI::App& verb) {
  const auto name = std::make_shared<std::string>();
  verb.add_option("verb", *name, "The verb; without one, all verbs are listed")->type_name(value_kind::verb);
  return [name, program = verb.get_parent()](const std::string&) { return print_help(*program, *name); };
}

}  // namespace

Verb verb_help() { return {"help", "Print the help of a verb", "noonmark help recommend", add_help}; }

}  // namespace noonmark
