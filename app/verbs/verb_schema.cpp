#include <fmt/format.h>

#include <memory>
#include <string>

#include "app/definition/experiment_keys.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "frames/frame_file.h"

namespace noonmark {
namespace {

RunVerb add_schema(CLI::App& verb) {
  const auto what = std::make_shared<std::string>("experiment");
  verb.add_option("what", *what, "Which file: the experiment, or the frame.json of another renderer's frame")
      ->check(one_of({"experiment", "frame"}))
      ->type_name("experiment|frame")
      ->capture_default_str();
  return [what](const std::string&) {
    fmt::print("{}", *what == "frame" ? frame_schema() : experiment_schema());
    return 0;
  };
}

}  // namespace

Verb verb_schema() {
  return {"schema", "Print the JSON schema of the experiment file, by which editors complete it",
          "noonmark schema > experiment.schema.json", add_schema};
}

}  // namespace noonmark
