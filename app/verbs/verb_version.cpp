#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/verbs/verbs.h"

namespace noonmark {
namespace {

RunVerb add_version(CLI::App& verb) {
  return [program = verb.get_parent()](const std::string&) {
    fmt::print("{}\n", program->version());
    return 0;
  };
}

}  // namespace

Verb verb_version() {
  return {"version", "Print the version and the commit, as --version does", "noonmark version", add_version};
}

}  // namespace noonmark
