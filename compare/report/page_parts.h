// A page as one HTML file without other files: the template, the style, the charts' library and scripts, and what the
// caller puts into them.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "compare/report/cause_colors.h"
#include "compare/report/element.h"

namespace noonmark::report {

// What every page begins with: <!doctype html> to the end of its header.
struct PageHead {
  Markup title, subtitle{};
  std::string style;  // of the whole page, as CSS
  std::string version;
  std::string brand = "Noonmark";
  std::string pictures = "data:";  // whence the page may load pictures: sources of its Content-Security-Policy
  bool scripts = true;             // whether the page may run scripts of its own
};
std::string page_head(const PageHead& head);

struct PageParts {
  Markup title, subtitle, navigation, sections;
  nlohmann::json data;               // for the scripts
  std::vector<CauseColor> causes;    // whose colours the page may use
  std::vector<std::string> scripts;  // names of files in page/, in order: "charts", "page"
  std::string version;
};

std::string fill_page(const PageParts& parts);

// A page with the same style, without scripts. It holds its pictures itself.
struct PlainPageParts {
  Markup title, body;
  std::string version;
  std::string style{};  // name of a file in page/ with rules for this page alone; empty: none
};
std::string plain_page(const PlainPageParts& parts);

// What another page needs to look like the report: the text of a file in page/ ("report/page/style.css"), and the rules
// that give each cause its colour as --c-NAME and .c-NAME. Throws std::logic_error if there is no such file.
std::string_view page_file(const std::string& name);
std::string colour_rules(const std::vector<CauseColor>& causes);

// Replaces each {{name}} of a template once by what `text_of` gives for the name. Inserted text is not searched again.
std::string fill_template(std::string_view page, const std::function<std::string(std::string_view)>& text_of);

// Data for a script, as the element that holds it. The script reads it by its id.
Markup data_block(std::string_view id, const nlohmann::json& data);

}  // namespace noonmark::report
