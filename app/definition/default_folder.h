// Where a verb puts its files without --out: one rule for all verbs, so that two files never share a folder.
//
//   default_folder("checks/shadows.toml");                           // "out/checks/shadows"
//   default_folder("checks/helmet.toml", "recommend-");              // "out/checks/recommend-helmet"
//   default_folder("out/checks/recommend-helmet/recommended.toml");  // "out/checks/recommend-helmet/recommended": beside it
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

// out/ and the file's path below the working folder, without its ending; of a file that is not below the working folder,
// its whole path. A file that is itself below out/ has its folder beside it. before_name: of the verb.
std::string default_folder(const std::string& file, std::string_view before_name = "");

// The same of a folder of files: out/checks for checks, out for the working folder.
std::string default_folder_of_folder(const std::string& folder);

}  // namespace noonmark
