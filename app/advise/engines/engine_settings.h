// Recommended settings as numbers to type into other engines. Each engine is one file in app/engines/ and one row of
// the table in engine_settings.cpp.
//
//   for (const EngineAdvice& advice : engine_advice(settings, make_light_frame(scene, settings), scene))
//     print(advice.engine, advice.lines, advice.cannot);
//
// Every setting of the bias that is not 0, a reference other than own_depth and the filter stand in `lines`, in `cannot`
// or in both. What a part gives along the light on a plane is law 35 of experiments/laws.toml.
#pragma once
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark {

struct EngineAdvice {
  std::string engine, version;
  std::vector<std::string> lines;   // code, or fields of an inspector with their values, in the engine's own language
  std::vector<std::string> cannot;  // sentences: what the engine cannot express, or expresses otherwise, and what to do
  std::string source;               // the document or the source file of the engine that defines the units
};

// One piece of advice for each engine, in the order of the table. frame: of these settings in this scene.
//
// Numbers are computed in double and written with 6 significant digits. A spot or point light has no single conversion
// from depth or texels to metres. For these lights the numbers hold at one distance from the light, that of the point
// at which the camera looks, held between near and far. A sentence in `cannot` says so.
std::vector<EngineAdvice> engine_advice(const Settings& settings, const LightFrame& frame, const Scene& scene);

// A bias field of an engine, for the table in docs/reference/engines.md.
struct EngineField {
  std::string engine, version, light;  // light: its kinds, such as "spot, point"
  std::string field, unit, place, source;
};
std::vector<EngineField> engine_fields();

}  // namespace noonmark
