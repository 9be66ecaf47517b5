#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/definition/experiment_keys.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "scenes/builtin.h"
#include "technique/setting_json.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

using Json = nlohmann::ordered_json;
using Kind = ExperimentKey::Kind;

Json reference(const std::string& name) { return {{"$ref", "#/definitions/" + name}}; }

Json any_of(std::initializer_list<Json> allowed) { return {{"anyOf", Json(std::vector<Json>(allowed))}}; }

bool is_number(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

Json plain_form_of(const Setting& row) {
  switch (row.type) {
    case ValueType::integer:
    case ValueType::real: {
      Json form = {{"type", row.type == ValueType::integer ? "integer" : "number"}};
      if (std::isfinite(row.min)) form["minimum"] = row.min;
      if (std::isfinite(row.max)) form["maximum"] = row.max;
      return form;
    }
    case ValueType::flag:
      return {{"type", "boolean"}};
    case ValueType::choice: {
      Json words = Json::array();
      for (std::string_view choice : row.choices) {
        words.push_back(choice);
        if (is_number(choice)) words.push_back(std::stoll(std::string(choice)));  // format = 16
      }
      return {{"enum", words}};
    }
    case ValueType::text:
      return {{"type", "string"}, {"minLength", 1}};
    case ValueType::point:
      return any_of({{{"type", "array"},
                      {"items", {{"type", "number"}, {"minimum", row.min}, {"maximum", row.max}}},
                      {"minItems", 3},
                      {"maxItems", 3}},
                     {{"type", "string"}, {"pattern", "^[^,]+,[^,]+,[^,]+$"}}});
    case ValueType::list:
    case ValueType::whole_list:
    case ValueType::real_list: {
      const char* const type = row.type == ValueType::whole_list ? "integer" : "number";
      const Json number = {{"type", type}, {"minimum", row.min}, {"maximum", row.max}};
      return any_of({{{"type", "array"}, {"items", number}, {"minItems", 1}},
                     number,
                     {{"type", "string"}, {"pattern", "^[^,]+(,[^,]+)*$"}}});
    }
  }
  return {};
}

Json form_of(const Setting& row) {
  if (row.name == "scene.name") {
    Json names = Json::array();
    for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
    return any_of({{{"enum", names}}, {{"type", "string"}, {"pattern", "\\.([gG][lL][tT][fF]|[gG][lL][bB])$"}}});
  }
  return row.may_be_auto ? any_of({plain_form_of(row), {{"const", "auto"}}}) : plain_form_of(row);
}

Json described(Json form, const std::string& help) {
  form["description"] = help;
  return form;
}

std::string help_of(const Setting& row) { return row.help + " " + row.range_with_unit(); }

Json closed(Json properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

// The settings as a table: "map": {"resolution": ...}, and for tables of settings of all groups also "map.resolution",
// which TOML writes as a quoted key.
template <class Form>
Json settings_tables(const Form& form, bool quoted_names) {
  std::map<std::string, Json> groups;
  std::vector<std::string> order;
  Json flat = Json::object();
  for (const Setting& row : settings_table()) {
    const size_t dot = row.name.find('.');
    const std::string group(row.name.substr(0, dot)), name(row.name.substr(dot + 1));
    if (!groups.contains(group)) order.push_back(group);
    groups[group][name] = form(row);
    flat[std::string(row.name)] = form(row);
  }
  Json all = quoted_names ? flat : Json::object();
  for (const std::string& group : order) all[group] = closed(groups[group]);
  return all;
}

Json swept_form(const Setting& row) {
  const Json list = {{"type", "array"},
                     {"items", reference("setting " + std::string(row.name))},
                     {"minItems", 1},
                     {"uniqueItems", true}};
  const bool has_range = row.type == ValueType::integer || row.type == ValueType::real;
  return described(has_range ? any_of({list, reference("range")}) : list, help_of(row));
}

Json condition_form(const Setting& row) {
  const Json value = reference("setting " + std::string(row.name));
  return described(any_of({value, {{"type", "array"}, {"items", value}, {"minItems", 1}}}), help_of(row));
}

// A share in percent.
Json percent_form() { return {{"type", "string"}, {"pattern", "^[0-9.]+([eE][+-]?[0-9]+)? *%$"}}; }

Json list_form(const Json& items, bool each_once) {
  Json form = {{"type", "array"}, {"items", items}, {"minItems", 1}};
  if (each_once) form["uniqueItems"] = true;
  return form;
}

std::string with_bars(const std::vector<std::string_view>& words) { return fmt::format("{}", fmt::join(words, " | ")); }

struct Form {
  std::string words;
  Json schema;
};

Form form_of(const ExperimentKey& key) {
  const std::string name(key.name);
  switch (key.kind) {
    case Kind::text:
      return {"text", {{"type", "string"}}};
    case Kind::names: {
      const Json one = key.choices.empty() ? Json{{"type", "string"}} : Json{{"enum", key.choices}};
      return {key.choices.empty() ? "a list of texts" : "a list of " + with_bars(key.choices),
              {{"type", "array"}, {"items", one}, {"uniqueItems", true}}};
    }
    case Kind::choice:
      return {with_bars(key.choices), {{"enum", key.choices}}};
    case Kind::flag:
      return {"true | false", {{"type", "boolean"}}};
    case Kind::number:
      if (key.least == any_number) return {"a number", {{"type", "number"}}};
      return {fmt::format("a number, {} or more", key.least), {{"type", "number"}, {"minimum", key.least}}};
    case Kind::fraction:
      return {"0 ... 1, or text with %",
              any_of({{{"type", "number"}, {"minimum", 0}, {"maximum", 1}}, percent_form()})};
    case Kind::limit:
      return {"a number; of a share also text with %", any_of({{{"type", "number"}}, percent_form()})};
    case Kind::whole:
      return {fmt::format("a whole number, {} ... {}", key.least, key.most),
              {{"type", "integer"}, {"minimum", key.least}, {"maximum", key.most}}};
    case Kind::quantities:
      return {"a list of metrics or quantities of the curve", list_form(reference("quantity"), true)};
    case Kind::pattern:
      return {"a metric, a quantity of the curve, or a pattern",
              any_of({reference("quantity"), {{"type", "string"}, {"pattern", "[*?]"}}})};
    case Kind::metric:
      return {"a metric", reference("metric")};
    case Kind::formula:
      return {"a formula or a number", {{"type", {"string", "number"}}}};
    case Kind::formulas:
      return {"a table of formulas", {{"type", "object"}, {"additionalProperties", {{"type", {"string", "number"}}}}}};
    case Kind::setting: {
      Json names = Json::array();
      for (const Setting& row : settings_table()) names.push_back(row.name);
      return {"a setting", {{"enum", names}}};
    }
    case Kind::sweep:
      return {"a table of settings, each with a list or a range", reference("sweep")};
    case Kind::conditions:
      return {"a table of settings, each with a value or a list", reference("conditions")};
    case Kind::amounts:
      return {"a list of numbers, or a range",
              any_of({list_form({{"type", "number"}, {"minimum", 0}}, false), reference("range")})};
    case Kind::table:
      return {fmt::format("a table [{}]", name), reference(name)};
    case Kind::tables:
      return {fmt::format("tables [[{}]]", name), list_form(reference(name), false)};
    case Kind::lights:
      return {"\"all\", \"parts\", a list of names, or tables [[lights]]",
              any_of({{{"enum", {"all", "parts"}}},
                      list_form({{"type", "string"}}, true),
                      list_form(reference("lights"), false)})};
  }
  return {};
}

// in_part: of the table "root", the keys of a part.
Json table_of(std::string_view table, bool in_part = false) {
  Json properties = Json::object(), required = Json::array();
  for (const ExperimentKey& key : experiment_keys(table)) {
    if (!(in_part ? key.in_part : key.in_root)) continue;
    properties[std::string(key.name)] = described(form_of(key).schema, std::string(key.help));
    if (key.required) required.push_back(key.name);
  }
  Json form = closed(std::move(properties));
  if (!required.empty()) form["required"] = required;
  return form;
}

// One of these keys, or with `at_least_one` also several.
Json needs(std::initializer_list<const char*> keys, const char* how) {
  std::vector<Json> required;
  for (const char* key : keys) required.push_back({{"required", {key}}});
  return {{how, required}};
}

// The file, or a part: its keys, and the tables of the settings.
Json experiment_table(bool in_part) {
  Json form = table_of("root", in_part);
  const Json groups =
      settings_tables([](const Setting& row) { return reference("setting " + std::string(row.name)); }, false);
  for (const auto& [group, settings] : groups.items()) form["properties"][group] = settings;
  form["properties"]["scene"] = any_of({groups["scene"], reference("setting scene.name")});
  return form;
}

}  // namespace

std::string taken_by(const ExperimentKey& key) { return form_of(key).words; }

std::string experiment_schema() {
  const Settings defaults;
  Json definitions = Json::object();
  for (const Setting& row : settings_table()) {
    Json form = described(form_of(row), help_of(row));
    if (const std::string text = row.get(defaults); text != "inf") form["default"] = setting_json(row, text);
    definitions["setting " + std::string(row.name)] = form;
  }
  Json metrics = Json::array(), quantities = Json::array();
  for (const Metric& row : metric_rows()) {
    metrics.push_back(row.name);
    for (const std::string& name : also_names(row)) metrics.insert(metrics.end(), {name, stored_name(name)});
  }
  quantities = metrics;
  for (const CurveQuantity& quantity : curve_quantities()) quantities.push_back(quantity.name);
  definitions["metric"] = {{"enum", metrics}};
  definitions["quantity"] = {{"enum", quantities}};
  definitions["sweep"] = closed(settings_tables(swept_form, true));
  definitions["conditions"] = closed(settings_tables(condition_form, true));
  for (const char* table : {"plot", "answer", "curve", "phase", "frame", "bound", "law", "range"})
    definitions[table] = table_of(table);
  definitions["bound"].update(needs({"max", "min"}, "anyOf"));
  definitions["law"].update(needs({"equals", "at_most", "at_least"}, "oneOf"));
  definitions["part"] = experiment_table(true);
  definitions["lights"] = table_of("lights");
  const Json settings =
      settings_tables([](const Setting& row) { return reference("setting " + std::string(row.name)); }, false);
  definitions["lights"]["properties"].update(settings);

  Json schema = {
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", "A Noonmark experiment"},
      {"description", "What to measure, and what to expect of the results. docs/reference/experiment.md explains it."}};
  schema.update(experiment_table(false));
  // In a file with parts these stand inside a part.
  schema["if"] = {{"required", {"part"}}};
  schema["then"] = {{"not", needs({"sweep", "over", "bound", "law"}, "anyOf")}};
  schema["definitions"] = definitions;
  return readable_json(schema) + "\n";
}

}  // namespace noonmark
