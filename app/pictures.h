// The PNGs of a measured point, for people. app/point_files.h writes the files for other programs.
#pragma once
#include <string>
#include <vector>

#include "app/image_file.h"
#include "app/workbench.h"

namespace noonmark {

// Writes the point's PNGs as <folder>/<stem>-<name>.png. The paths in the records begin with `relative`, not `folder`.
std::vector<PictureRecord> write_pictures(const Measurement& m, const std::string& folder, const std::string& relative,
                                          const std::string& stem);

// Grey clay with the true shadow (R1): the picture "shaded-truth" alone.
Image<Color> lit_picture(const Measurement& m);

}  // namespace noonmark
