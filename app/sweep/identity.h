// The facts, beside the settings of a point, that its results depend on. They decide whether the points of a store can be
// used: if one line differs that is not of a scene, no stored result is used. Which of its points an experiment has, and
// which of them are of scenes with the present contents, is for app/sweep/kept_points.h.
//
//   SceneDigests scenes;
//   ResultStore store(path, facts_text(identity(bench, raytrace::tracer_info(), scenes)), Existing::resume);
//   scenes.require_unchanged(bench, settings);   // before each point
#pragma once
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "measure/workbench.h"
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
  // One line for each scene with contents that are not modelled (notes_line, scenes/library.h), and for each map that is
  // fitted in place of its scene's own (light_notes, technique/light_frame.h).
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
//   scene ...  scene_digest of each scene that a point names
// Bounds, laws, titles and plotted metrics are not included, because every run judges and draws them anew.
// scenes: those of the points to measure, remembered.
std::vector<std::pair<std::string, std::string>> identity(Workbench& bench, const raytrace::TracerInfo& tracer,
                                                          const SceneDigests& scenes);

// The same as text, one "name = value" a line: the fingerprint of a store.
std::string facts_text(std::span<const std::pair<std::string, std::string>> facts);

// Of two such texts: `here` with the lines opengl, embree and machine of `there`; and `here` with "several" in those of the
// three that differ. A share may be measured on several machines, one after the other.
std::string with_machine_of(const std::string& here, const std::string& there);
std::string with_both_machines(const std::string& here, const std::string& there);

// The text without the lines of the machine: what all stores that are joined must have in common.
std::string without_machine(const std::string& facts);

// The text with other names of the scenes: name_of("street.glb") is the new one.
std::string with_scene_names(const std::string& facts, const std::function<std::string(const std::string&)>& name_of);

std::string host_cpu();

// What a point's record says of the machine that measures it, without the clock.
Machine this_machine(const gl::DeviceInfo& device, const raytrace::TracerInfo& tracer);

}  // namespace noonmark
