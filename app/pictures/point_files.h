// The files of a measured point for a second opinion: point.json, ladder.exr and map.exr.
#pragma once
#include <string>
#include <vector>

#include "measure/workbench.h"

namespace noonmark {

// Writes <folder>/<prefix>ladder.exr and map.exr: every rung and the numbers behind it, with 32 bits a channel.
// app/pictures/point_files.cpp describes the channels.
std::vector<ImageRecord> write_images(const Measurement& m, const std::string& folder, const std::string& relative,
                                      const std::string& prefix);

// The depth in OpenGL's map that the middle tap of each receiver reads, whether or not it faces the light. Window depth;
// NaN where there is no receiver.
Image<float> stored_depths(const Measurement& m);

// Returns every setting, metric and time, camera and light in full precision, the list of causes and the bits of flags.
std::string point_json(const Measurement& m, const std::string& command);

}  // namespace noonmark
