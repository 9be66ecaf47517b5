// A picture that another program made, as the rung that is judged in place of R5.
//
//   bench.measure(settings, {}, given_picture("engine.exr", settings.view));
#pragma once
#include <string>

#include "compare/ladder/ladder.h"
#include "technique/settings.h"

namespace noonmark {

// Reads the visibility of each pixel, from 0 (shadowed) to 1 (lit), of a picture of the view's size, top row first. The
// values are taken as they are: linear, one sample at each pixel's centre. The rung is "R6", and its cause "elsewhere".
// Throws Error(file) if the file cannot be read, has another size, or has a value that is not in [0,1].
RungOnTop given_picture(const std::string& path, const ViewSettings& view);

}  // namespace noonmark
