// Where `recommend`, `render`, `map`, `inspect`, `judge` and `capture` write, and the files that they write there
// (app/sweep/output_folder.h).
//
//   const VerbOutputs outputs = outputs_of("render", "cube-room.toml", arguments.out);
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace noonmark {

struct VerbOutputs {
  std::string folder;
  std::vector<std::string> files;  // in the folder: all that the verb may write

  std::string inner = {};                     // a folder in the folder; empty: none
  std::vector<std::string> inner_files = {};  // in that one and its folders; patterns of fnmatch

  std::vector<std::string> all() const;  // `files` and `inner`
};

// subject: the experiment, scene, model or frame of the command line. out: the value of --out; without one, the default folder,
// but `recommend` and its --texels ("texels") have --out only.
VerbOutputs outputs_of(std::string_view verb, const std::string& subject, const std::string& out);

}  // namespace noonmark
