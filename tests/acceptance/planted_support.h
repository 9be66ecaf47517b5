// A measurement with a defect planted in its OpenGL part: the truth is computed from the settings, but the renderer
// gets something else. The stages are the program's (app/stages.h).
//
//   Figures sound = measure(settings), broken = measure(settings, {.drawn_map = [](auto& frame, auto& map) { ... }});
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "app/memory_estimate.h"
#include "app/stages.h"
#include "compare/ladder/measure.h"

namespace noonmark::planted {

struct Defect {
  gl::ShaderReplacements shaders{};                               // of the map's pass, the lookup and the probe
  std::function<void(Scene&)> drawn_scene{};                      // changes the scene that is drawn into the map
  std::function<void(LightFrame&, MapSettings&)> drawn_map{};     // changes the frame and settings of the map
  std::function<void(BiasSettings&)> drawn_bias{};                // changes the bias of the map (polygon offset)
  std::function<Image<float>(const Image<float>&)> edited_map{};  // changes the pixels of the map before the lookup
  bool every_map = false;                                         // the wrap mode of drawn_map applies to R4's map too
  std::function<void(Settings&)> asked{};                         // changes the settings of the lookup
  std::function<void(BiasSettings&)> believed_bias{};             // changes the bias that the ladder assumes
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

inline Figures measure(const Settings& settings, const Defect& defect = {}) {
  // The receivers are not under test, so a renderer without a defect makes them.
  gl::Renderer sound(gl::DebugMode::fatal);
  const SceneStage loaded = load_scene(settings, sound);
  const Scene& scene = *loaded.scene;
  const LightFrame frame = make_light_frame(scene, settings);
  const ViewStage view = take_view(sound, scene, settings.view);
  const TruthStage truth = trace_truth(*loaded.tracer, view, frame, {}, settings.truth);

  gl::Renderer renderer(gl::DebugMode::fatal, defect.shaders);
  Scene drawn_scene = scene;
  if (defect.drawn_scene) defect.drawn_scene(drawn_scene);
  renderer.load_scene(drawn_scene);
  renderer.load_receivers(view.receivers, view.camera.eye_m);
  LightFrame drawn_frame = frame;
  Settings drawn = settings;
  if (defect.drawn_map) defect.drawn_map(drawn_frame, drawn.map);
  if (defect.drawn_bias) defect.drawn_bias(drawn.bias);
  MapStage map = draw_map(renderer, drawn_scene, {drawn, drawn_frame, Bias(drawn.bias)});
  if (defect.edited_map) {
    map.map = renderer.upload_map(defect.edited_map(map.depth), settings.map);
    map.depth = renderer.read_map(map.map);
  }

  BiasSettings believed = settings.bias;
  if (defect.believed_bias) defect.believed_bias(believed);
  const PointSetup point{settings, frame, Bias(believed)};
  Settings asked = settings;
  if (defect.asked) defect.asked(asked);
  const MapSettings& uploaded = defect.every_map ? drawn.map : settings.map;
  LookupStage lookup = prepare_lookup(renderer, sound, *loaded.tracer, view, truth, point, most_strip_bytes);
  lookup.exact_map = renderer.upload_map(lookup.exact_depth, uploaded);
  const ShownStage shown = show(renderer, map.map, lookup, truth, point, asked, uploaded);
  Climbed climbed = climb_strips(renderer, lookup, view, truth, map.depth, shown, point, nullptr);
  const Image<float> occluders =
      loaded.tracer->occluder_distance(view.receivers, frame, peter_panning_mask(climbed.ladder));
  Figures figures = measure_ladder(
      {climbed.ladder, view.receivers, frame, lookup.probe, point.bias, lookup.edge_distance_texels, occluders});
  figures.merge(climbed.soundness);
  return figures;
}

}  // namespace noonmark::planted
