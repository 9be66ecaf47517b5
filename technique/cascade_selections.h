// By what a receiver's cascade is chosen. A selection is one row of this table, a formula in technique/cascade_place.glsl and a
// shader that calls it; the choice of cascades.select is made from the rows.
//
//   const CascadeSelection& selection = find_cascade_selection("map");
//   selection.place_in_double(place, 2, eye_m, P);   // at most 1: cascade 2 holds P
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "technique/bounded.h"

namespace noonmark {

struct CascadePlace;

struct CascadeSelection {
  std::string_view name;    // a choice of cascades.select
  std::string_view shader;  // the file in gl/shaders that defines cascade_place() for it
  std::string_view help;
  // The place of a point in a cascade that is not the last (technique/cascade_place.glsl): in double, and with the bound of
  // the error that a shader's float arithmetic makes. `at` is a float vector, because a shader has it so.
  double (*place_in_double)(const CascadePlace&, int cascade, glm::dvec3 eye_m, glm::dvec3 at);
  Bounded (*place_in_bounds)(const CascadePlace&, int cascade, glm::dvec3 eye_m, glm::vec3 at);
};

std::span<const CascadeSelection> cascade_selections();

// Throws std::logic_error if no row has that name.
const CascadeSelection& find_cascade_selection(std::string_view name);

// The weight of the next cascade at a place, and the most that the shader's float arithmetic can be off. The CascadePlace must
// have a blend band.
double weight_of_next(const CascadePlace&, double place);
Bounded weight_of_next(const CascadePlace&, Bounded place);

}  // namespace noonmark
