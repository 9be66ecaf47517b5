// The fields of a bias curve, described once: each row has a number or a series of BiasCurve, its unit and its meaning.
// The store's tables, point.json, the report's data, CSV and the names for bounds and laws are made from these rows.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

struct CurveField {
  std::string_view name;  // in the store and in JSON; the name of a depth ends in "_depth"
  std::string_view unit;  // "depth", "fraction" ...; text: ""
  std::string_view help;  // one sentence
  using Member = std::variant<std::string BiasCurve::*, double BiasCurve::*, std::optional<double> BiasCurve::*,
                              uint64_t BiasCurve::*>;
  Member member;
  // Bounds, laws, CSV and tables may use it. A depth is also offered in metres and in texels (its name ends in _m,
  // _texels).
  bool quantity = false;
};
std::span<const CurveField> curve_fields();

// The distance between two ends that the curve has both or neither. The width is 0 if there are none, so that a `min` of
// `window_width_depth` asserts that there is a usable bias.
struct CurveWidth {
  std::string_view name;
  std::string_view unit;
  std::string_view help;       // one sentence
  std::string_view from, to;   // fields of curve_fields(), std::optional<double>; the width is listed after `to`
  bool of_placements = false;  // no value without map.placements
};
std::span<const CurveWidth> curve_widths();

// One value for each bias.
class CurveSeries {
 public:
  constexpr CurveSeries(std::string_view series, std::vector<double> BiasCurve::*plain) : name(series), plain_(plain) {}
  constexpr CurveSeries(std::string_view series, Band BiasCurve::*band, std::vector<double> Band::*part)
      : name(series), band_(band), part_(part) {}

  std::string_view name;  // "bias_depth"; the others are metrics
  const std::vector<double>& of(const BiasCurve& curve) const { return plain_ ? curve.*plain_ : curve.*band_.*part_; }
  std::vector<double>& of(BiasCurve& curve) const { return plain_ ? curve.*plain_ : curve.*band_.*part_; }
  bool of_placements() const { return !plain_; }  // then it is empty without map.placements

 private:
  std::vector<double> BiasCurve::*plain_ = nullptr;
  Band BiasCurve::*band_ = nullptr;
  std::vector<double> Band::*part_ = nullptr;
};
std::span<const CurveSeries> curve_series();

// Calls write(name, value) for every field that has a value: a text, a double or a uint64_t.
template <class Write>
void each_field(const BiasCurve& curve, const Write& write) {
  for (const CurveField& field : curve_fields())
    std::visit(
        [&](auto member) {
          const auto& value = curve.*member;
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::optional<double>>) {
            if (value) write(field.name, *value);
          } else {
            write(field.name, value);
          }
        },
        field.member);
}

}  // namespace noonmark
