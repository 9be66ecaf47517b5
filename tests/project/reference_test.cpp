// The tables of docs/reference that are made from rows of the program: built-in scenes, parts of a bias, lookups, filters.
// scripts/reference-tables runs this test with NOONMARK_WRITE_REFERENCE set, and then the test writes them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "compare/results/record_fields.h"
#include "scenes/builtin.h"
#include "technique/filters.h"
#include "technique/lookups.h"
#include "technique/settings.h"
#include "tests/support/source_dir.h"

namespace noonmark {
namespace {

using TableLines = std::vector<std::string>;

// Text in a cell: "|" would end it, and "<...>" would be taken for HTML.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

TableLines scenes_table_lines() {
  TableLines lines = {"| scene | what it provokes | as its map shows it | what is wrong |", "|---|---|---|---|"};
  for (const BuiltinScene& row : builtin_scenes())
    lines.push_back(
        fmt::format("| `{0}` | {1} | ![{0} with its shadow map](../images/scenes/{0}.png) | "
                    "![the causes of the wrong pixels](../images/scenes/{0}-causes.png) |",
                    row.name, cell(row.provokes)));
  return lines;
}

TableLines bias_table_lines() {
  TableLines lines = {"| part of the bias | unit | what it is | what the laws say |", "|---|---|---|---|"};
  for (const BiasPart& part : bias_parts()) {
    std::string names;
    for (const BiasParameter& parameter : bias_parameters())
      if (parameter.part == &part) names += fmt::format("{}`{}`", names.empty() ? "" : ", ", parameter.setting);
    const std::string unit = part.unit.starts_with("bias.") ? fmt::format("`{}`", part.unit) : std::string(part.unit);
    lines.push_back(fmt::format("| {} | {} | {} | {} |", names, unit, cell(part.help), cell(part.law)));
  }
  for (const TapReference& reference : tap_references())
    lines.push_back(fmt::format("| `bias.reference = \"{}\"` | | compares with {} | {} |", reference.name,
                                cell(reference.help), cell(reference.law)));
  return lines;
}

TableLines filters_table_lines() {
  TableLines lines = {"| filter (`filter.kind`) | its settings | what it is | what the laws say |",
                      "|---|---|---|---|"};
  for (const Filter& filter : filters()) {
    std::string reads;
    for (const KindRead<FilterSettings>& read : filter.reads)
      reads += fmt::format("{}`{}`", reads.empty() ? "" : ", ", read.parameter->setting);
    lines.push_back(fmt::format("| `{}` | {} | {} | {} |", filter.name, reads, cell(filter.help), cell(filter.law)));
  }
  return lines;
}

TableLines lookups_table_lines() {
  TableLines lines = {"| lookup (`lookup.kind`) | its settings | what it is | what the laws say |",
                      "|---|---|---|---|"};
  for (const LookupKind& lookup : lookups()) {
    std::string reads;
    for (const auto& read : lookup.reads)
      reads += fmt::format("{}`{}`", reads.empty() ? "" : ", ", read.parameter->setting);
    lines.push_back(fmt::format("| `{}` | {} | {} | {} |", lookup.name, reads, cell(lookup.help), cell(lookup.law)));
  }
  return lines;
}

// A page of docs/reference, and the lines between the two comments that enclose a table in it.
class Page {
 public:
  explicit Page(const std::string& name) : path_(noonmark::test::source_dir() + "/docs/reference/" + name + ".md") {
    std::ifstream file(path_);
    for (std::string line; std::getline(file, line);) lines_.push_back(line);
    if (lines_.empty()) throw std::runtime_error(path_ + " is empty or not there");
  }

  TableLines table(const std::string& name) {
    const auto [begin, end] = place_of(name);
    return {begin, end};
  }
  // Writes the table if the environment asks for it.
  void bring_up_to_date(const std::string& name, const TableLines& table) {
    if (!std::getenv("NOONMARK_WRITE_REFERENCE")) return;
    const auto [begin, end] = place_of(name);
    lines_.insert(lines_.erase(begin, end), table.begin(), table.end());
    std::ofstream file(path_);
    for (const std::string& line : lines_) file << line << '\n';
  }

 private:
  std::pair<TableLines::iterator, TableLines::iterator> place_of(const std::string& name) {
    const auto begin =
        std::find(lines_.begin(), lines_.end(), "<!-- " + name + ": written by scripts/reference-tables -->");
    const auto end = std::find(begin, lines_.end(), "<!-- end -->");
    if (end == lines_.end()) throw std::runtime_error(path_ + " has no place for the table of " + name);
    return {begin + 1, end};
  }

  std::string path_;
  TableLines lines_;
};

// Each line that the page shows is one of the program's, in their order. A line that the page lacks is no failure if
// `may_lack` says so.
template <class MayLack>
void expect_from_rows(const std::string& page_name, const std::string& table, const TableLines& rows,
                      MayLack may_lack) {
  Page page(page_name);
  page.bring_up_to_date(table, rows);
  const TableLines shown = page.table(table);
  auto next = shown.begin();
  for (const std::string& row : rows) {
    if (next != shown.end() && *next == row)
      ++next;
    else if (!may_lack(row)) {
      ADD_FAILURE() << "docs/reference/" << page_name
                    << ".md is not as the rows are; run scripts/reference-tables\nit has: "
                    << (next == shown.end() ? "" : *next) << "\nthe row: " << row;
      return;
    }
  }
  if (next != shown.end()) {
    ADD_FAILURE() << "docs/reference/" << page_name
                  << ".md has a line that no row says; run scripts/reference-tables:\n"
                  << *next;
  }
}

bool nothing(const std::string&) { return false; }

// A new part of a bias needs only its own file, its row and its laws, so its lines in the documents may come later.
bool part_of_a_bias(const std::string& row) { return row.starts_with("| `bias."); }

TEST(ReferenceTables, ScenesAreThoseOfTheRows) {
  expect_from_rows("scenes", "scenes", scenes_table_lines(), nothing);
}
TEST(ReferenceTables, PartsOfABiasAreThoseOfTheRows) {
  expect_from_rows("techniques", "bias", bias_table_lines(), part_of_a_bias);
  EXPECT_GE(Page("techniques").table("bias").size(), 18u) << "the table had more lines; run scripts/reference-tables";
}
TEST(ReferenceTables, FiltersAreThoseOfTheRows) {
  expect_from_rows("techniques", "filters", filters_table_lines(), nothing);
  expect_from_rows("techniques", "lookups", lookups_table_lines(), nothing);
}

TEST(TechniqueRows, SayWhatTheLawsSay) {
  for (const BiasPart& part : bias_parts()) EXPECT_FALSE(part.law.empty()) << part.name;
  for (const TapReference& reference : tap_references()) EXPECT_FALSE(reference.law.empty()) << reference.name;
  for (const Filter& filter : filters()) EXPECT_FALSE(filter.law.empty()) << filter.name;
}

// A reader sees one row: in a list of choices, under the pointer, in a search. So a text may not lean on the row before it.
TEST(HelpTexts, AreUnderstoodAlone) {
  const std::vector<std::string> leaning = {"The same in ", "The same along ", "The same law ", "The same over ",
                                            "Its ",         "The second ",     "The third ",    "That "};
  const std::vector<std::string> inside = {" that distance", " that interval", " of that placement", " such points",
                                           " these points",  "Number of such", "of these "};
  const auto check = [&](std::string_view name, std::string_view help) {
    for (const std::string& word : leaning) EXPECT_FALSE(help.starts_with(word)) << name << ": " << help;
    for (const std::string& words : inside) EXPECT_EQ(help.find(words), std::string::npos) << name << ": " << help;
  };
  for (const Metric& row : metrics_table()) check(row.name, row.help);
  for (const CurveQuantity& row : curve_quantities()) check(row.name, row.help);
  for (const Setting& row : settings_table()) check(row.name, row.help);
  for (const RecordField& row : record_fields()) check(row.name, row.help);
}

}  // namespace
}  // namespace noonmark
