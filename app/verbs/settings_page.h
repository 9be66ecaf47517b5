// What an experiment, a bound or frame.json can name, as tables of one HTML page: from the rows of the program, so nothing of it
// stands in a document. Each table is a section with an id ("settings", "metrics", "quantities", "experiment", "frame",
// "checks"), from which scripts/site/hooks.py takes it.
//
//   std::string page = settings_page("0.1.0");
#pragma once
#include <string>

namespace noonmark {

// version: of the program, for the foot of the page.
std::string settings_page(const std::string& version);

}  // namespace noonmark
