// Measures points: drives gl, raytrace and compare, and computes once what consecutive points share.
//
//   Workbench bench(gl::DebugMode::log);
//   Measurement m = bench.measure(settings, curve_options);
//   save(m.record); write_pictures(m, ...);
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "app/memory_estimate.h"
#include "compare/ladder/bias_curves.h"
#include "compare/ladder/ladder.h"
#include "compare/store/records.h"
#include "gl/renderer.h"
#include "raytrace/tracer.h"

namespace noonmark {

// One measured point with the images behind its numbers. The references stay good until the bench's next measurement.
struct Measurement {
  PointRecord record;  // without id and pictures
  Settings settings;
  Ladder ladder;
  LightFrame frame;
  Camera camera;
  const Scene& scene;
  const ReceiverImage& receivers;
  const LookupProbe& probe;
  const Image<float>& stored_map;  // as the lookup's sampler returns it; row 0 at the lowest v
  const Image<float>& exact_map;
};

// Throws Error(device) where there is no room for what the driver, the rays and the image library take before anything
// of a point's own: without it, what fails first is a library that cannot say so. pictures: files of them are written.
void require_room_to_start(bool pictures);

class Workbench {
 public:
  // shaders: variants to measure in place of the program's own. strip_bytes: what the truth of a strip's taps may take;
  // where all taps fit, points that share them share their truth. It changes no result.
  explicit Workbench(gl::DebugMode debug, gl::ShaderReplacements shaders = {}, size_t strip_bytes = most_strip_bytes);
  ~Workbench();

  // curve: none when empty, and where no part of the bias has one (curve_part). Throws Error.
  Measurement measure(const Settings& settings, const std::optional<CurveOptions>& curve);

  // What that would take of memory at its peak; pictures: with pictures and EXR files written of it. Throws Error.
  MemoryEstimate memory(const Settings& settings, bool curve, bool pictures);

  // What such estimates are compared with.
  AvailableMemory memory_of_program(bool pictures) const;

  const gl::DeviceInfo& device() const;
  // Of the scene that the settings name; loads it when it is not the one at hand.
  const Scene& scene(const SceneSettings& settings);
  // scene_digest of that scene, as it was loaded.
  const std::string& scene_identity(const SceneSettings& settings);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace noonmark
