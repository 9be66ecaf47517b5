// The facts, beside the settings of a point, that its results depend on. They decide whether the points of a store can be
// used: if one line differs, no stored result is used. Which of its points an experiment has is for app/kept_points.h.
//
//   SceneDigests scenes;
//   ResultStore store(path, facts_text(identity(bench, points, tracer, scenes)), Existing::resume);
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

// The contents of the scenes at the start of the sweep.
class SceneDigests {
 public:
  void remember(Workbench& bench, const Settings& point);
  // Throws Error(file) if a file was edited after the start, because its points would be of different scenes.
  void require_unchanged(Workbench& bench, const Settings& point) const;
  // Of a point whose scene was remembered.
  const std::string& of(const Settings& point) const;
  const std::map<std::string, std::string>& all() const { return digests_; }
  // The contents of the scenes' files that are not modelled, one line for each scene (notes_line, scenes/library.h).
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::map<std::string, std::string> digests_;  // by every setting of the scene
  std::vector<std::string> notes_;
};

// Lines of "name", "value":
//   noonmark   version and commit
//   program    the linker's hash of the program: it changes with uncommitted edits, another compiler or other options
//   opengl     vendor, renderer and version of the driver
//   embree     version and instruction set
//   machine    processor and C library, on which the software renderer's floating point and all times depend
//   scene ...  scene_digest of each scene that a point names; the scenes are remembered in `scenes`
// Bounds, laws, titles and plotted metrics are not included, because every run judges and draws them anew.
std::vector<std::pair<std::string, std::string>> identity(Workbench& bench, std::span<const Settings> points,
                                                          const raytrace::TracerInfo& tracer, SceneDigests& scenes);

// The same as text, one "name = value" a line: the fingerprint of a store.
std::string facts_text(std::span<const std::pair<std::string, std::string>> facts);

std::string host_cpu();

}  // namespace noonmark
