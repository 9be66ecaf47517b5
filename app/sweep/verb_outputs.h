// Where `render`, `map`, `inspect` and `judge` write, and the files that they write there. Those of an earlier run are removed
// before anything else can fail, so that a run that fails or is killed leaves no file that looks like its own.
//
//   const VerbOutputs outputs = outputs_of("render", experiment, arguments.out);
//   retract(outputs);
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace noonmark {

struct VerbOutputs {
  std::string folder;
  std::vector<std::string> files;  // in the folder
};

// subject: the experiment, scene, model or frame of the command line. out: the value of --out; without one, the default folder.
VerbOutputs outputs_of(std::string_view verb, const std::string& subject, const std::string& out);

// Removes these files, and nothing else: no folder of such a name. Throws Error(file) if one cannot be removed.
void retract(const VerbOutputs& outputs);

}  // namespace noonmark
