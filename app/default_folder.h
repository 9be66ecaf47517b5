// Where a verb puts its files without --out: one rule for all verbs, so that two files never share a folder.
//
//   default_folder("tests/shadows.toml")                            // "out/tests/shadows"
//   default_folder("tests/helmet.toml", "recommend-")               // "out/tests/recommend-helmet"
//   default_folder("out/tests/recommend-helmet/recommended.toml")   // "out/tests/recommend-helmet/recommended": beside it
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

// out/ and the file's path below the working folder, without its ending; of a file that is not below the working folder,
// its whole path. A file that is itself below out/ has its folder beside it. before_name: of the verb.
std::string default_folder(const std::string& file, std::string_view before_name = "");

// The same of a folder of files: out/tests for tests, out for the working folder.
std::string default_folder_of_folder(const std::string& folder);

}  // namespace noonmark
