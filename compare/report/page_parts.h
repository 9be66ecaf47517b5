// A page as one HTML file without other files: the template, the style, the charts' library and scripts, and what the
// caller puts into them.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/report/cause_colors.h"

namespace noonmark::report {

struct PageParts {
  std::string title, subtitle, navigation, sections;  // HTML
  nlohmann::json data;                                // for the scripts
  std::vector<CauseColor> causes;                     // whose colours the page may use
  std::vector<std::string> scripts;                   // names of files in page/, in order: "charts", "page"
  std::string version;
};

std::string fill_page(const PageParts& parts);

// Whether a page holds its pictures itself, or shows files from folders beside it. The page allows no other pictures.
enum class Pictures { inside, beside };

// A page with the same style, without scripts. title: text; body: HTML.
std::string plain_page(const std::string& title, const std::string& body, const std::string& version,
                       Pictures pictures = Pictures::inside);

}  // namespace noonmark::report
