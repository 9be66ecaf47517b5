#include "app/definition/promise_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "app/definition/frame_metrics.h"
#include "base/error.h"
#include "compare/judge/formula.h"
#include "compare/results/quantities.h"

namespace noonmark {

void PromiseReader::read_bounds(const toml::node& node) {
  if (!node.is_array() || !node.is_array_of_tables()) fail(node, "bounds are written as [[bound]], one for each");
  for (const toml::node& element : *node.as_array()) read_bound(*element.as_table());
}

void PromiseReader::read_bound(const toml::table& table) {
  Bound bound;
  const toml::node *max = nullptr, *min = nullptr;  // read when the metric is known
  for (const Item& item : items(table)) {
    if (item.key == "metric") {
      bound.metric = string(*item.node, "metric");
      const std::vector<QuantityInfo> named = at(item.node->source(), [&] { return quantities_named(bound.metric); });
      if (!experiment_.frames.empty()) at(item.node->source(), [&] { require_frame_metric(bound.metric); });
      const auto of_curve = [](const QuantityInfo& info) { return info.of_curve; };
      if (!experiment_.curve_enabled && std::all_of(named.begin(), named.end(), of_curve))
        fail(*item.node, fmt::format("'{}' is read off the bias curve, and curve.enabled is false", bound.metric));
    } else if (item.key == "max")
      max = item.node;
    else if (item.key == "min")
      min = item.node;
    else if (item.key == "join")
      bound.join = one_of(*item.node, "join", key_choices("bound", "join"));
    else if (item.key == "placement")
      bound.placement = one_of(*item.node, "placement", key_choices("bound", "placement"));
    else if (item.key == "level")
      bound.level = one_of(*item.node, "level", key_choices("bound", "level"));
    else if (item.key == "where")
      bound.where = read_conditions(*item.node, "where");
    else
      unknown(item, "key", key_names("bound"), "bound.");
  }
  if (bound.metric.empty()) fail(table, "a [[bound]] needs a metric");
  const std::vector<QuantityInfo> named = quantities_named(bound.metric);
  const bool of_shares =
      std::all_of(named.begin(), named.end(), [](const QuantityInfo& info) { return info.unit == "fraction"; });
  const auto limit = [&](const toml::node& node, const char* key, const char* what) {
    if (!of_shares) {
      if (node.is_string() && node.as_string()->get().ends_with('%'))
        fail(node, fmt::format("{} = '{}': {} is no share, so it has no percent", key, node.as_string()->get(),
                               bound.metric));
      return number(node, key);
    }
    const double value = share(node, key);
    if (value < 0)
      fail(node,
           fmt::format("{} = {}: {} is a share, which is never below 0", key, written(node, value), bound.metric));
    if (value > 1)
      experiment_.notes.push_back(fmt::format("{}: the bound on {} can never {}: {} = {}", location_text(node.source()),
                                              bound.metric, what, key, above_every_share(value, written(node, value))));
    return value;
  };
  if (max) bound.max = limit(*max, "max", "be broken");
  if (min) bound.min = limit(*min, "min", "hold");
  at(table.source(), [&] { check_bound(bound); });
  bound.location = location_text(table.source());
  experiment_.bounds.push_back(std::move(bound));
}

Conditions PromiseReader::read_conditions(const toml::node& node, const std::string& name) {
  Conditions conditions;
  where_ = &conditions;
  read_settings(table(node, name), "", [this](const auto&... value) { condition(value...); });
  where_ = nullptr;
  return conditions;
}

void PromiseReader::condition(const std::string& name, const toml::node& value) {
  const Setting& row = find_setting(name);
  if (where_->contains(name)) fail(value, fmt::format("where names {} twice", name));
  // A list is a list of values, except for settings that are points or lists, where a list of numbers is one value.
  const bool many =
      value.is_array() && !(row.is_of_numbers() && !value.as_array()->empty() && value.as_array()->front().is_number());
  const std::vector<const toml::node*> nodes = many ? list(value, name) : std::vector<const toml::node*>{&value};
  for (const toml::node* node : nodes) {
    const std::string text = canonical(row, *node);
    const std::vector<std::string> known = values_of(row);
    if (std::find(known.begin(), known.end(), text) == known.end())
      fail(*node, fmt::format("no point has {} = {}; it is {}", name, text, fmt::join(known, " | ")));
    (*where_)[name].push_back(text);
  }
}
std::vector<std::string> PromiseReader::values_of(const Setting& row) const {
  for (const Swept& swept : experiment_.swept)
    if (swept.name == row.name) return swept.values;
  return {row.get(experiment_.base)};
}

// ---- [let] [[law]]

// Reads a formula, or a number as a formula.
std::string PromiseReader::formula(const toml::node& node, const std::string& name) const {
  if (node.is_number()) return fmt::format("{}", number(node, name));
  const std::string text = string(node, name);
  at(node.source(), [&] { Formula read(text); });
  return text;
}

void PromiseReader::read_law(const toml::table& table) {
  Law law;
  const auto relate = [&](const Item& item, LawRelation relation) {
    if (!law.predicted.empty()) fail(item.where, "a law has one of equals, at_most and at_least");
    law.predicted = formula(*item.node, item.key);
    law.relation = relation;
  };
  for (const Item& item : items(table)) {
    if (item.key == "name")
      law.name = string(*item.node, "name");
    else if (item.key == "says")
      law.says = string(*item.node, "says");
    else if (item.key == "found")
      law.found = string(*item.node, "found");
    else if (item.key == "measured")
      law.measured = formula(*item.node, "measured");
    else if (item.key == "equals")
      relate(item, LawRelation::equal);
    else if (item.key == "at_most")
      relate(item, LawRelation::at_most);
    else if (item.key == "at_least")
      relate(item, LawRelation::at_least);
    else if (item.key == "within")
      law.within = number(*item.node, "within");
    else if (item.key == "slack")
      law.slack = formula(*item.node, "slack");
    else if (item.key == "join")
      law.join = one_of(*item.node, "join", key_choices("law", "join"));
    else if (item.key == "over")
      law.over = string(*item.node, "over");
    else if (item.key == "where")
      law.where = read_conditions(*item.node, "where");
    else if (item.key == "against")
      law.against = read_conditions(*item.node, "against");
    else
      unknown(item, "key", key_names("law"), "law.");
  }
  law.let = experiment_.let;
  at(table.source(), [&] { check_law(law); });
  if (!experiment_.curve_enabled)
    for (const std::string& name : curve_names(law))
      fail(table, fmt::format("'{}' is read off the bias curve, and curve.enabled is false", name));
  for (const Law& other : experiment_.laws)
    if (other.name == law.name) fail(table, fmt::format("two laws have the name '{}'", law.name));
  if (!law.over.empty() && values_of(find_setting(law.over)).size() < 2)
    fail(table, fmt::format("a slope over {}, which has only one value; sweep it", law.over));
  law.location = location_text(table.source());
  experiment_.laws.push_back(std::move(law));
}

void PromiseReader::read_let(const toml::table& table) {
  for (const Item& item : items(table)) {
    for (const auto& [name, text] : experiment_.let)
      if (name == item.key) fail(item.where, fmt::format("let defines '{}' twice", name));
    experiment_.let.emplace_back(item.key, formula(*item.node, "let." + item.key));
  }
}

void PromiseReader::read_laws(const toml::node& node) {
  if (!node.is_array() || !node.is_array_of_tables()) fail(node, "laws are written as [[law]], one for each");
  for (const toml::node& element : *node.as_array()) read_law(*element.as_table());
}

}  // namespace noonmark
