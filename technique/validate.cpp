#include "technique/validate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scenes/error.h"
#include "technique/filters.h"

namespace noonmark {
namespace {

// "none, box or poisson": the names of the rows that are meant.
template <class Rows, class Meant>
std::string names_of(const Rows& rows, const Meant& meant) {
  std::vector<std::string_view> names;
  for (const auto& row : rows)
    if (meant(row)) names.push_back(row.name);
  const std::string_view last = names.back();
  names.pop_back();
  return names.empty() ? std::string(last) : fmt::format("{} or {}", fmt::join(names, ", "), last);
}

}  // namespace

void validate(const Settings& s) {
  if (s.filter.size % 2 == 0)
    throw Error(ErrorKind::usage,
                fmt::format("filter.size = {} is even; a box and a Gaussian have an odd number of taps on a side, so "
                            "that one is at the receiver",
                            s.filter.size));
  if (const std::vector<int>& sizes = find_filter(s.filter.kind).sizes;
      !sizes.empty() && std::find(sizes.begin(), sizes.end(), s.filter.size) == sizes.end())
    throw Error(ErrorKind::usage, fmt::format("filter.size = {}: the filter {} has a size of {}", s.filter.size,
                                              s.filter.kind, fmt::join(sizes, ", ")));
  for (const BiasPart& part : bias_parts()) {
    if (part.floor_help.empty() || part.cap_help.empty()) continue;
    const std::string name(part.name);
    const double floor = s.bias[name + "_floor"], cap = s.bias[name + "_cap"];
    if (floor > cap)
      throw Error(ErrorKind::usage,
                  fmt::format("bias.{0}_floor = {1} is more than bias.{0}_cap = {2}", name, floor, cap));
  }
  const auto require_order = [](std::string_view group, std::optional<double> near_m, std::optional<double> far_m) {
    if (near_m && far_m && *near_m >= *far_m)
      throw Error(ErrorKind::usage,
                  fmt::format("{0}.near_m = {1} is not less than {0}.far_m = {2}", group, *near_m, *far_m));
  };
  require_order("map", s.map.near_m, s.map.far_m);
  require_order("view", s.view.near_m, s.view.far_m);
  if (s.view.up && *s.view.up == glm::dvec3(0))
    throw Error(ErrorKind::usage, "view.up = 0,0,0 is no direction; give another, or auto");
}

void validate_for(LightKind kind, const Settings& s) {
  const auto value = [&](std::string_view name) { return find_setting(name).get(s); };
  const auto refuse_pair = [&](std::string_view name, const std::string& why) {
    throw Error(ErrorKind::usage, fmt::format("{} = {} {}", name, value(name), why));
  };
  const Filter& filter = find_filter(s.filter.kind);
  const bool plane_bias = tap_reference(s.bias.reference).plane;
  if (kind == LightKind::point) {
    if (filter.map == FilterMap::flat)
      refuse_pair("filter.kind",
                  fmt::format("needs a flat map; a point light's cube map takes {}",
                              names_of(filters(), [](const Filter& f) { return f.map != FilterMap::flat; })));
    if (plane_bias) refuse_pair("bias.reference", "needs a flat map; a point light's cube map has own_depth alone");
    if (s.map.shift_u_texels != 0 || s.map.shift_v_texels != 0)
      throw Error(ErrorKind::usage, "map.shift_*_texels needs a flat map; move the point light instead");
  } else if (filter.map == FilterMap::cube) {
    refuse_pair("filter.kind", "needs a cube map; set light.kind = point, or take another filter");
  }
  if (plane_bias && filter.blended)
    refuse_pair(
        "bias.reference",
        fmt::format("gives each texel a depth of its own, and a hardware comparison has one for the four texels "
                    "that it reads; take filter.kind {}",
                    names_of(filters(), [](const Filter& f) { return !f.blended && f.map != FilterMap::cube; })));
  if (s.map.snap && kind != LightKind::directional)
    throw Error(ErrorKind::usage, "map.snap needs a directional light: only its texels have one size everywhere");
}

}  // namespace noonmark
