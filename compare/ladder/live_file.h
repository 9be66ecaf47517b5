// What the files of the report's live pictures have in common (compare/ladder/live_picture.h, compare/ladder/picture_stack.h):
// one line of JSON, padded with spaces to a multiple of four bytes, then arrays one after the other, in little-endian
// order. The first of them holds the floats of all answers. Row 0 of the picture is on top.
#pragma once
#include <cstdint>

namespace noonmark {

// The most pixels of the report's live picture; the point's view is made smaller with its proportions.
inline constexpr int most_live_width_px = 320, most_live_height_px = 180;

// Bits of the flags of a pixel: the first three are those of the pixel's receiver.
enum LiveFlags : uint8_t { live_facing = 1, live_lit = 2, live_ambiguous = 4, live_surface = 8 };

// N.L from 0 to 1 in 255 steps.
uint8_t live_cosine(float n_dot_l);

}  // namespace noonmark
