// What results depend on beside the experiment's own text. Together with that (fingerprint(), app/experiment.h) it is
// what a store of results is resumed by: where one line differs, nothing that is stored is taken over.
//
//   SceneDigests scenes;
//   fingerprint(experiment, identity(bench, points, tracer, scenes));
//   scenes.require_unchanged(bench, settings);   // before each point
#pragma once
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/workbench.h"
#include "raytrace/tracer.h"

namespace noonmark {

// The contents of the scenes as they were when the sweep began.
class SceneDigests {
 public:
  void remember(Workbench& bench, const Settings& point);
  // Throws Error(scene) when a file was edited since: its points would not belong together.
  void require_unchanged(Workbench& bench, const Settings& point) const;
  const std::map<std::string, std::string>& all() const { return digests_; }
  // What the scenes' files hold and is not modelled, a line for each scene (notes_line, scenes/library.h).
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::map<std::string, std::string> digests_;  // by every setting of the scene
  std::vector<std::string> notes_;
};

// Lines of "name", "value":
//   noonmark   version and commit
//   program    the linker's hash of the program itself: an edit that was not committed, another compiler, other options
//   opengl     vendor, renderer and version of the driver
//   embree     version and instruction set
//   machine    the processor and the C library: floating point of the software renderer, and every time, is theirs
//   scene ...  scene_digest of each scene that a point names; the scenes are remembered in `scenes`
// Bounds, laws, titles and what is plotted are no part of it: they are judged anew by every run.
std::vector<std::pair<std::string, std::string>> identity(Workbench& bench, std::span<const Settings> points,
                                                          const raytrace::TracerInfo& tracer, SceneDigests& scenes);

std::string host_cpu();

}  // namespace noonmark
