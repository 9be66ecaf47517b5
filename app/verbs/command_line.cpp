#include "app/verbs/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <sstream>
#include <vector>

#include "app/verbs/command_line_error.h"
#include "base/build_facts.h"
#include "base/error.h"

namespace noonmark {
namespace {

constexpr const char* exit_codes =
    "Exit codes: 0 done, all held; 1 a bound or a law is broken, or a value is worse than in the baseline;\n"
    "otherwise what has to change:\n"
    "2 the command line or the experiment (wrong usage; a point too large for memory; a results' folder that\n"
    "  cannot be used); 3 a file (a bad scene or picture, or one too large for memory; damaged results; a full disk);\n"
    "4 the machine (no usable OpenGL, ray tracer or picture library, no memory, threads or open files left);\n"
    "5 Noonmark: a defect; 6 nothing: the sweep is incomplete. Of several experiments, the largest code is returned.";

// Writes the default of an option behind its description: "Number of texel sizes (default: 25)". CLI11 writes it behind the
// name, which is hard to read if the default is a sentence.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    if (option->get_default_str().empty()) return text;
    const std::string value = option->get_default_str();
    for (const std::string& by_default : {"=" + value, " [" + value + "] "})  // of CLI11 2.3 and of 2.4
      if (const size_t at = text.find(by_default); at != std::string::npos) text.erase(at, by_default.size());
    return text;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    const std::string by_default = option->get_default_str();
    return option->get_description() + (by_default.empty() ? "" : fmt::format(" (default: {})", by_default));
  }
  // At least two blanks between the name and the description. The scripts in app/shell/ find the end of the name by them;
  // CLI11 leaves one behind a name that just fits.
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string line = "  " + make_option_name(option, is_positional) + make_option_opts(option);
    if (line.size() + 2 > column_width_) line += "\n";
    const size_t filled = line.ends_with('\n') ? 0 : line.size();
    return line + std::string(column_width_ - filled, ' ') + make_option_desc(option) + "\n";
  }
};

// What was asked for, help or the version. CLI11 writes to C++ streams; this writes its text through stdio, like all other
// output.
int print_asked(const CLI::App& app, const CLI::Success& asked) {
  std::ostringstream output, errors;
  const int exit_code = app.exit(asked, output, errors);
  std::fputs(output.str().c_str(), stdout);
  return exit_code;
}

}  // namespace

CommandLine::CommandLine()
    : app_(std::make_unique<CLI::App>(
          "Noonmark measures whether a shadow map is right. It renders a scene's shadows with OpenGL shadow maps\n"
          "and with Embree shadow rays, and reports for every wrong pixel why it is wrong.")) {
  app_->formatter(std::make_shared<HelpFormatter>());
  app_->footer(exit_codes);
  app_->require_subcommand(1);
  app_->set_version_flag("--version", fmt::format("{} ({})", build_facts().version, build_facts().commit));
  for (const Verb& row : verb_table()) {
    CLI::App* verb = app_->add_subcommand(row.name, row.help);  // inherits formatter and footer
    runs_[row.name] = row.add(*verb);
  }
}

CommandLine::~CommandLine() = default;

Vocabulary CommandLine::vocabulary() const {
  Vocabulary vocabulary;
  for (const Verb& row : verb_table()) {
    vocabulary.verbs.emplace_back(row.name);
    for (const CLI::Option* option : app_->get_subcommand(row.name)->get_options())
      if (option->get_items_expected_max() > 0)
        for (const std::string& name : option->get_lnames()) vocabulary.options_with_a_value.insert("--" + name);
  }
  return vocabulary;
}

int CommandLine::run(int argc, char** argv, const std::string& command) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  refuse_unknown(words.front());
  refuse_empty_values(words);
  try {
    app_->parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return print_asked(*app_, asked);
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::usage, command_line_error(*app_, error));
  }
  return runs_.at(app_->get_subcommands().front()->get_name())(command);
}

}  // namespace noonmark
