// README's section "What there is" names every technique. Its tables of bias parts and filters are made from their rows:
// scripts/readme-tables runs this test with NOONMARK_WRITE_README set, and then the test writes them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "technique/filters.h"
#include "technique/light_kind.h"

namespace noonmark {
namespace {

using TableLines = std::vector<std::string>;

std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

TableLines bias_table() {
  TableLines lines = {"| part of the bias | unit | what it is | what the laws say |", "|---|---|---|---|"};
  for (const BiasPart& part : bias_parts()) {
    std::string names;
    for (const BiasParameter& parameter : bias_parameters())
      if (parameter.part == &part) names += fmt::format("{}`{}`", names.empty() ? "" : ", ", parameter.setting);
    const std::string unit = part.unit == "bias.unit" ? "`bias.unit`" : std::string(part.unit);
    lines.push_back(fmt::format("| {} | {} | {} | {} |", names, unit, cell(part.help), cell(part.law)));
  }
  for (const TapReference& reference : tap_references())
    lines.push_back(fmt::format("| `bias.reference = \"{}\"` | | compares with {} | {} |", reference.name,
                                cell(reference.help), cell(reference.law)));
  return lines;
}

TableLines filter_table() {
  TableLines lines = {"| filter (`filter.kind`) | its settings | what it is | what the laws say |",
                      "|---|---|---|---|"};
  for (const Filter& filter : filters()) {
    std::string reads;
    for (const FilterRead& read : filter.reads)
      reads += fmt::format("{}`{}`", reads.empty() ? "" : ", ", read.parameter->setting);
    lines.push_back(fmt::format("| `{}` | {} | {} | {} |", filter.name, reads, cell(filter.help), cell(filter.law)));
  }
  return lines;
}

constexpr const char* readme = NOONMARK_SOURCE_DIR "/README.md";

class Readme : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ifstream file(readme);
    for (std::string line; std::getline(file, line);) lines_.push_back(line);
    ASSERT_FALSE(lines_.empty());
  }

  // The lines between the two comments that enclose a table.
  TableLines table(const std::string& name) {
    const auto [begin, end] = place_of(name);
    return {begin, end};
  }
  // Writes the table if the environment asks for it.
  void bring_up_to_date(const std::string& name, const TableLines& table) {
    if (!std::getenv("NOONMARK_WRITE_README")) return;
    const auto [begin, end] = place_of(name);
    lines_.insert(lines_.erase(begin, end), table.begin(), table.end());
    std::ofstream file(readme);
    for (const std::string& line : lines_) file << line << '\n';
  }
  std::string from(const std::string& heading) const {
    std::string text;
    for (auto line = std::find(lines_.begin(), lines_.end(), heading); line != lines_.end(); ++line)
      text += *line + '\n';
    return text;
  }

 private:
  std::pair<TableLines::iterator, TableLines::iterator> place_of(const std::string& name) {
    const auto begin =
        std::find(lines_.begin(), lines_.end(), "<!-- " + name + ": written by scripts/readme-tables -->");
    const auto end = std::find(begin, lines_.end(), "<!-- end -->");
    if (end == lines_.end()) throw std::runtime_error("README.md has no place for the table of " + name);
    return {begin + 1, end};
  }

  TableLines lines_;
};

// A new part needs only its own file, its row and its laws. So a row that is not in README yet is no failure, but a
// line that is not as its row says is one.
TEST_F(Readme, TableOfBiasPartsSaysWhatTheRowsSay) {
  const TableLines rows = bias_table();
  bring_up_to_date("bias", rows);
  const TableLines shown = table("bias");
  EXPECT_GE(shown.size(), 18u) << "the table had more lines; run scripts/readme-tables";
  auto next = rows.begin();
  for (const std::string& line : shown) {
    next = std::find(next, rows.end(), line);
    ASSERT_NE(next, rows.end()) << "no row says this, or it is not in the order of the rows; run "
                                   "scripts/readme-tables:\n"
                                << line;
    ++next;
  }
}

TEST_F(Readme, TableOfFiltersIsThatOfTheRows) {
  bring_up_to_date("filters", filter_table());
  EXPECT_EQ(table("filters"), filter_table()) << "run scripts/readme-tables";
}

TEST_F(Readme, NamesEveryTechnique) {
  const std::string section = from("## What there is");
  ASSERT_FALSE(section.empty());
  for (const char* name : {"map.format", "map.wrap", "map.cull", "map.cube_pass"})
    for (std::string_view choice : find_setting(name).choices)
      EXPECT_NE(section.find("`" + std::string(choice)), std::string::npos) << name << " = " << choice;
  for (const KindOfLight* kind : kinds_of_light())
    EXPECT_NE(section.find("| `" + std::string(kind->name()) + "`"), std::string::npos) << kind->name();
}

TEST(TechniqueRows, SayWhatTheLawsSay) {
  for (const BiasPart& part : bias_parts()) EXPECT_FALSE(part.law.empty()) << part.name;
  for (const TapReference& reference : tap_references()) EXPECT_FALSE(reference.law.empty()) << reference.name;
  for (const Filter& filter : filters()) EXPECT_FALSE(filter.law.empty()) << filter.name;
}

}  // namespace
}  // namespace noonmark
