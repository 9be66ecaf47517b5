#include <fmt/format.h>

#include "app/definition/experiment_schema.h"
#include "app/verbs/verbs.h"

namespace noonmark {
namespace {

RunVerb add_schema(CLI::App&) {
  return [](const std::string&) {
    fmt::print("{}", experiment_schema());
    return 0;
  };
}

}  // namespace

Verb verb_schema() {
  return {"schema", "Print the JSON schema of the experiment file, with which editors complete and check it",
          add_schema};
}

}  // namespace noonmark
