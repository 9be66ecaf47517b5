// Draws a shadow map as a picture. Near is bright. Brightness follows metres and not window depth, because a
// perspective map has almost all window depths near 1.
#pragma once
#include <functional>
#include <span>

#include "app/pictures/image_file.h"
#include "base/image.h"
#include "technique/light_frame.h"

namespace noonmark {

// Rows of a map's image, from the lowest v on: (first row, number of rows). A large map is read in parts.
using MapRows = std::function<Image<float>(int, int)>;

// A map as the lookup's sampler returns it: window depths, of the size LightFrame::map_size().
struct StoredMap {
  const MapRows& rows;
  const LightFrame& frame;
};

// A cube map's image (six faces one above the other) unfolded into a horizontal cross of 4 x 3 cells, as the cube looks
// from outside:
//
//          +Y
//      -X  +Z  +X  -Z
//          -Y
//
// Cells have `cell` pixels a side, at most the map's resolution. Each pixel is the least of the texels that it covers.
// Row 0 is the top. The area outside the cross is `outside`.
Image<float> cube_cross(const MapRows& map, int resolution, int cell, float outside);

// Of several maps the pictures below stand in a row, the nearest on the left, with one scale of
// grey for all.

// The map as it is stored: the grey of a texel is its window depth, from 0 (black) to 1 (white), as a page shows a value
// without any correction. Under perspective it is nearly white.
Image<Color> stored_picture(std::span<const StoredMap> maps);
// The grey of one window depth there. NaN is black.
Color stored_grey(double window_depth);

// Cleared texels get the background's colour.
Image<Color> map_picture(std::span<const StoredMap> maps);

}  // namespace noonmark
