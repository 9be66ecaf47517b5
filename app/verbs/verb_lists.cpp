// The verbs that only print: report, scenes, settings, doctor.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/pictures/image_file.h"
#include "app/sweep/judging.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "base/error.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "compare/store/store.h"
#include "gl/renderer.h"
#include "measure/workbench.h"
#include "raytrace/tracer.h"
#include "scenes/builtin.h"
#include "scenes/library.h"

namespace noonmark {

int verb_report(const std::string& folder) {
  const std::string store = folder + "/results.sqlite";
  std::error_code none;
  if (std::filesystem::status(store, none).type() == std::filesystem::file_type::not_found)
    throw Error(ErrorKind::usage, fmt::format("{}: there are no results here (no results.sqlite); give the folder that "
                                              "noonmark run or check wrote",
                                              folder));
  const Results results = ResultStore::open(store).load();
  write_report(results, folder);
  fmt::print("{} of {}; the report is {}/report.html\n", results.points.size(),
             counted(static_cast<size_t>(results.planned_points), "point"), printable(folder));
  return results.points.size() < static_cast<size_t>(results.planned_points) ? static_cast<int>(ErrorKind::incomplete)
                                                                             : 0;
}

int verb_scenes() {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = builtin.make({});
    fmt::print("{:<10} {:>6} triangles  {}\n", builtin.name, scene.triangles.size(), builtin.provokes);
  }
  fmt::print("\nOr the path of a .gltf or .glb file: scene = \"models/tree.glb\"\n");
  return 0;
}

int verb_settings() {
  const Settings defaults;
  size_t width = 0;  // of the column of names
  for (const Setting& row : settings_table()) width = std::max(width, row.name.size());
  fmt::print("Settings: --set name=value, or in an experiment file ([map] resolution = 2048).\n\n");
  for (const Setting& row : settings_table())
    fmt::print("{:<{}} {:<16} {}\n{:<{}} {}\n", row.name, width, row.get(defaults), row.help, "", width + 17,
               row.range_with_unit());
  fmt::print("\nMetrics: for [[bound]] and [plot].\n\n");
  for (const Metric& metric : metrics_table()) fmt::print("{:<32} {:<10} {}\n", metric.name, metric.unit, metric.help);
  fmt::print("\nQuantities of the bias curve, for [[bound]]:\n\n");
  for (const CurveQuantity& quantity : curve_quantities())
    fmt::print("{:<32} {:<10} {}\n", quantity.name, quantity.unit, quantity.help);
  return 0;
}

int verb_doctor() {
  const BuildFacts& facts = build_facts();
  fmt::print("noonmark  {} (commit {}, {}, {})\n", facts.version, facts.commit, facts.compiler, facts.build_type);
  bool can_measure = true, can_write_pictures = true;
  try {
    const ThreadLimit limit(0);
    require_room_to_start(true);
  } catch (const Error& error) {
    fmt::print("Machine   NOT USABLE: {}\n", printable(error.what()));
    can_measure = false;
  }
  const bool room = can_measure;
  try {
    const gl::Renderer renderer(gl::DebugMode::off);
    const gl::DeviceInfo& device = renderer.info();
    fmt::print("OpenGL    {} ({}), {}\n", device.renderer, device.vendor, device.version);
    fmt::print("          through EGL {}, {}; maps up to {} texels\n", device.egl_platform,
               device.software ? "software" : "hardware", device.max_map_resolution);
    fmt::print("          times by {}\n", gl::text_of(device.times));
  } catch (const Error& error) {
    fmt::print("OpenGL    NOT USABLE: {}\n", printable(error.what()));
    can_measure = false;
  }
  try {
    const raytrace::TracerInfo tracer = raytrace::tracer_info();
    fmt::print("Embree    {}, ISA {} (pinned)\n", tracer.version, tracer.isa);
  } catch (const Error& error) {
    fmt::print("Embree    NOT USABLE: {}\n", printable(error.what()));
    can_measure = false;
  }
  try {
    if (room) {  // without room, loading the library ends the program
      require_image_files();
      fmt::print("Pictures  OpenImageIO\n");
    }
  } catch (const Error& error) {
    fmt::print("Pictures  NOT USABLE: {}\n", printable(error.what()));
    can_write_pictures = false;
  }
  std::string libraries;
  for (const LibraryVersion& library : facts.libraries)
    libraries += fmt::format("{}{} {}", libraries.empty() ? "" : "; ", library.name, library.version);
  fmt::print("Libraries {}\n", libraries);
  fmt::print("{}\n", !can_measure          ? "Nothing can be measured here until this is fixed."
                     : !can_write_pictures ? "Only experiments with pictures = \"none\" run here until this is fixed."
                                           : "Everything that a measurement needs is here.");
  return can_measure && can_write_pictures ? 0 : static_cast<int>(ErrorKind::device);
}

}  // namespace noonmark
