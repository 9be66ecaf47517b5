#include <fmt/format.h>

#include <memory>

#include "app/pictures/capture.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/capture_arguments.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/text.h"

namespace noonmark {

bool CaptureArguments::any() const { return !words().empty() || !reader.empty(); }

std::vector<std::string> CaptureArguments::words() const {
  std::vector<std::string> words;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.push_back(option + value);  // one word, so that no value is taken for an option
  };
  add("--light=", light ? std::to_string(*light) : "");
  add("--filter=", filter);
  add("--bias=", bias ? fmt::format("{}", *bias) : "");
  return words;
}

void add_capture_options(CLI::App& verb, CaptureArguments& arguments) {
  verb.add_option("--light", arguments.light, "Of a capture: only this light, counted from 1")
      ->check(whole_number(1))
      ->type_name(value_kind::number);
  const std::vector<std::string> filters = {"none", "hardware", "box3", "box5", "box7"};
  verb.add_option("--filter", arguments.filter, "Of a capture: the filter of the lookup; without it the one that fits")
      ->check(one_of(filters))
      ->type_name(joined(filters));
  verb.add_option("--bias", arguments.bias,
                  "Of a capture: the constant bias of the lookup, in window depth; without it the one that fits")
      ->check(number_in({.least = 0, .most = 1}))
      ->type_name(value_kind::number);
  verb.add_option("--reader", arguments.reader,
                  "Of a capture: the folder of the reader, capture.py; without it the program's own")
      ->check(not_empty())
      ->type_name(value_kind::folder);
}

namespace {

struct CaptureOptions {
  std::string file;
  CaptureArguments capture;
  ExperimentArguments arguments;
};

int write_frames(const CaptureOptions& options) {
  if (!is_capture(options.file))
    throw Error(ErrorKind::usage, fmt::format("{}: a capture of RenderDoc ends in .rdc", options.file));
  const VerbOutputs outputs = outputs_of("capture", options.file, options.arguments.out);
  OutputFolder folder(outputs);
  const std::vector<std::string> command = capture_command(options.file, options.capture.reader);
  folder.make();
  for (const std::string& frame :
       read_capture(command, outputs.folder + "/" + outputs.inner, options.capture.words(), print_line))
    fmt::print("{} is written\n", printable(frame));
  return 0;
}

RunVerb add_capture(CLI::App& verb) {
  const auto options = std::make_shared<CaptureOptions>();
  verb.add_option("capture", options->file, "A capture of one frame by RenderDoc")
      ->required()
      ->check(not_empty())
      ->type_name(value_kind::capture);
  add_capture_options(verb, options->capture);
  add_out(
      verb, options->arguments, "Folder for the folder of frames",
      folders_of({"shots/frame.rdc"}, [](const std::string& file) { return outputs_of("capture", file, "").folder; }));
  return [options](const std::string&) { return write_frames(*options); };
}

}  // namespace

Verb verb_capture() {
  return {"capture", "Write the frames that a RenderDoc capture holds, one for each light",
          "noonmark capture frame.rdc --out frames", add_capture};
}

}  // namespace noonmark
