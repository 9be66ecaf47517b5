#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/verbs/settings_page.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

int list_settings() {
  const Settings defaults;
  size_t width = 0;  // of the column of names
  for (const Setting& row : settings_table()) width = std::max(width, row.name.size());
  fmt::print("Settings: --set name=value, or in an experiment file ([map] resolution = 2048).\n\n");
  for (const Setting& row : settings_table())
    fmt::print("{:<{}} {:<16} {}\n{:<{}} {}\n", row.name, width, row.get(defaults), row.help, "", width + 17,
               row.range_with_unit());
  fmt::print("\nMetrics: for [[bound]] and [plot].\n\n");
  for (const Metric& metric : metric_rows())
    fmt::print("{:<32} {:<10} {}{}\n", metric.name, metric.unit, metric.help, also_text(metric));
  fmt::print("\nQuantities of the bias curve, for [[bound]]:\n\n");
  for (const CurveQuantity& quantity : curve_quantities())
    fmt::print("{:<32} {:<10} {}\n", quantity.name, quantity.unit, quantity.help);
  return 0;
}

RunVerb add_settings(CLI::App& verb) {
  const auto html = std::make_shared<bool>(false);
  verb.add_flag("--html", *html,
                "Print them, and the keys of experiments and of frame.json, as tables of one HTML page");
  return [html](const std::string&) {
    if (!*html) return list_settings();
    fmt::print("{}", settings_page(std::string(build_facts().version)));
    return 0;
  };
}

}  // namespace

Verb verb_settings() {
  return {"settings", "List every setting, metric and quantity: unit, range, default, meaning",
          "noonmark settings --html > settings.html", add_settings};
}

}  // namespace noonmark
