#include "app/verbs/settings_page.h"

#include <fmt/format.h>

#include <initializer_list>
#include <string_view>
#include <utility>

#include "app/definition/experiment_keys.h"
#include "compare/report/blocks.h"
#include "compare/report/page_parts.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "frames/checks.h"
#include "frames/frame_keys.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

using report::Markup;

Markup tabled(const Markup& head, const Markup& rows) {
  using namespace report;
  return div(css("scroll"), table("", head, rows)) + "\n";
}

Markup group_heading(std::string_view id, const Markup& text) {
  return report::element("h3", report::Attribute("id", id), text) + "\n";
}

Markup name_cell(std::string_view name) {
  return report::row_head(report::Attribute("style", "white-space: nowrap"), report::code(name));
}

Markup settings_section() {
  using namespace report;
  const Settings defaults;
  Markup tables, rows;
  std::string group;
  const auto end_group = [&] {
    if (!rows.empty())
      tables += group_heading(group, group) + tabled(heads({"Setting", "Default", "Takes", "Meaning"}), rows);
    rows = {};
  };
  for (const Setting& row : settings_table()) {
    if (std::string its(row.name.substr(0, row.name.find('.'))); its != group) {
      end_group();
      group = std::move(its);
    }
    rows += tr(Attribute("id", row.name), name_cell(row.name),
               td(Attribute("style", "white-space: nowrap"), code(row.get(defaults))), td(row.range_with_unit()),
               td(row.help));
  }
  end_group();
  return section("settings", "Settings", tables);
}

template <class Row>  // Metric or CurveQuantity
Markup numbers_section(std::string_view id, const Markup& title, std::span<const Row> table) {
  using namespace report;
  Markup rows;
  for (const Row& row : table) {
    std::string help(row.help);
    if constexpr (std::is_same_v<Row, Metric>) help += also_text(row);
    rows += tr(Attribute("id", row.name), name_cell(row.name), td(row.unit), td(help));
  }
  return section(id, title, tabled(heads({"Name", "Unit", "Meaning"}), rows));
}

Markup experiment_section() {
  using namespace report;
  constexpr std::pair<std::string_view, std::string_view> tables[] = {
      {"root", "The file, and a [[part]]"},
      {"range", "A range of values: {min = 1, max = 8, steps = 4}"},
      {"answer", "[answer]"},
      {"plot", "[plot]"},
      {"curve", "[curve]"},
      {"phase", "[phase]"},
      {"bound", "[[bound]]"},
      {"law", "[[law]]"},
      {"lights", "[[lights]], beside the settings of the light"},
      {"frame", "[[frame]]"}};
  Markup all;
  for (const auto& [name, title] : tables) {
    Markup rows;
    for (const ExperimentKey& key : experiment_keys(name))
      rows += tr(name_cell(key.name), td(taken_by(key)), td(key.help, key.required ? " Required." : ""));
    all += group_heading(fmt::format("key-{}", name), title) + tabled(heads({"Key", "Takes", "Meaning"}), rows);
  }
  return section("experiment", "Keys of an experiment file", all);
}

Markup frame_section() {
  using namespace report;
  Markup rows;
  for (const FrameKey& key : frame_keys())
    rows +=
        tr(name_cell(key.object.empty() ? std::string(key.name) : key.full_name()), td(taken_by(key)), td(key.help));
  return section("frame", "Keys of frame.json", tabled(heads({"Key", "Takes", "Meaning"}), rows));
}

Markup checks_section() {
  using namespace report;
  Markup rows;
  for (const FrameCheck& check : frame_checks()) rows += tr(name_cell(check.name), td(check.asks));
  return section("checks", "Checks of a delivered frame", tabled(heads({"Check", "What holds"}), rows));
}

}  // namespace

std::string settings_page(const std::string& version) {
  using report::section_link;
  const Markup links = report::joined(
      {section_link("settings", "Settings"), section_link("metrics", "Metrics"),
       section_link("quantities", "Quantities of the bias curve"), section_link("experiment", "Keys of an experiment"),
       section_link("frame", "Keys of frame.json"), section_link("checks", "Checks of a frame")},
      " · ");
  return report::plain_page({.title = "Settings, metrics and keys",
                             .body = report::paragraph(links) + settings_section() +
                                     numbers_section("metrics", "Metrics", metric_rows()) +
                                     numbers_section("quantities", "Quantities of the bias curve", curve_quantities()) +
                                     experiment_section() + frame_section() + checks_section(),
                             .version = version});
}

}  // namespace noonmark
