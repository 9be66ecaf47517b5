// The texts of engines' rows: written with what their words stand for, and read again.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/advise/engines/engine.h"

namespace noonmark {
namespace {

std::string numbers(glm::dvec3 v) { return fmt::format("{}, {}, {}", number(v.x), number(v.y), number(v.z)); }

std::string literal(const EngineText& of, double value) {
  return of.engine.literal ? of.engine.literal(value) : number(value);
}

std::string said(bool holds) { return holds ? "true" : ""; }

std::string fitted_text(const EngineText& of) {
  const AdvicePlace& place = of.place;
  std::string text = fmt::format(
      "map.extent_m = {}, near and far: the engine fits the map to the camera. With {} = {}, which reaches what is "
      "farthest in view, it is {} m wide for a picture of this shape and angle of view, and a texel {} m, for which "
      "the bias is computed; a wider picture needs other numbers.",
      number(place.frame.extent_m), of.engine.knob_of("map.reach_m")->field, number(*place.map.reach_m),
      number(place.map.extent_m), number(place.map.texel_m));
  if (place.map.coarser)
    text += fmt::format(
        " The recommended texel of {} m needs cascades here, which these lines do not lay: the engine's largest map "
        "has {} texels.",
        number(place.texel_m), place.map.resolution);
  return text;
}

// The words of all engines; conditions are empty if they do not hold.
std::optional<std::string> shared_word(std::string_view word, const EngineText& of) {
  const AdvicePlace& place = of.place;
  const bool sun = place.kind() == LightKind::directional, point = place.kind() == LightKind::point;
  if (word == "directional") return said(sun && !of.cascades);
  if (word == "local") return said(!sun);
  if (word == "spot") return said(place.kind() == LightKind::spot);
  if (word == "point") return said(point);
  if (word == "cascades") return said(of.cascades);
  if (word == "blended") return said(of.cascades && of.cascades->blend > 0);
  if (word == "two") return said(of.cascades && of.cascades->count() == 2);
  if (word == "fitted") return said(place.map.reach_m.has_value());
  if (word == "fit") return fitted_text(of);
  if (word == "width") return number(place.map.extent_m);
  if (word == "atlas") return fmt::to_string(2 * of.cascades->laid.map.resolution);
  if (word == "Light") return point ? "Point" : sun ? "Directional" : "Spot";
  if (word == "placed")  // an engine that fits its map lets the sun stand where it does
    return fmt::format(
        "{} These lines set the light's {}. The model stands where its file puts it, in the file's size.",
        of.engine.comment,
        of.cascades || of.engine.map.width_m ? "direction"
        : point                              ? "position"
                                             : "position and direction");
  if (word == "origin") return numbers(place.frame.origin_m);
  if (word == "forward") return numbers(place.frame.forward);
  if (word == "target") return numbers(place.frame.origin_m + place.frame.far_m * place.frame.forward);
  if (word == "cone") return literal(of, std::atan(place.cone_tan));
  if (word == "fov") return number(2 * std::atan(place.frame.tan_half_fov));
  if (word == "focus") return number(std::atan(place.frame.tan_half_fov) / std::atan(place.cone_tan));  // of the cone
  if (word == "cull") return find_setting("map.cull").get(place.settings);
  if (word != "drawn") return std::nullopt;
  return of.engine.culled(place) == CulledFaces::back ? "front faces alone, as of materials with one side"
                                                      : "both faces, because no material here has one side";
}

std::string setting_text(const EngineText& of, std::string_view name, const EngineKnob* knob) {
  const Setting& row = find_setting(name);
  const std::string text = row.get(laid_settings(of));
  if (const std::vector<std::string_view>* words = of.engine.choices_of(name))
    return std::string(
        words->at(static_cast<size_t>(std::find(row.choices.begin(), row.choices.end(), text) - row.choices.begin())));
  if (row.type != ValueType::integer && row.type != ValueType::real) return text;
  double value = std::stod(text);
  if (knob) value = std::max(value / knob->of_one(of.place), knob->least);
  return row.type == ValueType::integer ? fmt::format("{}", std::llround(value)) : literal(of, value);
}

std::string text_of(const EngineText& of, std::string_view word) {
  if (of.engine.own)
    if (std::optional<std::string> own = of.engine.own(word, of)) return *own;
  const EngineKnob* knob = of.engine.knob_of_word(word, of.place.kind());
  if (const auto shared = knob ? std::nullopt : shared_word(word, of)) return *shared;
  return setting_text(of, knob ? knob->is : word, knob);
}

// The next word in braces from `from` on: its place and length with the braces; npos if there is none.
std::pair<size_t, size_t> next_word(std::string_view text, size_t from) {
  for (size_t open = text.find('{', from); open != text.npos; open = text.find('{', open + 1)) {
    const size_t close =
        text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_. ", open + 1);
    if (close != text.npos && text[close] == '}' && text[open + 1] != ' ') return {open, close + 1 - open};
  }
  return {text.npos, 0};
}

// Takes "?word " or "?!word " from the front; empty if there is none.
std::string take_condition(std::string& row) {
  if (!row.starts_with('?')) return "";
  const size_t end = row.find(' ');
  std::string condition = row.substr(1, end - 1);
  row.erase(0, end + 1);
  return condition;
}

std::string without_comment(const Engine& engine, std::string_view line) {
  const size_t at = line.find(fmt::format("  {} ", engine.comment));
  return std::string(line.substr(0, at));
}

}  // namespace

std::vector<std::string> rows_of(std::string_view text) {
  std::string whole(text), row;
  for (size_t at = whole.find("\\\n"); at != whole.npos; at = whole.find("\\\n", at)) whole.erase(at, 2);
  std::vector<std::string> rows;
  for (std::istringstream in(whole); std::getline(in, row);)
    if (!row.empty()) rows.push_back(row);
  return rows;
}

Settings laid_settings(const EngineText& of) {
  if (of.cascades) return of.cascades->laid;
  const AdvicePlace& place = of.place;
  Settings laid = place.settings;
  laid.map.resolution = place.map.resolution;
  laid.map.reach_m = place.map.reach_m;
  laid.map.extent_m = place.frame.extent_m;
  laid.map.near_m = place.frame.near_m;
  laid.map.far_m = place.frame.far_m;
  return laid;
}

std::vector<std::string> text_lines(std::string_view text, const EngineText& of) {
  std::vector<std::string> all;
  for (std::string& row : rows_of(text)) {
    bool stands = true;
    for (std::string word = take_condition(row); !word.empty() && stands; word = take_condition(row)) {
      const bool unless = word.front() == '!';
      stands = text_of(of, std::string_view(word).substr(unless ? 1 : 0)).empty() == unless;
    }
    if (!stands) continue;
    std::string line;
    size_t at = 0;
    for (auto [open, size] = next_word(row, 0); open != row.npos; std::tie(open, size) = next_word(row, at)) {
      line += row.substr(at, open - at) + text_of(of, std::string_view(row).substr(open + 1, size - 2));
      at = open + size;
    }
    for (std::string& one : rows_of(line + row.substr(at))) all.push_back(std::move(one));
  }
  return all;
}

bool read_line(const Engine& engine, std::string row, std::string_view whole_line, EngineValues& values) {
  const std::string line = without_comment(engine, whole_line);
  while (!take_condition(row).empty()) continue;
  row = without_comment(engine, row);
  size_t at = 0, read = 0;
  const auto literal_fits = [&](size_t end) { return line.compare(read, end - at, row, at, end - at) == 0; };
  for (auto [open, size] = next_word(row, 0); open != row.npos; std::tie(open, size) = next_word(row, at)) {
    if (!literal_fits(open)) return false;
    read += open - at;
    at = open + size;
    const std::string after = row.substr(at, next_word(row, at).first - at);
    const size_t end = after.empty() ? line.size() : std::min(line.find(after, read), line.size());
    const auto [place, added] = values.try_emplace(row.substr(open + 1, size - 2), line.substr(read, end - read));
    if (!added && place->second != line.substr(read, end - read)) return false;
    read = end;
  }
  return literal_fits(row.size()) && line.size() - read == row.size() - at;
}

std::string number(double value) { return fmt::format("{:.6g}", value == 0 ? 0.0 : value); }  // -0 is written as 0

}  // namespace noonmark
