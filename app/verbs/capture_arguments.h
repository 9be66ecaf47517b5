// The options of the verbs that read a capture: `capture`, and `judge` of a capture.
//
//   add_capture_options(verb, arguments);
//   read_capture(capture_command(file, arguments.reader), folder, arguments.words(), print_line);
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace noonmark {

struct CaptureArguments {
  std::optional<int> light;    // its number, from 1 on
  std::string filter;          // of the lookup; empty: the one that fits
  std::optional<double> bias;  // of the lookup, window depth; empty: the one that fits
  std::string reader;          // the folder of the reader; empty: the program's own

  bool any() const;                        // one was given
  std::vector<std::string> words() const;  // of the reader's command line
};

void add_capture_options(CLI::App& verb, CaptureArguments& arguments);

}  // namespace noonmark
