#include "app/verbs/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <sstream>
#include <vector>

#include "app/verbs/command_line_error.h"
#include "app/verbs/terminal_text.h"
#include "base/build_facts.h"
#include "base/error.h"

namespace noonmark {
namespace {

constexpr const char* footer =
    "Examples:\n"
    "  noonmark live cube-room          a page with sliders: see what bias and resolution do\n"
    "  noonmark recommend cube-room     the cheapest settings that are right\n"
    "  noonmark help check              the options of a verb\n"
    "\n"
    "Exit codes say what has to change. Of several experiments, the largest is returned.\n"
    "  0  nothing: done, all held\n"
    "  1  the shadows: a bound or a law is broken, or a value is worse than in the baseline\n"
    "  2  the command line or the experiment: wrong usage, a point too large for memory, a results' folder\n"
    "     that cannot be used\n"
    "  3  a file: a bad scene or picture, or one too large for memory; damaged results; a full disk\n"
    "  4  the machine: no usable OpenGL, ray tracer or picture library; no memory, threads or files\n"
    "  5  Noonmark: a defect\n"
    "  6  nothing yet: the sweep is incomplete";

constexpr size_t widest_help = 100;  // columns

// The text in lines that end before the help's right edge, each but the first behind so many blanks.
std::string wrapped(const std::string& text, size_t indent, size_t columns) {
  std::string out;
  size_t at = indent;
  std::istringstream words(text);
  for (std::string word; words >> word; at += word.size()) {
    if (at > indent && at + 1 + word.size() > columns) {
      out += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (at > indent) {
      out += " ";
      ++at;
    }
    out += word;
  }
  return out;
}

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
    return wrapped(option->get_description() + (by_default.empty() ? "" : fmt::format(" (default: {})", by_default)),
                   column_width_, columns_);
  }
  // At least two blanks between the name and the description. The scripts in app/shell/ find the end of the name by them;
  // CLI11 leaves one behind a name that just fits.
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string line = "  " + make_option_name(option, is_positional) + make_option_opts(option);
    if (line.size() + 2 > column_width_) line += "\n";
    const size_t filled = line.ends_with('\n') ? 0 : line.size();
    return line + std::string(column_width_ - filled, ' ') + make_option_desc(option) + "\n";
  }
  std::string make_subcommand(const CLI::App* verb) const override {
    return fmt::format("  {:<12}{}\n", verb->get_name(), wrapped(verb->get_description(), 14, columns_));
  }
  std::string make_description(const CLI::App* app) const override {
    return wrapped(app->get_description(), 0, columns_) + "\n\n";
  }

 private:
  size_t columns_ = std::min(terminal_columns().value_or(widest_help), widest_help);
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
          "Noonmark measures whether a shadow map is right. It renders a scene's shadows with OpenGL shadow maps and "
          "with Embree shadow rays, and says of every wrong pixel why it is wrong.",
          "noonmark")) {
  const auto formatter = std::make_shared<HelpFormatter>();
  formatter->label("SUBCOMMAND", "VERB ...");
  app_->formatter(formatter);
  app_->require_subcommand(1);
  app_->set_version_flag("--version", fmt::format("{} ({})", build_facts().version, build_facts().commit));
  for (const Verb& row : verb_table()) {
    CLI::App* verb = app_->add_subcommand(row.name, row.help);  // inherits the formatter
    verb->group(row.heading);
    verb->footer(fmt::format("Example:\n  {}", row.example));
    runs_[row.name] = row.add(*verb);
  }
  app_->footer(footer);  // after the verbs, which would inherit it
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
