#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/pictures/pictures.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "base/threads.h"
#include "measure/workbench.h"
#include "raytrace/adjacency.h"
#include "scenes/ground.h"
#include "scenes/interior.h"
#include "scenes/library.h"
#include "technique/light_frame.h"
#include "technique/light_kind.h"

namespace noonmark {
namespace {

struct TexelSize {
  int resolution = 0;  // texels on a side
  double texel_m = 0;  // width of a texel at the middle of the scene's box
};

// How the triangles join, by exactly equal positions of their corners (raytrace/adjacency.h).
struct SurfaceReport {
  uint64_t open_edges = 0;         // edges of one triangle only; 0: the surface is closed
  uint64_t branched_edges = 0;     // edges of three triangles or more
  uint64_t doubled_triangles = 0;  // exact copies of other triangles
};

struct ModelReport {
  std::string path;
  ModelContents contents;
  Scene scene;  // as measured, with what the settings add
  SurfaceReport surface;
  glm::dvec3 low_m{0}, high_m{0};                 // axis-aligned box
  double farthest_m = 0;                          // largest coordinate of a vertex, without its sign
  double float_step_m = 0;                        // between neighbouring floats there
  double shortest_edge_m = 0, median_edge_m = 0;  // of the triangles' edges; of those longer than 0
  bool room = false;                              // a closed room (scenes/interior.h)
  bool ground = false;                            // has_ground (scenes/ground.h)
  std::string light;                              // name of the kind of light that is measured
  std::vector<TexelSize> texels;                  // of the map as the settings fit it
};

constexpr int shown_resolutions[] = {1024, 2048, 4096};

SurfaceReport surface_of(const Scene& scene) {
  const Adjacency adjacency(scene);
  SurfaceReport surface;
  for (uint32_t t = 0; t < adjacency.triangles(); ++t) {
    if (adjacency.is_copy(t)) {
      ++surface.doubled_triangles;
      continue;
    }
    for (int edge = 0; edge < 3; ++edge) {
      const auto others = adjacency.across(t, edge);
      surface.open_edges += others.empty();
      // Counted once, by its first triangle.
      surface.branched_edges += others.size() > 1 && t < *std::min_element(others.begin(), others.end());
    }
  }
  return surface;
}

// Edges that two triangles share count twice, which moves neither the shortest nor, on a closed surface, the median.
void measure_edges(ModelReport& report) {
  const Scene& scene = report.scene;
  std::vector<double> lengths;
  lengths.reserve(3 * scene.triangles.size());
  for (const glm::uvec3& t : scene.triangles)
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 a(scene.positions[t[i]]), b(scene.positions[t[(i + 1) % 3]]);
      if (a != b) lengths.push_back(glm::distance(a, b));
    }
  if (lengths.empty()) return;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  report.median_edge_m = *middle;
  report.shortest_edge_m = *std::min_element(lengths.begin(), lengths.end());
}

void measure_place(ModelReport& report) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  float farthest = 0;
  for (const glm::uvec3& t : report.scene.triangles)
    for (int i = 0; i < 3; ++i) {
      const glm::vec3 p = report.scene.positions[t[i]];
      low = glm::min(low, glm::dvec3(p));
      high = glm::max(high, glm::dvec3(p));
      farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
  report.low_m = low;
  report.high_m = high;
  report.farthest_m = static_cast<double>(farthest);
  report.float_step_m =
      static_cast<double>(std::nextafter(farthest, std::numeric_limits<float>::infinity())) - report.farthest_m;
}

// "3 opaque, 1 masked": the counts that are not 0.
std::string kinds(std::initializer_list<std::pair<uint64_t, const char*>> counts) {
  std::vector<std::string> parts;
  for (const auto& [count, name] : counts)
    if (count > 0) parts.push_back(fmt::format("{} {}", count, name));
  return parts.empty() ? "" : fmt::format(" ({})", fmt::join(parts, ", "));
}

std::string surface_text(const SurfaceReport& s) {
  std::string text =
      s.open_edges == 0 ? "closed" : fmt::format("open: {} of one triangle only", counted(s.open_edges, "edge"));
  if (s.branched_edges > 0) text += fmt::format("; {} of three triangles or more", counted(s.branched_edges, "edge"));
  if (s.doubled_triangles > 0)
    text += fmt::format("; doubled: {} an exact copy of another",
                        s.doubled_triangles == 1 ? std::string("1 triangle is")
                                                 : fmt::format("{} triangles are each", s.doubled_triangles));
  return text;
}

// Throws Error(file) for a file that cannot be used, Error(usage) for settings that cannot be.
ModelReport inspect_model(const Settings& settings) {
  if (!names_file(settings.scene.name))
    throw Error(ErrorKind::usage,
                fmt::format("{} is not a model: give the path of a .gltf, .glb or .vrm file", settings.scene.name));
  ModelReport report;
  report.path = settings.scene.name;
  const Model model =
      load_model(settings.scene.name, {settings.scene.time_s, settings.scene.animation}, settings.scene.masks);
  report.contents = model.contents;
  report.room = camera_inside(model.scene).has_value();
  report.ground = has_ground(model.scene);
  report.scene = make_scene(settings.scene);
  report.surface = surface_of(report.scene);
  measure_edges(report);
  measure_place(report);
  report.light = kind_of_light(effective_light(report.scene, settings).kind).name();
  for (int resolution : shown_resolutions) {
    Settings of_size = settings;
    of_size.map.resolution = resolution;
    const LightFrame frame = make_light_frame(report.scene, of_size);
    report.texels.push_back({resolution, frame.texel_m(frame.to_light(0.5 * (report.low_m + report.high_m)))});
  }
  return report;
}

// "'lamp' of the node 'ceiling': point, 20 cd, range 30 m".
std::string text_of(const Named<Light>& one) {
  std::string text = one.name.empty() ? "without a name" : fmt::format("'{}'", printable(one.name));
  if (!one.node.empty()) text += fmt::format(" of the node '{}'", printable(one.node));
  if (!one.value) return text + ": cannot be used: " + printable(one.why_not);
  const Light& light = *one.value;
  text += fmt::format(": {}, {:.4g} {}", kind_of_light(light.kind).name(), light.power.intensity,
                      light.kind == LightKind::directional ? "lx" : "cd");
  if (light.kind == LightKind::spot) text += fmt::format(", cone of {:.4g} degrees", light.cone_deg);
  if (light.power.range_m) text += fmt::format(", range {:.4g} m", *light.power.range_m);
  return text;
}

std::string report_text(const ModelReport& r) {
  const ModelContents& c = r.contents;
  const glm::dvec3 size = r.high_m - r.low_m;
  std::string text = fmt::format("{}\n", printable(r.path));
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<12} {}\n", name, value);
  };
  line("holds", fmt::format("{}, {}, {}, {}", fmt::format("{} {}", c.meshes, c.meshes == 1 ? "mesh" : "meshes"),
                            counted(c.primitives, "primitive"), counted(c.nodes, "node"),
                            counted(r.scene.triangles.size(), "triangle")));
  line("materials", fmt::format("{}{}", c.materials,
                                kinds({{c.opaque_materials, "opaque"},
                                       {c.masked_materials, "masked"},
                                       {c.blended_materials, "blended"},
                                       {c.transmitting_materials, "transmitting"},
                                       {c.double_sided_materials, "double-sided"}})));
  line("camera", c.gives_camera ? fmt::format("of the file ({})", counted(c.cameras, "camera"))
                                : std::string(r.room ? "fitted inside, because the model is a closed room"
                                                     : "fitted, because the file shows none"));
  line("light",
       fmt::format("{}{}, {}", c.gives_light ? "of the file" : "fitted, because the file shows none",
                   kinds({{c.directional_lights, "directional"}, {c.spot_lights, "spot"}, {c.point_lights, "point"}}),
                   r.scene.lights.size() > 1
                       ? "measured as a " + r.light + " light; lights = \"all\" in an experiment measures all"
                       : "measured as a " + r.light + " light"));
  for (size_t i = 0; i < r.scene.lights.size(); ++i)
    line(fmt::format("light {}", i).c_str(), text_of(r.scene.lights[i]));
  line("animations", fmt::format("{}, {}, {} meshes with morph targets", counted(c.animations, "animation"),
                                 counted(c.skins, "skin"), c.morphed_meshes));
  line("size", fmt::format("{:.4g} x {:.4g} x {:.4g} m (x, y, z; +Y is up), from {:.4g}, {:.4g}, {:.4g} m", size.x,
                           size.y, size.z, r.low_m.x, r.low_m.y, r.low_m.z));
  line("origin",
       fmt::format("largest coordinate {:.4g} m; floats there are {:.2g} m apart", r.farthest_m, r.float_step_m));
  line("edges", fmt::format("of triangles: median {:.3g} m, shortest {:.3g} m", r.median_edge_m, r.shortest_edge_m));
  line("surface", surface_text(r.surface));
  line("ground", r.ground ? "of its own"
                          : "none: a model alone casts no shadow on anything else (scene.floor = true adds a floor)");
  std::vector<std::string> texels;
  for (const TexelSize& t : r.texels) texels.push_back(fmt::format("{}: {:.3g} m", t.resolution, t.texel_m));
  line("texel", fmt::format("of the fitted map, in the middle: {}", fmt::join(texels, ", ")));
  for (const std::string& note : r.scene.notes) line("note", printable(note));
  return text;
}

// The same numbers as one JSON object, in SI units; picture: the path of the picture.
std::string report_json(const ModelReport& r, const std::string& picture) {
  const ModelContents& c = r.contents;
  nlohmann::ordered_json json;
  json["model"] = printable(r.path);
  json["scenes"] = c.scenes;
  json["nodes"] = c.nodes;
  json["meshes"] = c.meshes;
  json["primitives"] = c.primitives;
  json["triangles"] = r.scene.triangles.size();
  json["materials"] = {{"all", c.materials},
                       {"opaque", c.opaque_materials},
                       {"masked", c.masked_materials},
                       {"blended", c.blended_materials},
                       {"transmitting", c.transmitting_materials},
                       {"double_sided", c.double_sided_materials}};
  json["cameras"] = c.cameras;
  json["gives_camera"] = c.gives_camera;
  json["lights"] = {{"directional", c.directional_lights}, {"spot", c.spot_lights}, {"point", c.point_lights}};
  json["gives_light"] = c.gives_light;
  json["light_list"] = nlohmann::ordered_json::array();
  for (const Named<Light>& one : r.scene.lights) json["light_list"].push_back(printable(text_of(one)));
  json["measured_light"] = r.light;
  json["animations"] = c.animations;
  json["skins"] = c.skins;
  json["morphed_meshes"] = c.morphed_meshes;
  json["low_m"] = {r.low_m.x, r.low_m.y, r.low_m.z};
  json["high_m"] = {r.high_m.x, r.high_m.y, r.high_m.z};
  json["farthest_coordinate_m"] = r.farthest_m;
  json["float_step_m"] = r.float_step_m;
  json["median_edge_m"] = r.median_edge_m;
  json["shortest_edge_m"] = r.shortest_edge_m;
  json["closed"] = r.surface.open_edges == 0;
  json["open_edges"] = r.surface.open_edges;
  json["branched_edges"] = r.surface.branched_edges;
  json["doubled_triangles"] = r.surface.doubled_triangles;
  json["closed_room"] = r.room;
  json["ground"] = r.ground;
  for (const TexelSize& t : r.texels) json["texel_m"][std::to_string(t.resolution)] = t.texel_m;
  json["not_modelled"] = nlohmann::ordered_json::array();
  for (const std::string& note : r.scene.notes) json["not_modelled"].push_back(printable(note));
  json["picture"] = printable(picture);
  return json.dump(2) + "\n";
}

// Says what a glTF model holds and writes a picture of it.
int inspect_file(const std::string& model, ExperimentArguments arguments) {
  const VerbOutputs outputs = outputs_of("inspect", model, arguments.out);
  OutputFolder folder(outputs);
  // A picture that is quick to make. A finer map changes nothing in it, because its shadow is the truth.
  arguments.sets.insert(arguments.sets.begin(), {"view.width_px=960", "view.height_px=540"});
  take_scene(arguments, model);
  const Settings settings = points(experiment_from("", arguments)).at(0);
  const ModelReport report = inspect_model(settings);
  const std::string& out = outputs.folder;
  if (!arguments.json) {
    fmt::print("{}", report_text(report));
    std::fflush(stdout);  // what follows can end the program: it takes OpenGL and the library of pictures
  }
  require_room_to_start(true);
  Workbench bench(gl::DebugMode::log);
  require_memory(bench.memory(settings, false, false), bench.memory_of_program(true), "this picture");
  Progress progress(arguments.quiet);
  const Progress::Work picture_drawn = progress.add(1);
  progress.say(fmt::format("the picture of {}", model));
  const Measurement m = bench.measure(settings, std::nullopt);
  folder.make();
  const std::string picture = out + "/" + outputs.files.front();
  write_png(picture, lit_picture(m));
  progress.finished(picture_drawn, "the picture is drawn");
  progress.end_line();
  if (arguments.json) {
    fmt::print("{}", report_json(report, picture));
    return 0;
  }
  fmt::print(
      "\n{} shows it with its true shadow: dark grey is in shadow, blue faces away from the light, pale "
      "yellow is ambiguous.\n"
      "Next: noonmark init {}\n",
      printable(picture), shell_quoted(model));
  return 0;
}

struct InspectOptions {
  std::string model;
  ExperimentArguments arguments;
};

RunVerb add_inspect(CLI::App& verb) {
  const auto options = std::make_shared<InspectOptions>();
  add_model(verb, options->model);
  add_json(verb, options->arguments, "Print the same as JSON");
  add_sets(verb, options->arguments);
  add_out(verb, options->arguments, "Folder for the picture",
          folders_of({"helmet.glb", "checks/helmet.glb"},
                     [](const std::string& model) { return outputs_of("inspect", model, "").folder; }));
  return [options](const std::string&) {
    const ThreadLimit limit(options->arguments.threads);
    return inspect_file(options->model, options->arguments);
  };
}

}  // namespace

Verb verb_inspect() {
  return {"inspect", "Say what a model holds and what is not modelled, and draw it with its shadow",
          "noonmark inspect model.glb", add_inspect};
}

}  // namespace noonmark
