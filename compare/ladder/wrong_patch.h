// The largest patch of wrong pixels: what people see first.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/image.h"
#include "compare/ladder/ladder.h"

namespace noonmark {

// The largest set of pixels that are not 0 and are connected over the sides and corners of pixels; of equally large ones the
// first from the top. Empty if all are 0.
std::vector<glm::ivec2> largest_patch(Image<uint8_t> of);

// The pixel deepest inside a patch: with the most steps from neighbour to neighbour to what is not of the patch. Of equally deep
// ones the nearest to their middle, so that a stripe of one pixel's width has it halfway. The patch is not empty.
glm::ivec2 deepest_in(const std::vector<glm::ivec2>& patch);

// The number of receivers in the largest set of counted ones that are connected over the sides and corners of pixels and
// are all wrong. A receiver is wrong if the judged picture and R1 are on different sides of one half; one half itself is
// on the lit side. So the soft rim that a filter makes is wrong only up to where it crosses one half. NaN if the
// visibility of a counted receiver is NaN.
double largest_wrong_patch(const Ladder& ladder);

}  // namespace noonmark
