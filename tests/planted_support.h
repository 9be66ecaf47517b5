// The instrument with a defect planted in its OpenGL side: the truth believes the settings, the renderer is given
// something else. The wiring is app/workbench.cpp's.
//
//   Figures sound = measure(settings), broken = measure(settings, {.drawn_map = [](auto& frame, auto& map) { ... }});
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "compare/judge/soundness.h"
#include "compare/ladder/ladder.h"
#include "compare/ladder/measure.h"
#include "gl/renderer.h"
#include "raytrace/tracer.h"
#include "scenes/camera_fit.h"
#include "scenes/library.h"
#include "technique/setting_rules.h"

namespace noonmark::planted {

struct Defect {
  gl::ShaderReplacements shaders{};                               // of the map's pass, the lookup and the probe
  std::function<void(Scene&)> drawn_scene{};                      // into the map
  std::function<void(LightFrame&, MapSettings&)> drawn_map{};     // the frame and settings it is drawn with
  std::function<void(BiasSettings&)> drawn_bias{};                // the bias it is drawn with (polygon offset)
  std::function<Image<float>(const Image<float>&)> edited_map{};  // its pixels, before the lookup
  bool every_map = false;                                         // drawn_map's wrap is R4's map's too
  std::function<void(Settings&)> asked{};                         // the settings that the lookup runs with
  std::function<void(BiasSettings&)> believed_bias{};             // what the ladder takes the bias for
};

using Figures = std::map<std::string, double>;

// The program's own text of a shader with every `from` turned to `to`. Throws when the shader has no `from` (any more):
// a defect that is not planted proves nothing.
inline gl::ShaderReplacements patched(const std::string& file, const std::string& from, const std::string& to) {
  std::string text = gl::shader_file(file);
  size_t at = text.find(from), found = 0;
  for (; at != text.npos; at = text.find(from, at + to.size()), ++found) text.replace(at, from.size(), to);
  if (found == 0) throw std::logic_error(file + " has no '" + from + "'; mend the planted defect");
  return {{file, text}};
}

inline Figures measure(const Settings& settings, const Defect& defect = {}) {
  validate(settings);
  const Scene scene = make_scene(settings.scene);
  const LightFrame frame = make_light_frame(scene, settings);
  // Which surface a pixel sees is not in question: a sound renderer says it.
  gl::Renderer sound(gl::DebugMode::fatal);
  sound.load_scene(scene);
  const Camera camera = effective_camera(scene, settings.view);
  const ReceiverImage receivers = resolve_receivers(
      scene, camera, sound.render_primitives(camera, settings.view.width_px, settings.view.height_px));
  const raytrace::Tracer tracer(scene);
  const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {});

  gl::Renderer renderer(gl::DebugMode::fatal, defect.shaders);
  Scene drawn_scene = scene;
  if (defect.drawn_scene) defect.drawn_scene(drawn_scene);
  renderer.load_scene(drawn_scene);
  renderer.load_receivers(receivers, scene.camera.eye_m);
  LightFrame drawn_frame = frame;
  Settings drawn = settings;
  if (defect.drawn_map) defect.drawn_map(drawn_frame, drawn.map);
  if (defect.drawn_bias) defect.drawn_bias(drawn.bias);
  gl::ShadowMap map = renderer.render_map(drawn_frame, drawn);
  if (defect.edited_map) map = renderer.upload_map(defect.edited_map(renderer.read_map(map)), settings.map);
  const Image<float> stored = renderer.read_map(map);

  Bias bias(settings.bias);
  const LookupProbe probe = renderer.probe(frame, settings);
  const double offset_unit = bias.polygon_offset() ? sound.polygon_offset_unit(settings.map.format) : 0;
  const raytrace::LookupTruth taps =
      tracer.lookup_truth(receivers, truth, probe, frame, settings.map, bias, offset_unit);
  Settings asked = settings;
  if (defect.asked) defect.asked(asked);
  const MapSettings& uploaded = defect.every_map ? drawn.map : settings.map;
  const Image<float> r5 = renderer.lookup(map, frame, asked);
  const Image<float> r4 = renderer.lookup(renderer.upload_map(taps.exact_map, uploaded), frame, asked);

  if (defect.believed_bias) {
    BiasSettings believed = settings.bias;
    defect.believed_bias(believed);
    bias = Bias(believed);
  }
  const LookupEvidence evidence{truth, probe, taps.taps, taps.exact_map, settings.map, bias, r4, r5};
  const Ladder ladder = climb(evidence);
  const Image<float> occluders = tracer.occluder_distance(receivers, frame, peter_panning_mask(ladder));
  Figures figures = measure_ladder({ladder, receivers, frame, probe, bias, taps.edge_distance_texels, occluders});
  const Image<float> ties = tie_map(evidence);
  const Image<float> tie_lookup = renderer.lookup(renderer.upload_map(ties, uploaded), frame, asked);
  figures.merge(measure_soundness({evidence, stored, ties, tie_lookup, receivers, frame, scene.camera.eye_m}));
  return figures;
}

}  // namespace noonmark::planted
