// The rows of the settings of the bias, for the table in technique/settings.cpp.
#include <cmath>
#include <limits>

#include "base/error.h"
#include "technique/setting_rows.h"
#include "technique/setting_rules.h"

namespace noonmark::setting_rows {

using namespace setting_rules;

#define MEMBER(path) [](Settings& s) -> decltype((s.path)) { return s.path; }

namespace {

// A part that moves the lookup or the caster changes which texels are read or what they hold. A part that is subtracted
// from the compared depth changes the verdict only.
Stages stages_of(BiasTarget place) {
  switch (place) {
    case BiasTarget::compared_depth:
      return {Stage::ladder};
    case BiasTarget::place_looked_up:
      return {Stage::lookup};
    case BiasTarget::caster:
      return {Stage::map, Stage::lookup};
  }
  throw std::logic_error("a part of the bias that acts nowhere");
}

// The row of one parameter of a part of the bias.
Setting bias_row(const BiasParameter& parameter) {
  const bool is_cap = parameter.role == BiasParameter::Role::cap;
  Setting row{parameter.setting,
              parameter.part->unit,
              ValueType::real,
              parameter.part->either_sign && parameter.role == BiasParameter::Role::amount ? -parameter.part->most : 0,
              parameter.part->most,
              is_cap,
              {},
              std::string(parameter.help),
              {},
              {}};
  row.get = [&parameter](const Settings& s) {
    const double value = s.bias[parameter.name];
    return std::isinf(value) ? std::string("auto") : number_text(value);
  };
  row.set = [&parameter, row](Settings& s, std::string_view text) {
    s.bias[parameter.name] =
        row.may_be_auto && text == "auto" ? std::numeric_limits<double>::infinity() : parse_real(row, text);
  };
  row.read_by = stages_of(parameter.part->acts_on);
  const BiasPart& part = *parameter.part;
  if (part.acts_on == BiasTarget::caster && !part.formula.way)
    row.why_idle = [](const Settings& s, LightKind light) {
      const std::string why = on_cube_map(s, light);
      return why.empty() ? why : why + ", whose shader writes its depth itself";
    };
  if (!is_cap) return row;
  row.why_idle = [&part](const Settings& s, LightKind) {
    const std::string name(part.name);
    const bool acts = s.bias[name] != 0 || (!part.floor_help.empty() && s.bias[name + "_floor"] != 0);
    return acts ? "" : fmt::format("with bias.{} = 0", name);
  };
  if (part.floor_help.empty()) return row;
  row.why_refused = [&part](const Settings& s, std::optional<LightKind>) {
    const std::string name(part.name);
    const double floor = s.bias[name + "_floor"], cap = s.bias[name + "_cap"];
    return floor > cap ? fmt::format("bias.{0}_floor = {1} is more than bias.{0}_cap = {2}", name, floor, cap) : "";
  };
  return row;
}

}  // namespace

std::vector<Setting> bias_rows() {
  std::vector<Setting> rows = {
      choice("bias.unit", {"depth", "m", "texel"},
             "Unit of the parts of the bias that have no unit of their own: window depth, metres of the map's depth, "
             "or texels of the map at the receiver.",
             MEMBER(bias.unit))
          .idle(without_part_in_unit),
      choice(
          "bias.offset_unit", {"texel", "m"},
          "Unit of the parts of the bias that move a place: the receiver's that is looked up (bias.normal_offset ...) "
          "or the caster's (bias.caster_offset ...). texel: the width of a texel there; m: metres, as in three.js.",
          MEMBER(bias.offset_unit))
          .idle(without_offset)
          .only_read_by({Stage::map, Stage::lookup}),
      named("bias.reference", "The depth that a tap is compared with, before the bias is subtracted.", tap_references(),
            MEMBER(bias.reference))
          .refused(plane_on_cube_or_blended),
      real(
          "bias.plane_cap", "bias.unit", 0, 1e6,
          "receiver_plane: largest difference between the compared depth and the receiver's own depth; auto: no limit.",
          MEMBER(bias.plane_cap))
          .idle(without_capped_plane),
  };
  for (const BiasParameter& parameter : bias_parameters()) rows.push_back(bias_row(parameter));
  return rows;
}

#undef MEMBER

}  // namespace noonmark::setting_rows
