#include "app/sweep/annotations.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "base/text.h"
#include "compare/judge/bounds.h"
#include "compare/judge/deliveries.h"
#include "compare/judge/laws.h"

namespace noonmark {
namespace {

// A message may have several lines; a property ends at a comma or a colon.
std::string escaped(std::string_view text, bool property) {
  std::string out;
  for (const char c : text) {
    if (c == '%' || c == '\r' || c == '\n' || (property && (c == ':' || c == ',')))
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out;
}

// location: "file:line:column"; empty: the file is named without a line.
std::string annotation(std::string_view kind, const std::string& file, const std::string& location,
                       std::string_view title, std::string_view message) {
  std::string line;
  if (const size_t column = location.rfind(':'); column != location.npos && column > 0)
    if (const size_t before = location.rfind(':', column - 1); before != location.npos)
      line = fmt::format(",line={}", location.substr(before + 1, column - before - 1));
  return fmt::format("::{} file={}{},title={}::{}\n", kind, escaped(file, true), line, escaped(title, true),
                     escaped(message, false));
}

}  // namespace

bool under_github_actions() {
  const char* const set = std::getenv("GITHUB_ACTIONS");
  return set != nullptr && std::string_view(set) == "true";
}

std::string github_annotations(const std::string& experiment, const Results& results) {
  std::string text;
  for (const PointRecord* frame : refused_frames(results.points))
    text += annotation("error", experiment, "", "frame refused", why_refused(*frame));
  for (const BoundResult& bound : results.bounds)
    if (!bound.held)
      text += annotation(bound.warns ? "warning" : "error", experiment, bound.location, bound_text(bound),
                         describe(bound, find_point(results.points, bound.point), results.info.swept));
  for (const LawResult& law : results.laws)
    if (!law.held)
      text += annotation("error", experiment, "", "law broken", fmt::format("{}: {}", law.name, law_text(law)));
  if (results.baseline)
    for (const std::string& line : results.baseline->worse)
      text += annotation("error", experiment, "", "baseline", line);
  return text;
}

}  // namespace noonmark
