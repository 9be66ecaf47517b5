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

// The cause with the largest mean step; null if there is none. The light's size is no part of the error.
const CauseRow* largest_cause(const Cascade& cascade) {
  const CauseRow* largest = nullptr;
  double most = 0;
  for (const CauseRow& cause : cause_rows) {
    if (!cause.cause || cause.place == CausePlace::light) continue;
    const double size = cascade.metrics.at(std::string(cause.name));
    if (size > most) most = size, largest = &cause;
  }
  return largest;
}

std::string depths_of(const Cascade& cascade) {
  return fmt::format("{:.3g} to {:.3g} m", cascade.begin_m, cascade.end_m);
}

struct Need {
  std::string needed, set;
  bool too_small = false;
};

// The part of the bias that the curve varies: what it has to be in this cascade, and what it is. In metres, if it has
// bias.unit.
std::optional<Need> need_of(const PointRecord& point, const Cascade& cascade) {
  if (!point.curve || !cascade.bias_needed) return std::nullopt;
  // A damaged store may name a part that there is not.
  const std::string& parameter = point.curve->parameter;
  const auto part = std::find_if(bias_parts().begin(), bias_parts().end(),
                                 [&](const BiasPart& one) { return parameter == "bias." + std::string(one.name); });
  const std::optional<double> amount = number_of(setting_of(point, parameter));
  if (part == bias_parts().end() || !amount) return std::nullopt;
  const double set = *amount, needed = *cascade.bias_needed;
  const bool in_unit = part->unit == "bias.unit";
  const std::string unit = setting_of(point, "bias.unit");
  const double metres = unit == "texel"   ? cascade.metrics.at("texel_m")
                        : unit == "depth" ? cascade.metrics.at("map_range_m")
                                          : 1;
  const auto text = [&](double value) {
    return in_unit ? fmt::format("{:.3g} m", value * metres) : fmt::format("{:.3g}", value);
  };
  return Need{text(needed), text(set), set < needed};
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
    if (const CauseRow* cause = largest_cause(cascade)) row.cause = cause->label;
    const std::optional<Need> need = need_of(point, cascade);
    row.bias = need && row.receivers > 0 ? fmt::format("{}, {}", need->needed, need->set) : "-";
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
  const CauseRow* cause = largest_cause(cascade);
  std::string text = fmt::format("Cascade {} ({}, texel {:.2g} m) holds {:.0f}% of the error{}.", worst + 1,
                                 depths_of(cascade), cascade.metrics.at("texel_m"), 100 * error_sum(cascade) / all,
                                 cause ? fmt::format(", most of it: {}", cause->label) : "");
  if (const std::optional<Need> need = need_of(point, cascade); need && need->too_small)
    text +=
        fmt::format(" Its {} is {} where {} is needed against acne.", point.curve->parameter, need->set, need->needed);
  return text;
}

}  // namespace noonmark
