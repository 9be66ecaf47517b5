#include "compare/report/cascade_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/results/causes.h"
#include "compare/results/quantities.h"
#include "technique/bias_parts.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

using Cascade = PointRecord::Cascade;

// |R5 - R1| summed over the counted receivers.
double error_sum(const Cascade& cascade) {
  const double counted = cascade.metrics.at("counted");
  return counted > 0 ? counted * cascade.metrics.at("error") : 0;
}

double whole_error(const PointRecord& point) {
  double sum = 0;
  for (const Cascade& cascade : point.cascades) sum += error_sum(cascade);
  return sum;
}

struct LargestCause {
  std::string_view label;
  double size = 0;    // mean step
  double of_all = 0;  // its share of the steps of all causes
};

// The cause, or the kind of cause that darkens and lightens, with the largest mean step. The light's size is no part of the
// error.
LargestCause largest_cause(const Cascade& cascade) {
  LargestCause largest;
  double all = 0;
  for (const CauseRow& row : cause_rows) {
    if (row.place == CausePlace::light || !row.sum.empty()) continue;  // a part is counted in its sum
    double size = 0;
    for (const CauseRow& part : cause_rows)
      if (part.cause && (part.name == row.name || part.sum == row.name))
        size += cascade.metrics.at(std::string(part.name));
    all += size;
    if (size > largest.size) largest = {row.label, size, 0};
  }
  if (all > 0) largest.of_all = largest.size / all;
  return largest;
}

std::string depths_of(const Cascade& cascade) {
  return fmt::format("{:.3g} to {:.3g} m", cascade.begin_m, cascade.end_m);
}

struct Need {
  std::string needed, set;
  bool too_small = false;
};

// The amount of the varied part of the bias: "2.22 texels = 0.0539 m", in the unit that the setting has.
std::string amount_text(const PointRecord& point, const Cascade& cascade, const BiasPart& part, double amount) {
  if (part.unit != "bias.unit") return fmt::format("{:.3g}{}{}", amount, part.unit.empty() ? "" : " ", part.unit);
  const std::string unit = setting_of(point, "bias.unit");
  if (unit == "m") return fmt::format("{:.3g} m", amount);
  const bool texels = unit == "texel";
  return fmt::format("{:.3g} {} = {:.3g} m", amount, texels ? "texels" : "depth",
                     amount * cascade.metrics.at(texels ? "texel_m" : "map_range_m"));
}

// What the part of the bias that the curve varies has to be in this cascade, and what it is.
std::optional<Need> need_of(const PointRecord& point, const Cascade& cascade) {
  if (!point.curve) return std::nullopt;
  // A damaged store may name a part that there is not.
  const std::string& parameter = point.curve->parameter;
  const auto part = std::find_if(bias_parts().begin(), bias_parts().end(),
                                 [&](const BiasPart& one) { return parameter == "bias." + std::string(one.name); });
  const std::optional<double> set = number_of(setting_of(point, parameter));
  if (part == bias_parts().end() || !set) return std::nullopt;
  const auto text = [&](double amount) { return amount_text(point, cascade, *part, amount); };
  return Need{cascade.bias_needed ? text(*cascade.bias_needed) : "-", text(*set),
              cascade.bias_needed && *set < *cascade.bias_needed};
}

}  // namespace

std::vector<CascadeRow> cascade_rows_of(const PointRecord& point) {
  std::vector<CascadeRow> rows;
  const double all = whole_error(point);
  for (const Cascade& cascade : point.cascades) {
    CascadeRow row;
    row.number = static_cast<int>(rows.size()) + 1;
    row.depths = depths_of(cascade);
    row.texel = fmt::format("{:.3g} m", cascade.metrics.at("texel_m"));
    row.receivers = cascade.metrics.at("counted");
    row.error = row.receivers > 0 ? fmt::format("{:.4f}%", 100 * cascade.metrics.at("error")) : "-";
    row.share = all > 0 ? fmt::format("{:.0f}%", 100 * error_sum(cascade) / all) : "-";
    row.cause = largest_cause(cascade).label;
    const std::optional<Need> need = need_of(point, cascade);
    if (need) row.needed = need->needed, row.set = need->set;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string worst_cascade(const PointRecord& point) {
  const double all = whole_error(point);
  if (!(all > 0)) return "";
  size_t worst = 0;
  for (size_t k = 1; k < point.cascades.size(); ++k)
    if (error_sum(point.cascades[k]) > error_sum(point.cascades[worst])) worst = k;
  const Cascade& cascade = point.cascades[worst];
  const LargestCause cause = largest_cause(cascade);
  std::string text = fmt::format(
      "Cascade {} ({}, texel {:.2g} m) holds {:.0f}% of the error{}.", worst + 1, depths_of(cascade),
      cascade.metrics.at("texel_m"), 100 * error_sum(cascade) / all,
      cause.size > 0 ? fmt::format("; its largest cause: {}, {:.0f}%", cause.label, 100 * cause.of_all) : "");
  if (const std::optional<Need> need = need_of(point, cascade); need && need->too_small)
    text +=
        fmt::format(" Its {} is {} where {} is needed against acne.", point.curve->parameter, need->set, need->needed);
  return text;
}

}  // namespace noonmark
