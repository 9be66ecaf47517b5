// The targets, each defined in <name>_target.cpp.
#pragma once
#include "tests/fuzz/target.h"

namespace noonmark::fuzz {

extern const Target gltf_target;         // bytes of a .gltf or .glb -> load_gltf
extern const Target experiment_target;   // text of an experiment file -> its points
extern const Target formula_target;      // text of formulas -> their values, and a law's verdict
extern const Target store_target;        // bytes of results.sqlite -> the report, CSV, JUnit and summary
extern const Target image_target;        // bytes of a picture -> its size, or the array of NPY
extern const Target cells_target;        // choices of a mesh and a light -> cells that answer as rays do
extern const Target frame_target;        // text of a frame.json -> a verdict
extern const Target numbers_target;      // settings with odd numbers -> a sound measurement, or a refusal
extern const Target measurement_target;  // choices of a scene and settings -> a sound measurement

}  // namespace noonmark::fuzz
