// A measurement with a defect planted in its OpenGL part: the truth is computed from the settings, but the renderer
// gets something else. The Workbench measures, with stages (measure/stages.h) of which some are replaced.
//
//   Figures sound = measure(settings), broken = measure(settings, {.drawn_map = [](auto& frame, auto& map) { ... }});
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "measure/workbench.h"

namespace noonmark::planted {

struct Defect {
  gl::ShaderReplacements shaders{};                               // of the map's pass, the lookup and the probe
  std::function<void(Scene&)> drawn_scene{};                      // changes the scene that is drawn into the map
  std::function<void(LightFrame&, MapSettings&)> drawn_map{};     // changes the frame and settings of the map
  std::function<void(BiasSettings&)> drawn_bias{};                // changes the bias of the map (polygon offset)
  std::function<Image<float>(const Image<float>&)> edited_map{};  // changes the pixels of the map before the lookup
  std::function<void(Settings&)> asked{};                         // changes the settings of the lookup
  std::function<void(BiasSettings&)> claimed_bias{};  // the point claims this bias; the lookup keeps its own
};

using Figures = std::map<std::string, double>;

// The program's own text of a shader in which every `from` is replaced by `to`. Throws if the shader does not contain
// `from`, because then no defect would be planted and the test would prove nothing.
inline gl::ShaderReplacements patched(const std::string& file, const std::string& from, const std::string& to) {
  std::string text = gl::shader_file(file);
  size_t at = text.find(from), found = 0;
  for (; at != text.npos; at = text.find(from, at + to.size()), ++found) text.replace(at, from.size(), to);
  if (found == 0) throw std::logic_error(file + " has no '" + from + "'; mend the planted defect");
  return {{file, text}};
}

// The program's stages, but the renderer is given the defect.
class DefectivePipeline : public Pipeline {
 public:
  DefectivePipeline(const Settings& settings, const Defect& defect) : defect_(defect), asked_(settings) {
    if (defect_.asked) defect_.asked(asked_);
  }

  // The receivers are not under test, so a renderer without replaced shaders makes them.
  ViewStage take_view(gl::Renderer&, const Scene& scene, const ViewSettings& settings) override {
    gl::Renderer sound(gl::DebugMode::fatal);
    sound.load_scene(scene);
    return Pipeline::take_view(sound, scene, settings);
  }

  MapStage draw_maps(gl::Renderer& renderer, const Scene& scene, std::span<const Technique> techniques) override {
    Scene drawn_scene = scene;
    if (defect_.drawn_scene) defect_.drawn_scene(drawn_scene);
    renderer.load_scene(drawn_scene);
    std::vector<Technique> drawn;
    for (const Technique& technique : techniques) {
      LightFrame frame = technique.frame;
      Settings settings = technique.settings;
      if (defect_.drawn_map) defect_.drawn_map(frame, settings.map);
      if (defect_.drawn_bias) defect_.drawn_bias(settings.bias);
      drawn.emplace_back(settings, frame);
    }
    MapStage made = Pipeline::draw_maps(renderer, drawn_scene, drawn);
    if (defect_.edited_map)
      made.map.emplace(uploaded(renderer, *made.map, techniques, techniques.front().settings.map, defect_.edited_map));
    return made;
  }

  // A map keeps the wrap mode that it was made with, so another wrap mode needs another map.
  MapResults look_up(gl::Renderer& renderer, const gl::ShadowMap& map, std::span<const Technique> techniques) override {
    std::vector<Technique> asked;
    for (const Technique& technique : techniques) {
      asked.emplace_back(asked_, technique.frame);
      asked.back().cascade = technique.cascade;
    }
    if (asked_.map.wrap == techniques.front().settings.map.wrap) return Pipeline::look_up(renderer, map, asked);
    return Pipeline::look_up(renderer, uploaded(renderer, map, techniques, asked_.map, {}), asked);
  }

 private:
  // The map once more, with these settings, and edited.
  static gl::ShadowMap uploaded(gl::Renderer& renderer, const gl::ShadowMap& map, std::span<const Technique> techniques,
                                const MapSettings& settings,
                                const std::function<Image<float>(const Image<float>&)>& edited) {
    if (techniques.size() != 1) throw std::logic_error("a defect of one map's texels, planted in cascades");
    const Image<float> depth = renderer.read_map(map);
    return renderer.upload_map(edited ? edited(depth) : depth, settings, techniques.front().frame.map_shape());
  }

  const Defect& defect_;
  Settings asked_;
};

inline Figures measure(const Settings& settings) {
  return Workbench(gl::DebugMode::fatal).measure(settings, std::nullopt).record.metrics;
}

// The same, measured once in a process for the same settings: most defects are planted in one of a few points.
inline const Figures& sound_figures(const Settings& settings) {
  static std::map<std::map<std::string, std::string>, Figures> measured;
  const auto values = settings_map(settings);
  const auto found = measured.find(values);
  return found != measured.end() ? found->second : measured.emplace(values, measure(settings)).first->second;
}

inline Figures measure(const Settings& settings, const Defect& defect) {
  Settings claimed = settings;
  if (defect.claimed_bias) defect.claimed_bias(claimed.bias);
  Workbench bench(gl::DebugMode::fatal, defect.shaders, std::make_unique<DefectivePipeline>(settings, defect));
  return bench.measure(claimed, std::nullopt).record.metrics;
}

}  // namespace noonmark::planted
