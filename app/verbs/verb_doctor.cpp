#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <optional>

#include "app/pictures/capture.h"
#include "app/pictures/image_file.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "base/error.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/results/number_text.h"
#include "gl/renderer.h"
#include "measure/truth_agreement.h"
#include "measure/workbench.h"
#include "raytrace/tracer.h"

namespace noonmark {
namespace {

// Measures a small picture with every method of the truth. Throws Error(defect) if they do not agree.
std::string truth_methods_agree() {
  Settings settings;
  settings.scene.name = "cube-room";
  settings.view.width_px = 160;
  settings.view.height_px = 100;
  settings.map.resolution = 256;
  settings.filter.kind = "box";
  Workbench bench(gl::DebugMode::off);
  const TruthAgreement found = compare_truth_methods(bench, settings);
  if (!found.differences.empty())
    throw Error(ErrorKind::defect,
                fmt::format("truth.method = auto and rays differ in the scene {}: {}. Please report this",
                            settings.scene.name, fmt::join(found.differences, ", ")));
  return fmt::format(
      "truth.method auto ({} of the truth without a ray) and rays: the same in every picture and number of {}",
      quantity_text(1 - found.by_rays, "fraction", 3), settings.scene.name);
}

// Runs what prints a line of the answer. If it throws, prints that instead, and returns of what kind the fault is.
std::optional<ErrorKind> fault_of(const char* part, const std::function<void()>& print_line) {
  try {
    print_line();
    return std::nullopt;
  } catch (const Error& error) {
    fmt::print("{:<10}NOT USABLE: {}\n", part, printable(error.what()));
    return error.kind();
  }
}

int examine_machine() {
  const BuildFacts& facts = build_facts();
  fmt::print("noonmark  {} (commit {}, {}, {})\n", facts.version, facts.commit, facts.compiler, facts.build_type);
  const bool room = !fault_of("Machine", [] {
    const ThreadLimit limit(0);
    require_room_to_start(true);
  });
  const bool draws = !fault_of("OpenGL", [] {
    gl::Renderer renderer(gl::DebugMode::off);
    const gl::DeviceInfo& device = renderer.info();
    fmt::print("OpenGL    {} ({}), {}\n", device.renderer, device.vendor, device.version);
    fmt::print("          through EGL {}, {}; maps up to {} texels\n", device.egl_platform,
               device.software ? "software" : "hardware", device.max_map_resolution);
    fmt::print("          times by {}\n", gl::text_of(device.times));
  });
  const bool traces = !fault_of("Embree", [] {
    const raytrace::TracerInfo tracer = raytrace::tracer_info();
    fmt::print("Embree    {}, ISA {} (pinned)\n", tracer.version, tracer.isa);
  });
  std::optional<ErrorKind> truth;
  if (room && draws && traces) truth = fault_of("Truth", [] { fmt::print("Truth     {}\n", truth_methods_agree()); });
  const bool can_measure = room && draws && traces && !truth;
  // Without room, loading the library ends the program.
  const bool can_read_pictures = !room || !fault_of("Pictures", [] {
    require_image_reader();
    fmt::print("Pictures  OpenImageIO reads those of other programs\n");
  });
  // Nothing else needs what these do.
  const std::string missing = missing_for_captures();
  fmt::print("Captures  {}\n", missing.empty() ? "RenderDoc's can be read" : "NOT USABLE: " + printable(missing));
  std::string libraries;
  for (const LibraryVersion& library : facts.libraries)
    libraries += fmt::format("{}{} {}", libraries.empty() ? "" : "; ", library.name, library.version);
  fmt::print("Libraries {}\n", libraries);
  fmt::print("{}\n",
             !can_measure ? "Nothing can be measured here until this is fixed."
             : !can_read_pictures
                 ? "All can be measured here; PNG and EXR files of other programs cannot be read until this is fixed."
                 : "Everything that a measurement needs is here.");
  if (truth == ErrorKind::defect) return static_cast<int>(ErrorKind::defect);
  return can_measure && can_read_pictures ? 0 : static_cast<int>(ErrorKind::device);
}

RunVerb add_doctor(CLI::App&) {
  return [](const std::string&) { return examine_machine(); };
}

}  // namespace

Verb verb_doctor() {
  return {"doctor", "Print which OpenGL, ray tracer and libraries are used, or what is missing", "noonmark doctor",
          add_doctor};
}

}  // namespace noonmark
