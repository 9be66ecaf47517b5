#include "app/definition/promise_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "app/definition/frame_metrics.h"
#include "base/error.h"
#include "compare/results/quantities.h"

namespace noonmark {

void PromiseReader::read_bounds(const toml::node& node) {
  for (const toml::table* one : tables(node, "bounds", "bound")) read_bound(*one);
}

void PromiseReader::read_bound(const toml::table& table) {
  Bound bound;
  const toml::node *max = nullptr, *min = nullptr;  // read when the metric is known
  read_keys(table, keys_of(bound), "bound.", "", [&](const ExperimentKey& key, const Item& item) {
    if (key.name == "max") max = item.node;
    if (key.name == "min") min = item.node;
    if (key.name == "where") bound.where = read_conditions(*item.node, "where");
    if (key.name != "metric") return;
    const std::vector<QuantityInfo> named = at(item.node->source(), [&] { return quantities_named(bound.metric); });
    if (!experiment_.frames.empty()) at(item.node->source(), [&] { require_frame_metric(bound.metric); });
    const auto of_curve = [](const QuantityInfo& info) { return info.of_curve; };
    if (!experiment_.curve_enabled && std::all_of(named.begin(), named.end(), of_curve))
      fail(*item.node, fmt::format("'{}' is read off the bias curve, and curve.enabled is false", bound.metric));
  });
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

void PromiseReader::read_law(const toml::table& table) {
  constexpr std::pair<std::string_view, LawRelation> relations[] = {
      {"equals", LawRelation::equal}, {"at_most", LawRelation::at_most}, {"at_least", LawRelation::at_least}};
  Law law;
  read_keys(table, keys_of(law), "law.", "", [&](const ExperimentKey& key, const Item& item) {
    if (key.name == "where") law.where = read_conditions(*item.node, "where");
    if (key.name == "against") law.against = read_conditions(*item.node, "against");
    for (const auto& [name, relation] : relations) {
      if (key.name != name) continue;
      if (!law.predicted.empty()) fail(item.where, "a law has one of equals, at_most and at_least");
      law.predicted = formula(*item.node, item.key);
      law.relation = relation;
    }
  });
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
  for (const toml::table* one : tables(node, "laws", "law")) read_law(*one);
}

}  // namespace noonmark
