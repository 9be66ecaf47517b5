// The parts of a bias. A bias is the sum of its parts. A part is one file, technique/bias/<name>.glsl, which the shader
// and the host compile, and one row of the table in bias_parts.cpp. The settings, uniforms, the shader's text, cache
// keys, idle settings and the bias curve are made from the rows.
//
//   for (const BiasPart& part : bias_parts()) print(part.name, part.help);
//   settings.bias["normal_offset"] = 1.5;   // technique/settings.h
//
// A part acts at one of three places:
// - The compared depth. The part is amount * <name>_factor(Surface), clamped to the part's floor and cap if it has
//   them. The sum of these parts, in units of bias.unit, is subtracted from the depth that a tap is compared with.
// - The place looked up. The part is amount * <name>_way(Surface), a vector in the world. The lookup uses the
//   receiver's position plus this vector.
// - The caster. amount * <name>_way(Surface) moves each vertex while the map is drawn (technique/casters.h); Surface is
//   that of the vertex. The polygon offset is OpenGL's own and has no formula.
// The reference is a separate choice: the depth that a tap is compared with before the bias is subtracted.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "technique/formulas.h"

namespace noonmark {

enum class BiasTarget { compared_depth, place_looked_up, caster };

// The functions that the host compiles from the formula of a part.
struct BiasFormula {
  float (*factor)(in_float::Surface) = nullptr;          // compared_depth
  in_double::vec3 (*way)(in_double::Surface) = nullptr;  // place_looked_up, caster
  in_bounds::vec3 (*bounded_way)(in_bounds::Surface) = nullptr;
  int operations =
      0;  // of the factor or way, counted as LookupCost::operations (technique/cost.h); unread of a caster's
};

struct BiasPart {
  std::string_view name;  // name of its setting bias.<name> and of its file, if it has one
  BiasTarget acts_on = BiasTarget::compared_depth;
  std::string_view unit;  // the unit of the amount: "bias.unit"; "bias.offset_unit" of what moves a place; "" ...
  double most = 0;        // the amount is in 0 ... most; of a part with either sign in -most ... most
  std::string_view help;
  std::string_view law;              // what the laws say of it, for the table in docs/reference/techniques.md
  std::string_view floor_help = {};  // empty: the part has no floor; otherwise help of the setting bias.<name>_floor
  std::string_view cap_help = {};    // empty: the part has no cap; otherwise help of the setting bias.<name>_cap
  std::string_view no_curve = {};    // why one lookup pass cannot give the error at every amount; empty: it can
  BiasFormula formula = {};          // empty: the part is OpenGL's polygon offset
  bool either_sign = false;          // the amount may be negative, which is towards the light
};

std::span<const BiasPart> bias_parts();

// Throws std::logic_error if no row has that name.
const BiasPart& bias_part(std::string_view name);

// One number of a part: its amount, floor or cap. Each is a setting.
struct BiasParameter {
  enum class Role { amount, floor, cap };
  const BiasPart* part;
  Role role;
  std::string name;     // "slope_floor"
  std::string setting;  // "bias.slope_floor"
  std::string_view help;
};

// In the order of the parts; for each part amount, floor, cap.
std::span<const BiasParameter> bias_parameters();
size_t bias_parameter_index(std::string_view name);  // throws std::logic_error if no parameter has that name

// The depth that a tap of the map is compared with, before the bias is subtracted from it. The formula is the function
// <name>(TapPlace) in the file technique/reference/<name>.glsl.
struct TapReference {
  std::string_view name;  // a choice of bias.reference
  std::string_view help;
  std::string_view law;  // as of a part
  float (*depth)(in_float::TapPlace) = nullptr;
  int operations = 0;      // of the formula, as LookupCost::operations
  bool plane = false;      // the reference is the depth of the receiver's plane; this needs a flat map and a depth of
                           // its own for each texel that is read
  bool at_texel = false;   // true: TapPlace::way leads to the centre of the tap's texel; false: to its exact place
  bool reads_cap = false;  // true: the formula reads bias.plane_cap
};

std::span<const TapReference> tap_references();  // the first is own_depth
// Throws std::logic_error if no row has that name.
const TapReference& tap_reference(std::string_view name);

}  // namespace noonmark
