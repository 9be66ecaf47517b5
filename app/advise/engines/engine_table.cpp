// The table of engines, and what is said of its rows.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "app/advise/engines/engine.h"

namespace noonmark {

// clang-format off
namespace three_engine { Engine engine(); }
namespace babylon_engine { Engine engine(); }
namespace playcanvas_engine { Engine engine(); }
namespace godot_engine { Engine engine(); }
namespace bevy_engine { Engine engine(); }
namespace filament_engine { Engine engine(); }
namespace urp_engine { Engine engine(); }
namespace opengl_engine { Engine engine(); }
// clang-format on

std::vector<Engine> engines() {
  return {three_engine::engine(), babylon_engine::engine(),  playcanvas_engine::engine(), godot_engine::engine(),
          bevy_engine::engine(),  filament_engine::engine(), urp_engine::engine(),        opengl_engine::engine()};
}

std::vector<EngineSource> sources_of(const Engine& engine) {
  std::vector<EngineSource> all;
  std::string repository, commit;
  for (std::string_view rest = engine.sources; !rest.empty();) {
    const std::string_view row = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(row.size() + 1, rest.size()));
    const size_t space = row.find(' ');
    if (row.starts_with('@')) repository = row.substr(1, space - 1), commit = row.substr(space + 1);
    if (row.empty() || row.starts_with('@') || repository.empty()) continue;
    const size_t colon = std::min(row.find(':'), space);
    const int line = colon < space ? std::stoi(std::string(row.substr(colon + 1, space - colon - 1))) : 0;
    all.push_back({repository, commit, std::string(row.substr(0, colon)), line, std::string(row.substr(space + 1))});
  }
  return all;
}

std::string place_of(const EngineSource& source) {
  return source.path + (source.line > 0 ? fmt::format(":{}", source.line) : "");
}

std::string engine_word(std::string_view engine) {
  std::string word;
  for (const char c : engine) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (!upper && !(c >= 'a' && c <= 'z')) break;  // three.js, Unity URP
    word += static_cast<char>(upper ? c - 'A' + 'a' : c);
  }
  return word;
}

Engine engine_of(std::string_view word) {
  for (Engine& engine : engines())
    if (engine_word(engine.name) == word) return std::move(engine);
  throw std::logic_error("no engine has this word");
}

std::string engine_of_word(std::string_view word) { return std::string(engine_of(word).name); }

std::vector<std::string> engine_words() {
  std::vector<std::string> words;
  for (const Engine& engine : engines()) words.push_back(engine_word(engine.name));
  return words;
}

std::vector<EngineField> engine_fields() {
  std::vector<EngineField> rows;
  for (const Engine& engine : engines()) {
    const std::vector<EngineSource> sources = sources_of(engine);
    for (LightKind kind : {LightKind::directional, LightKind::spot, LightKind::point})
      for (const EngineKnob& knob : engine.biases(kind)) {
        if (knob.unit.empty()) continue;  // a formula of OpenGL's shader
        EngineField row{std::string(engine.name),
                        std::string(engine.version),
                        std::string(kind_of_light(kind).name()),
                        std::string(knob.field),
                        std::string(knob.unit),
                        place_name(knob.target()),
                        {}};
        if (knob.source > 0) row.source = place_of(sources.at(static_cast<size_t>(knob.source) - 1));
        const auto same = std::find_if(rows.begin(), rows.end(), [&](const EngineField& other) {
          return other.engine == row.engine && other.field == row.field && other.unit == row.unit &&
                 other.place == row.place;
        });
        if (same == rows.end())
          rows.push_back(row);
        else
          same->light += ", " + row.light;
      }
  }
  return rows;
}

std::vector<std::pair<std::string, std::vector<EngineSource>>> engine_sources() {
  std::vector<std::pair<std::string, std::vector<EngineSource>>> all;
  for (const Engine& engine : engines())
    if (std::vector<EngineSource> read = sources_of(engine); !read.empty())
      all.emplace_back(engine.name, std::move(read));
  return all;
}

}  // namespace noonmark
