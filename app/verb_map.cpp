#include <fmt/format.h>

#include <algorithm>

#include "app/build_facts.h"
#include "app/default_folder.h"
#include "app/experiment_arguments.h"
#include "app/phase_diagram.h"
#include "app/results_folder.h"
#include "app/verbs.h"
#include "app/workbench.h"
#include "scenes/error.h"
#include "scenes/file.h"
#include "scenes/library.h"
#include "scenes/text.h"

namespace noonmark {

int verb_map(const std::string& scene, const PhaseOptions& options, ExperimentArguments arguments) {
  if (options.coarsest >= options.finest)
    throw Error(ErrorKind::usage, fmt::format("the coarsest resolution ({}) is not below the finest ({}); set --from "
                                              "and --to",
                                              options.coarsest, options.finest));
  // A smaller picture than a point's: the diagram has hundreds of points' worth of texel sizes and placements.
  arguments.sets.insert(arguments.sets.begin(), {"view.width_px=640", "view.height_px=360"});
  arguments.sets.push_back("scene.name=" + scene);
  const Settings given = points(experiment_from("", arguments)).at(0);
  const std::string out = arguments.out.empty() ? default_folder(scene, "map-") : arguments.out;
  Workbench bench(gl::DebugMode::log);
  const Scene& loaded = bench.scene(given.scene);
  const Settings settings = phase_settings(given, loaded);
  Settings coarse = settings;
  coarse.map.resolution = options.coarsest;  // no map is drawn, and none is kept
  coarse.map.placements = options.placements;
  require_memory(bench.memory(coarse, false, false), bench.memory_of_program(false), "this diagram");
  PhaseDiagram diagram = bench.phase(settings, options);
  describe_phase(diagram, settings, loaded);
  diagram.command = arguments.command;
  diagram.version = build_facts().version;
  diagram.notes = notes_line(loaded);
  if (const std::string note = map_fit_note(loaded, settings); !note.empty())
    diagram.notes += (diagram.notes.empty() ? "" : "; ") + note;
  make_output_folder(out);
  clear_abandoned_files(out);
  write_file_atomically(out + "/phase.html", render_phase(diagram));
  write_file_atomically(out + "/phase.csv", phase_csv(diagram));
  for (const std::string& sentence : phase_words(diagram)) fmt::print("{}\n", sentence);
  if (!diagram.notes.empty()) fmt::print("note: {}\n", printable(diagram.notes));
  fmt::print("\n{0}/phase.html and {0}/phase.csv are written\n", printable(out));
  return 0;
}

}  // namespace noonmark
