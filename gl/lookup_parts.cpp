#include "gl/lookup_parts.h"

#include <stdexcept>

namespace noonmark::gl {
namespace {

struct LightRow {
  LightKind kind;
  const char* file;
};
constexpr LightRow light_rows[] = {
    {LightKind::directional, "shaders/light/directional.glsl"},
    {LightKind::spot, "shaders/light/spot.glsl"},
    {LightKind::point, "shaders/light/point.glsl"},
};

struct FilterRow {
  FilterKind kind;
  const char* file;
};
constexpr FilterRow filter_rows[] = {
    {FilterKind::none, "shaders/filter/none.glsl"},         {FilterKind::box, "shaders/filter/box.glsl"},
    {FilterKind::hardware, "shaders/filter/bilinear.glsl"}, {FilterKind::gaussian, "shaders/filter/bilinear.glsl"},
    {FilterKind::poisson, "shaders/filter/mean.glsl"},      {FilterKind::cube_grid, "shaders/filter/mean.glsl"},
    {FilterKind::cube_disk, "shaders/filter/mean.glsl"},
};

}  // namespace

const char* light_file(LightKind kind) {
  for (const LightRow& row : light_rows)
    if (row.kind == kind) return row.file;
  throw std::logic_error("a kind of light without a row in gl/lookup_parts.cpp");
}

const char* filter_file(FilterKind kind) {
  for (const FilterRow& row : filter_rows)
    if (row.kind == kind) return row.file;
  throw std::logic_error("a filter without a row in gl/lookup_parts.cpp");
}

}  // namespace noonmark::gl
