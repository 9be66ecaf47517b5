// What a measured point looks like: PNGs for people, EXRs and point.json for a second opinion.
#pragma once
#include <string>
#include <vector>

#include "app/image_file.h"
#include "app/workbench.h"

namespace noonmark {

// Writes the point's PNGs as <folder>/<stem>-<name>.png. The records' paths begin with `relative` in place of `folder`.
std::vector<PictureRecord> write_pictures(const Measurement& m, const std::string& folder, const std::string& relative,
                                          const std::string& stem);

// <folder>/<prefix>ladder.exr and map.exr: every rung, and what each rung was made of, in 32 bits a channel. What the
// channels are is said in app/point_files.cpp.
std::vector<ImageRecord> write_images(const Measurement& m, const std::string& folder, const std::string& relative,
                                      const std::string& prefix);

// Every setting, metric and time; camera and light in full precision; the list of causes and the bits of flags.
std::string point_json(const Measurement& m, const std::string& command);

}  // namespace noonmark
