#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/sweep/judging.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/text.h"
#include "compare/judge/verdict.h"
#include "compare/store/store.h"

namespace noonmark {
namespace {

int write_report_again(const std::string& folder, bool all) {
  const std::string store = folder + "/results.sqlite";
  std::error_code none;
  if (std::filesystem::status(store, none).type() == std::filesystem::file_type::not_found)
    throw Error(ErrorKind::usage, fmt::format("{}: there are no results here (no results.sqlite); give the folder that "
                                              "noonmark run or check wrote",
                                              folder));
  const Results results = ResultStore::read(store);
  write_report(results, folder, all ? CsvColumns::all : CsvColumns::asked);
  fmt::print("{} of {}; the report is {}/report.html\n{}", results.points.size(),
             counted(static_cast<size_t>(results.planned_points), "point"), printable(folder),
             all ? "" : "results.csv has the columns that the experiment asks for; --all writes every one\n");
  return verdict_of(results) == Verdict::incomplete ? exit_code_of(Verdict::incomplete) : 0;
}

RunVerb add_report(CLI::App& verb) {
  const auto folder = std::make_shared<std::string>();
  verb.add_option("folder", *folder, "The results' folder")
      ->required()
      ->check(not_empty())
      ->type_name(value_kind::folder);
  const auto all = std::make_shared<bool>(false);
  verb.add_flag("--all", *all,
                "Write every column into results.csv: all settings, metrics and quantities of the curve");
  return [folder, all](const std::string&) { return write_report_again(*folder, *all); };
}

}  // namespace

Verb verb_report() {
  return {"report", "Write report.html and results.csv again from stored results", "noonmark report out/shadows",
          add_report};
}

}  // namespace noonmark
