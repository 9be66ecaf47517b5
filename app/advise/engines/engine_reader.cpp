// TextLines and values of an engine, read back into settings by the rows that write them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/advise/engines/engine.h"
#include "base/error.h"

namespace noonmark {
namespace {

[[noreturn]] void refuse(const Engine& engine, std::string_view word, std::string_view why) {
  throw Error(ErrorKind::usage, fmt::format("{} of {} {}", word, engine.name, why));
}

double number_of(const Engine& engine, std::string_view word, std::string_view text) {
  double value = 0;
  const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (wrong != std::errc() || end != text.data() + text.size())
    refuse(engine, word, fmt::format("is no number: '{}'", text));
  return value;
}

double value_of(const Engine& engine, const EngineKnob& knob, std::string_view text) {
  const double value = number_of(engine, knob.word(), text);
  if (!(value >= knob.least && value <= knob.most))
    refuse(engine, knob.word(), fmt::format("= {}: it is {} to {}", text, number(knob.least), number(knob.most)));
  if (knob.step > 0 && std::fmod(value, knob.step) != 0)
    refuse(engine, knob.word(), fmt::format("= {}: it is a multiple of {}", text, number(knob.step)));
  return value;
}

// The settings of the map and of the lookup.
void take_map(const Engine& engine, const EngineKnob& knob, const std::string& text, const AdvicePlace& place,
              Settings& settings) {
  const Setting& row = find_setting(knob.is);
  if (const std::vector<std::string_view>* words = engine.choices_of(knob.is)) {
    const auto found = std::find(words->begin(), words->end(), text);
    if (found == words->end())
      refuse(engine, knob.word(), fmt::format("= {}: it is {}", text, fmt::join(*words, " or ")));
    return row.set(settings, row.choices[static_cast<size_t>(found - words->begin())]);
  }
  const double value = value_of(engine, knob, text) * knob.of_one(place);
  row.set(settings, row.type == ValueType::integer ? fmt::format("{:.0f}", value) : fmt::format("{}", value));
}

bool is_field(const Engine& engine, std::string_view word, LightKind kind) {
  const auto is_word = [&](const EngineFilterRow& row) { return row.parameter == word; };
  constexpr std::string_view others[] = {"filter", "lookup", "blurScale", "blurBoxOffset", "blurKernel"};
  return engine.knob_of_word(word, kind) || std::any_of(engine.filters.begin(), engine.filters.end(), is_word) ||
         std::find(std::begin(others), std::end(others), word) != std::end(others);
}

std::string fields_of(const Engine& engine, LightKind kind) {
  std::vector<std::string_view> words;
  for (const EngineKnob& knob : engine.knobs)
    if (knob.lights & light_bit(kind)) words.push_back(knob.word());
  return fmt::to_string(fmt::join(words, ", "));
}

// TextLines of an engine, which of them have been read, and what they said.
struct TextLines {
  const Engine& engine;
  LightKind kind;
  const std::vector<std::string>& lines;
  std::vector<bool> read = std::vector<bool>(lines.size());
  EngineValues values = {};

  // A bias is a number, and a choice one of its words.
  bool can_be(std::string_view word, std::string_view text) const {
    if (word.empty()) return text.find_first_not_of("0123456789+-.e") == text.npos;
    const EngineKnob* knob = engine.knob_of_word(word, kind);
    const std::vector<std::string_view>* words = knob ? engine.choices_of(knob->is) : nullptr;
    return !words || std::find(words->begin(), words->end(), text) != words->end();
  }

  // How many of a text's rows are lines. word: of {}.
  size_t take(std::string_view text, std::string_view word = {}) {
    size_t rows = 0;
    for (const std::string& row : rows_of(text))
      for (size_t i = 0; i < lines.size(); ++i) {
        EngineValues found;
        if (!read_line(engine, row, lines[i], found)) continue;
        if (!std::all_of(found.begin(), found.end(), [&](const auto& one) { return can_be(one.first, one.second); }))
          continue;
        for (const auto& [name, value] : found)
          if (const std::string key(name.empty() ? word : name); is_field(engine, key, kind)) values[key] = value;
        read[i] = true;
        ++rows;
      }
    return rows;
  }
};

}  // namespace

EngineValues read_values(std::string_view engine_word, const std::vector<std::string>& lines, LightKind kind,
                         std::vector<std::string>* unread) {
  const Engine engine = engine_of(engine_word);
  TextLines all{engine, kind, lines};
  all.take(engine.lines);
  for (size_t i = 0; i < engine.filters.size(); ++i)
    if (const EngineFilterRow& row = engine.filters[i];
        (row.lights & light_bit(kind)) && all.take(row.lines) == rows_of(row.lines).size())
      all.values["filter"] = fmt::to_string(i);
  for (const EngineLookupRow& row : engine.lookups)
    if (all.take(rows_of(row.lines).front()) > 0 && all.take(row.lines) > 0) all.values["lookup"] = row.kind;
  for (const EngineKnob& knob : engine.biases(kind)) all.take(knob.line, knob.word());
  for (size_t i = 0; unread && i < lines.size(); ++i)
    if (!all.read[i] && !lines[i].starts_with(engine.comment)) unread->push_back(lines[i]);
  return all.values;
}

Settings settings_of_values(std::string_view engine_word, const EngineValues& values, const Settings& condition,
                            const Scene& scene) {
  const Engine engine = engine_of(engine_word);
  const LightFrame given = make_light_frame(scene, condition);
  Settings settings = condition;
  settings.bias = {};
  settings.lookup.kind = values.contains("lookup") ? values.at("lookup") : "compare";
  const EngineFilterRow* filter = nullptr;
  for (const auto& [word, text] : values) {
    if (!is_field(engine, word, given.kind))
      refuse(engine, word,
             fmt::format("is no field; those of a {} light are {}", kind_of_light(given.kind).name(),
                         fields_of(engine, given.kind)));
    if (word == "filter") {
      const double row = number_of(engine, word, text);
      if (!(row >= 0 && row < static_cast<double>(engine.filters.size())))
        refuse(engine, word, fmt::format("= {}: it has {} filters, from 0", text, engine.filters.size()));
      filter = &engine.filters[static_cast<size_t>(row)];
    }
    const EngineKnob* knob = engine.knob_of_word(word, given.kind);
    const bool of_other_lookup = knob && knob->is.starts_with("lookup.") && !values.contains("lookup");
    if (knob && !knob->is_bias() && !of_other_lookup)
      take_map(engine, *knob, text, advice_place(condition, given, scene), settings);
  }
  for (const EngineLookupRow& row : engine.lookups)
    if (row.kind == settings.lookup.kind && row.read_blur) row.read_blur(values, settings);
  if (engine.map.width_m && settings.map.reach_m) settings.map.fit = MapFit::sphere;
  const LightFrame frame = make_light_frame(scene, settings);
  AdvicePlace place = advice_place(settings, frame, scene);
  place.map = engine_map(engine, place, settings.map.resolution);
  const EngineText of{engine, place};
  const auto parameter = filter ? values.find(std::string(filter->parameter)) : values.end();
  if (filter)
    place.filter =
        as_filter(*filter, parameter == values.end() ? 0 : number_of(engine, parameter->first, parameter->second), of);
  else if (std::optional<EngineFilter> made = as_lookup(engine, place))
    place.filter = *made;
  else
    place.filter.as = settings.filter;
  const std::vector<EngineKnob> knobs = engine.biases(given.kind);
  std::vector<std::vector<double>> metres;
  for (const EngineKnob& knob : knobs) {
    const auto found = values.find(std::string(knob.word()));
    metres.push_back({found == values.end() ? 0 : value_of(engine, knob, found->second) * knob.of_one(place)});
  }
  EngineAdvice advice;
  emulate(of, knobs, metres, advice);
  if (!advice.emulated)
    throw Error(ErrorKind::usage,
                fmt::format("no settings do what {} does with these values: {}", engine.name, advice.why_not_emulated));
  return *advice.emulated;
}

}  // namespace noonmark
