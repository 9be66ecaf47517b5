#include "compare/ladder/probe_errors.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace noonmark {
namespace {

constexpr double u = float_rounding;
constexpr double division = float_division;
constexpr double square_root = float_square_root;
// length(): three squares of rounded differences (2 u each), the rounding of the squares (u) and two sums (2 u), halved
// by the root.
constexpr double length_of_difference = (2 * u + u + 2 * u) / 2 + square_root;

// The least precision of a texel's fraction in a sampler's address: 8 bits. Vulkan requires at least 4
// (subTexelPrecisionBits); samplers that run OpenGL 4.5 have at least 8.
constexpr double sampler_texels = 0x1p-8;

double sum_of(glm::dvec3 v) { return v.x + v.y + v.z; }

}  // namespace

void raise_error(double& value, double candidate) {
  if (!(candidate <= value)) value = std::isnan(candidate) ? std::numeric_limits<double>::infinity() : candidate;
}

struct ProbeCheck::Place {
  glm::dvec3 world, light;
  glm::dvec3 error;  // the error of each world coordinate
  int tile = 0;      // in which the lookup reads; its texels, for a cube, may lie in others
};

ProbeCheck::ProbeCheck(const LookupEvidence& evidence, const ReceiverImage& receivers, const LightFrame& frame,
                       glm::dvec3 eye_m)
    : e_(evidence),
      receivers_(receivers),
      frame_(frame),
      eye_m_(eye_m),
      light_position_(glm::vec3(frame.drawn_origin_m())) {
  for (int tile = 0; tile < frame.tiles; ++tile) tiles_.push_back(frame.tile(tile));
  if (frame.map_shape() == MapShape::cube) return;
  for (int tile = 0; tile < frame.tiles; ++tile) {
    clip_.push_back(frame.drawn_clip_from_world(frame.tile(tile)));
    planes_.push_back(glm::transpose(glm::inverse(glm::translate(clip_.back(), light_position_))));
  }
}

// P and the sum of the offsets on it. Each offset is a rounded amount in metres times a direction that the formula
// computes. The amount depends on the texel's size at P. That size is a constant (directional), or a constant times the
// product of the rounded axis with rounded differences (spot), or a constant times the largest of those differences
// (point; along the axes of a turned cube, each of these is such a product too).
ProbeCheck::Place ProbeCheck::looked_up(size_t i) const {
  const glm::dvec3 at(receivers_.position[i]), normal(receivers_.normal[i]);
  Place place{at, {}, glm::dvec3(0)};
  if (e_.bias.moves_lookup()) {
    double amount = 2 * u;
    if (frame_.map_shape() == MapShape::cube) amount = 4 * u;
    const glm::dvec3 light = frame_.to_light(at);
    if (frame_.turned()) {
      const glm::dvec3 error = error_in_cube(glm::dvec3(0), light);
      amount = 3 * u + std::max({error.x, error.y, error.z}) / frame_.tile_at(light).along(light);
    }
    if (frame_.tile_at(light).depth == TileDepth::perspective) {
      amount = 3 * u + 5 * u * sum_of(glm::abs((at - frame_.origin_m) * frame_.forward)) / std::abs(light.z);
    }
    if (e_.bias.offset_unit() == OffsetUnit::m) amount = 0;  // times 1
    const in_bounds::Surface surface = bounded_surface(at, normal);
    const double unit_m = e_.bias.offset_m(frame_.texel_m(light));
    for (const ActivePart& active : e_.bias.moving()) {
      const double amount_m = active.amount * unit_m;
      const bounded::vec3 way = active.part->formula.bounded_way(surface);
      const glm::dvec3 offset = amount_m * glm::dvec3(way.x.value, way.y.value, way.z.value);
      place.world += offset;
      place.error += glm::abs(offset) * (amount + u) + amount_m * glm::dvec3(way.x.error, way.y.error, way.z.error) +
                     glm::abs(place.world) * u;
    }
  }
  place.light = frame_.to_light(place.world);
  place.tile = frame_.tile_of(place.light);
  return place;
}

// The error of one component of the direction to the light. If the shader computes it, it is a rounded difference
// divided by a length, or multiplied by the length's inverse. For a directional light it is a uniform.
double ProbeCheck::direction_error() const {
  return frame_.light().rays().have_one_direction() ? 2 * u : u + length_of_difference + division + u;
}

// The error of a vector from the light along the cube's axes. error: of its components along the light's axes, without the
// rounding of the vector itself, which is a difference (u). Along a turned cube each component is a sum of three products
// with a rounded axis: u of the axis, u of the product, 2 u of the sums.
glm::dvec3 ProbeCheck::error_in_cube(glm::dvec3 error, glm::dvec3 vector) const {
  const glm::dvec3 size = glm::abs(vector);
  if (!frame_.turned()) return error + size * u;
  const glm::dvec3 summed = error + size * (5 * u);
  glm::dvec3 turned;
  for (int axis = 0; axis < 3; ++axis) turned[axis] = glm::dot(glm::abs(frame_.cube_axes[axis]), summed);
  return turned;
}

// Where two faces of a turned cube meet, the shader's rounded components may choose the other face than the frame in
// double. Then the texels have its axes. (Without a turn the components are rounded differences, which keep their order.)
void ProbeCheck::allow_other_face(glm::dvec3 light, in_bounds::Surface& surface) const {
  const glm::dvec3 size = glm::abs(frame_.in_cube(light)), error = error_in_cube(glm::dvec3(0), light);
  const double largest = std::max({size.x, size.y, size.z}), unsure = 2 * std::max({error.x, error.y, error.z});
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] >= largest - unsure)) continue;
    glm::dvec3 right, up;
    frame_.light().texel_axes(frame_, frame_.cube_axes[axis], right, up);
    const auto widen = [](Bounded& bound, double other) {
      bound.error = std::max(bound.error, std::abs(other - bound.value) + u * std::abs(other));
    };
    widen(surface.texel_right.x, right.x), widen(surface.texel_right.y, right.y), widen(surface.texel_right.z, right.z);
    widen(surface.texel_up.x, up.x), widen(surface.texel_up.y, up.y), widen(surface.texel_up.z, up.z);
  }
}

// The inputs of the formulas of the moving parts, with their float errors.
in_bounds::Surface ProbeCheck::bounded_surface(glm::dvec3 position, glm::dvec3 normal) const {
  const in_double::Surface exact = surface_at(frame_, position, normal);
  const auto off_by = [](glm::dvec3 v, double relative) {
    const auto of = [&](double x) { return Bounded(x, relative * std::abs(x)); };
    return bounded::vec3{of(v.x), of(v.y), of(v.z)};
  };
  in_bounds::Surface surface{};
  surface.normal = off_by(exact.normal, 0);
  surface.to_light = off_by(exact.to_light, direction_error());
  surface.texel_right = off_by(exact.texel_right, u);
  surface.texel_up = off_by(exact.texel_up, u);
  if (frame_.turned()) allow_other_face(frame_.to_light(position), surface);
  surface.n_dot_l = bounded::dot(surface.normal, surface.to_light);
  surface.tan_theta = Bounded(exact.tan_theta, std::numeric_limits<double>::infinity());
  return surface;
}

glm::dvec4 ProbeCheck::clip_of(const Place& place) const {
  return clip_[static_cast<size_t>(place.tile)] * glm::dvec4(place.world, 1);
}

// Clip coordinates. Let S = sum |m_j p_j| over a row of the matrix. Rounding the row gives an error of u S, four
// products and three sums give 4 u S, and P's own error gives |m_j| for each coordinate. If a coordinate is the
// difference of far larger numbers, the error grows with S. The frame in double, with which it is compared, is rounded
// too: the matrix's last column (three products, three sums), its product with P (four products, three sums), and P in
// the light's frame (a difference, three products, two sums), each as a part of sum |m_j| (|p_j| + |origin_j|). This
// matters if a map of a million kilometres covers a scene of a centimetre. An orthographic w is exactly 1.
glm::dvec4 ProbeCheck::row_errors(const Place& place) const {
  constexpr double in_double = (6 + 7 + 6) * 0x1p-53;
  glm::dvec4 errors(0);
  const glm::dmat4& clip = clip_[static_cast<size_t>(place.tile)];
  for (int row = 0; row < (tiles_[static_cast<size_t>(place.tile)].orthographic ? 3 : 4); ++row) {
    double sum = std::abs(clip[3][row]), moved = 0, exact = 0;
    for (int j = 0; j < 3; ++j) {
      sum += std::abs(clip[j][row] * place.world[j]);
      moved += std::abs(clip[j][row]) * place.error[j];
      exact += std::abs(clip[j][row]) * (std::abs(place.world[j]) + std::abs(frame_.drawn_origin_m()[j]));
    }
    errors[row] = 5 * u * sum + moved + in_double * exact;
  }
  return errors;
}

// Whether the lookup may have no place for P in the map: P is at the light, behind a spot light, or beyond the range of
// floats.
bool ProbeCheck::may_ask_nothing(const Place& place) const {
  constexpr double largest = std::numeric_limits<float>::max();
  if (frame_.map_shape() == MapShape::cube) {
    const double depth = frame_.window_depth(place.light);
    return !(depth > std::numeric_limits<float>::min() + glm::length(place.error) / frame_.far_m) || !(depth < largest);
  }
  const glm::dvec4 clip = clip_of(place), error = row_errors(place);
  if (!(clip.w > error.w)) return true;
  for (int row = 0; row < 3; ++row)
    if (!((std::abs(clip[row]) + error[row]) / (clip.w - error.w) < largest)) return true;
  return false;
}

// Window coordinates. The division adds the errors of both operands and its own rounding. Halving and adding one half
// round once, and multiplying by the resolution rounds once more. Of a snapped map x and y are multiplied by half the resolution, rounded to a
// step, and the map's corner is subtracted.
void ProbeCheck::compare_flat(size_t i, const Place& place, ProbeErrors& found) const {
  const glm::dvec4 clip = clip_of(place), row_error = row_errors(place);
  const auto window = [&](int row) {
    double ndc = clip[row] / clip.w;
    double error = (row_error[row] + std::abs(ndc) * row_error[3]) / std::abs(clip.w) + division * std::abs(ndc);
    if (frame_.anchor_m && row < 2) {
      error += u * std::abs(ndc) + static_cast<double>(frame_.snapped_step()) / frame_.tile_size()[row];
      ndc -= 2 * frame_.anchor_texels[row] / frame_.tile_size()[row];
    }
    return std::pair((ndc + 1) / 2, error / 2 + u * std::abs((ndc + 1) / 2));
  };
  const LookupProbe& probe = e_.probe;
  const MapTile& tile = tiles_[static_cast<size_t>(place.tile)];
  const double depth_m = tile.depth_m(place.light);
  const double reference = std::abs(probe.reference[i] - tile.window_depth(depth_m));
  raise_error(found.reference_m, reference / tile.window_depth_slope(depth_m));
  raise_error(found.excess, reference / window(2).second);

  constexpr double farthest = LookupProbe::farthest_texel;
  const glm::dvec2 texels = tile.texels(frame_.place(place.light));
  const glm::ivec2 texel = LookupProbe::floored(probe.map_texels[i]);
  for (int axis = 0; axis < 2; ++axis) {
    const auto [at, error] = window(axis);
    const double exact = std::clamp(texels[axis], -farthest, farthest);
    raise_error(found.address_texels, std::max(0.0, std::abs(exact - (texel[axis] + 0.5)) - 0.5));
    const double beside = std::clamp<double>(probe.map_texels[i][axis], -farthest, farthest) - exact;
    raise_error(found.excess, std::abs(beside) / (frame_.tile_size()[axis] * (error + u * std::abs(at))));
  }

  if (tile.depth == TileDepth::perspective && e_.bias.unit() != BiasUnit::depth) {
    const double expected = frame_.depth_per_bias_unit(e_.bias.unit(), place.light);
    const double axis = row_error[3] / std::abs(clip.w);  // w is the depth along the axis
    // The unit is a rounded constant divided by w, or by its rounded square.
    const double error = u + division + (e_.bias.unit() == BiasUnit::m ? 2 * axis + u : axis);
    raise_error(found.excess, std::abs(probe.bias_unit[i] - expected) / (expected * error));
  } else {
    const double expected = frame_.depth_per_bias_unit(e_.bias.unit(), place.light);
    raise_error(found.excess, std::abs(probe.bias_unit[i] - expected) / (expected * u));
  }
}

// Distances and directions. The sampler finds a direction's face and texel: it divides two components by the largest
// one.
void ProbeCheck::compare_cube(size_t i, const Place& place, ProbeErrors& found) const {
  const LookupProbe& probe = e_.probe;
  const double distance = glm::length(place.light);
  const double expected = frame_.window_depth(place.light);
  const double reference = std::abs(probe.reference[i] - expected);
  const double moved = glm::dot(glm::abs(place.light), place.error) / (distance * frame_.far_m);
  raise_error(found.reference_m, reference * frame_.far_m);
  // Far is rounded, and the division is rounded.
  raise_error(found.excess, reference / (moved + expected * (length_of_difference + u + division)));

  const glm::dvec3 error = error_in_cube(place.error, place.light);
  const glm::dvec3 a = glm::abs(frame_.in_cube(place.light));
  const int major = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  // Where two faces of a turned cube meet, the largest component may be another one; all have errors of one size.
  const double axis_error = frame_.turned() ? std::max({error.x, error.y, error.z}) : error[major];
  const double unit = frame_.depth_per_bias_unit(e_.bias.unit(), place.light);
  const double unit_error = e_.bias.unit() == BiasUnit::texel ? 2 * u + axis_error / a[major] : u;
  raise_error(found.excess, std::abs(probe.bias_unit[i] - unit) / (unit * unit_error));

  for (int t = 0; t < probe.taps(); ++t) {
    const glm::dvec3 from_light = place.light + glm::dvec3(probe.offset(i, t));
    const glm::dvec3 way = frame_.in_cube(from_light);
    const glm::dvec3 way_error = error_in_cube(place.error + glm::abs(place.light) * u, from_light);
    // The texel is compared with the exact direction in the face that the sampler chose, even if the exact direction
    // lies just beyond that face's edge.
    const glm::ivec2 texel = probe.texel(i, t);
    const CubeFace& face = cube_face(probe.tile(i, t));
    const glm::dvec2 in_face(texel - tiles_[static_cast<size_t>(probe.tile(i, t))].corner);
    const double ahead = glm::dot(way, face.forward), ahead_error = glm::dot(way_error, glm::abs(face.forward));
    for (int axis = 0; axis < 2; ++axis) {
      const glm::dvec3& side = axis == 0 ? face.right : face.up;
      const double at = ahead > 0 ? glm::dot(way, side) / ahead : std::numeric_limits<double>::infinity();
      const double texels = (at + 1) / 2 * frame_.resolution;
      const double beside = std::max(0.0, std::abs(texels - (in_face[axis] + 0.5)) - 0.5);
      const double at_error =
          (glm::dot(way_error, glm::abs(side)) + std::abs(at) * ahead_error) / ahead + division * std::abs(at);
      raise_error(found.address_texels, beside);
      raise_error(found.excess,
                  beside / (frame_.resolution * (at_error / 2 + 2 * u * std::abs(at + 1) / 2) + sampler_texels));
    }
  }
}

// N.L, tan(theta) and the radius. They belong to P itself and not to the place looked up.
void ProbeCheck::compare_shading(size_t i, const Place&, ProbeErrors& found) const {
  const LookupProbe& probe = e_.probe;
  const glm::dvec3 at(receivers_.position[i]);
  const glm::dvec3 products = glm::dvec3(receivers_.normal[i]) * frame_.direction_to_light(at);
  // Three products, in which the light's component is rounded, and two sums.
  raise_error(found.excess, std::abs(probe.n_dot_l[i] - sum_of(products)) /
                                ((direction_error() + 3 * u) * sum_of(glm::abs(products))));

  if (e_.bias.reads_tan()) {
    // tan(theta) from the probe's own cosine c. 1 - c c is rounded twice, also near 0; then come a root and a division.
    const double c = std::min(1.0, static_cast<double>(probe.n_dot_l[i])), squared = 1 - c * c;
    const double root = std::sqrt(squared);
    const double lost = squared > 0 ? std::min(std::sqrt(2 * u), 2 * u / root) : 0;
    // If N is almost perpendicular to L, the shader may limit tan(theta) to a number of its own.
    if (c > least_cosine)
      raise_error(found.excess, std::abs(probe.tan_theta[i] - root / c) /
                                    ((lost + (square_root + division) * root) / c + std::numeric_limits<float>::min()));
  }
  if (probe.pattern.scaled_by_view) {
    const glm::dvec3 way = at - eye_m_;
    const double distance = glm::length(way), x = distance / frame_.far_m;
    // The camera's place is rounded. Far is rounded, and its division is rounded. The division by 25 is rounded.
    const double x_error = glm::dot(glm::abs(way), glm::abs(eye_m_)) * u / (distance * frame_.far_m) +
                           x * (length_of_difference + u + division);
    raise_error(found.excess, std::abs(probe.radius[i] - (1 + x) / 25) / ((x_error + (1 + x) * (u + division)) / 25));
  }
}

// The plane is (N, -N.V), where V starts at the light's position. In clip space its z is -(x X + y Y) / Z.
void ProbeCheck::compare_gradient(size_t i, const Place& place, ProbeErrors& found) const {
  const glm::dvec3 normal(receivers_.normal[i]), way = place.world - light_position_;
  const glm::dvec4 plane(normal, -glm::dot(normal, way));
  // A rounded difference, a product and two sums, and the error of the place looked up.
  const double offset_error = 4 * u * sum_of(glm::abs(normal * way)) + glm::dot(glm::abs(normal), place.error);
  const glm::dmat4& planes = planes_[static_cast<size_t>(place.tile)];
  double value[3], error[3];
  for (int row = 0; row < 3; ++row) {
    double sum = 0;
    value[row] = 0;
    for (int j = 0; j < 4; ++j) {
      value[row] += planes[j][row] * plane[j];
      sum += std::abs(planes[j][row] * plane[j]);
    }
    error[row] = 5 * u * sum + std::abs(planes[3][row]) * offset_error;
  }
  if (!(std::abs(value[2]) > error[2])) return;  // edge on within rounding: any slope is right
  for (int axis = 0; axis < 2; ++axis) {
    const double slope = -value[axis] / value[2];
    // This bound is not to first order, because the divisor may be little more than its error.
    const double bound =
        (error[axis] + std::abs(slope) * error[2]) / (std::abs(value[2]) - error[2]) + 2 * division * std::abs(slope);
    const double gradient = static_cast<double>(e_.probe.gradient[i][axis]) * frame_.tile_size()[axis];
    raise_error(found.excess, std::abs(gradient - slope) / (bound + std::numeric_limits<float>::min()));
  }
}

void ProbeCheck::compare(size_t i, ProbeErrors& found) const {
  const Place place = looked_up(i);
  if (!e_.probe.asks(i)) {
    raise_error(found.excess, may_ask_nothing(place) ? 0 : std::numeric_limits<double>::infinity());
    return;
  }
  if (frame_.map_shape() == MapShape::cube)
    compare_cube(i, place, found);
  else
    compare_flat(i, place, found);
  compare_shading(i, place, found);
  if (e_.probe.tap_reference->plane) compare_gradient(i, place, found);
}

}  // namespace noonmark
