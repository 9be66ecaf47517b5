#include "compare/report/tornado.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/report/text.h"

namespace noonmark {
namespace {

using report::html;

std::string tornado_error(const TornadoEnd& end) {
  if (!end.why_not.empty()) return end.why_not;
  return report::quantity(end.error, "fraction") + (end.held ? "" : ", breaks a bound");
}

std::string with_unit(const std::string& value, const TornadoRow& row) {
  return row.unit.empty() ? value : value + " " + row.unit;
}

std::string range_text(const TornadoRow& row) {
  return fmt::format("{}{} to {}{}", row.low_open ? "at most " : "", row.low.value, row.high_open ? "at least " : "",
                     with_unit(row.high.value, row));
}

std::string what_it_is(const Tornado& tornado) {
  return fmt::format(
      "Each setting is changed alone. The error is the largest {} over {} condition{}{}; the bounds of acne and Peter "
      "Panning "
      "must hold at all {} placements of the map's grid.",
      tornado.accuracy, tornado.conditions, tornado.conditions == 1 ? "" : "s",
      tornado.placed ? fmt::format(" and {} placements", tornado.placements) : " with the map as the settings place it",
      tornado.placements);
}

// Errors on a logarithmic axis. Zero is drawn at its left end.
class ErrorAxis {
 public:
  static constexpr double left = 230, right = 860;
  explicit ErrorAxis(const Tornado& tornado) {
    const auto take = [&](double error) {
      if (!(error > 0) || !std::isfinite(error)) return;
      low_ = std::min(low_, error);
      high_ = std::max(high_, error);
    };
    take(tornado.error);
    for (const TornadoRow& row : tornado.rows)
      for (const TornadoEnd* end : {&row.half, &row.twice})
        if (end->why_not.empty()) take(end->error);
    if (low_ > high_) low_ = high_ = 0.001;  // nothing is wrong anywhere
    low_ = std::pow(10, std::floor(std::log10(low_)));
    high_ = std::pow(10, std::ceil(std::log10(high_ * 1.0001)));
  }
  double at(double error) const {
    if (!(error > 0)) return left;
    return left + (right - left) * std::log10(std::max(1.0, error / low_)) / std::log10(high_ / low_);
  }
  std::vector<double> ticks() const {
    std::vector<double> values;
    for (double value = low_; value <= high_ * 1.01; value *= 10) values.push_back(value);
    return values;
  }

 private:
  double low_ = 1e300, high_ = 0;
};

constexpr double row_height = 44, chart_top = 34;

std::string bar(const ErrorAxis& axis, double from, const TornadoEnd& end, double y, const char* kind,
                const char* label) {
  if (!end.why_not.empty())
    return fmt::format("<text class=\"none\" x=\"{:.1f}\" y=\"{:.1f}\">{}: not possible</text>\n", from + 6, y + 13,
                       label);
  const double to = axis.at(end.error);
  const bool right = to >= from;
  return fmt::format(
      "<rect class=\"{}{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"16\"/><text x=\"{:.1f}\" "
      "y=\"{:.1f}\"{}>{} {}{}"
      "</text>\n",
      kind, end.held ? "" : " broken", std::min(from, to), y, std::max(1.5, std::abs(to - from)),
      right ? to + 5 : to - 5, y + 13, right ? "" : " class=\"end\"", label, html(end.value), end.held ? "" : " ✗");
}

std::string chart(const Tornado& tornado) {
  const ErrorAxis axis(tornado);
  const double base = axis.at(tornado.error),
               bottom = chart_top + row_height * static_cast<double>(tornado.rows.size());
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 1010 {:.0f}\" role=\"img\" aria-label=\"Tornado chart: the error at half and at double of "
      "each "
      "setting; the table below has its numbers\">\n",
      bottom + 30);
  for (double tick : axis.ticks())
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2:.1f}\"/><text class=\"tick\" "
        "x=\"{0:.1f}\" "
        "y=\"{3:.1f}\">{4}</text>\n",
        axis.at(tick), chart_top, bottom, bottom + 18, html(report::quantity(tick, "fraction")));
  double y = chart_top;
  for (const TornadoRow& row : tornado.rows) {
    svg += fmt::format("<text class=\"end name\" x=\"{}\" y=\"{:.1f}\">{}</text>\n", ErrorAxis::left - 12, y + 18,
                       html(row.setting));
    svg += fmt::format("<text class=\"end\" x=\"{}\" y=\"{:.1f}\">{}</text>\n", ErrorAxis::left - 12, y + 34,
                       html(with_unit(row.value, row)));
    svg += bar(axis, base, row.half, y + 4, "half", "½:");
    svg += bar(axis, base, row.twice, y + 22, "twice", "2×:");
    y += row_height;
  }
  return svg + fmt::format(
                   "<line class=\"base\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2:.1f}\"/><text class=\"tick\" "
                   "x=\"{0:.1f}\" y=\"{3}\">as recommended: {4}</text></svg>\n",
                   base, chart_top - 8, bottom, chart_top - 14, html(report::quantity(tornado.error, "fraction")));
}

}  // namespace

std::vector<std::string> tornado_text(const Tornado& tornado) {
  std::vector<std::string> lines{fmt::format("What each setting does around it. {} As recommended it is {}.",
                                             what_it_is(tornado), report::quantity(tornado.error, "fraction"))};
  for (const TornadoRow& row : tornado.rows)
    lines.push_back(fmt::format("- {} = {}: at half ({}) {}; at double ({}) {}; the bounds hold from {}.", row.setting,
                                with_unit(row.value, row), row.half.value, tornado_error(row.half), row.twice.value,
                                tornado_error(row.twice), range_text(row)));
  return lines;
}

std::string to_tornado_page(const Tornado& tornado) {
  std::string text = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1"><meta name="color-scheme" content="light dark">
<title>What each setting does around the recommendation · Noonmark</title>
<style>
body{font:14px/1.4 system-ui,sans-serif;margin:1rem;max-width:70rem;background:Canvas;color:CanvasText}
.scroll{overflow-x:auto}svg{width:100%;min-width:44rem;height:auto;font-size:13px;fill:CanvasText}.end{text-anchor:end}.tick{text-anchor:middle}.name{font-weight:600}
.half{fill:#4477aa}.twice{fill:#c98a1b}.broken{fill-opacity:.35;stroke:#d03434;stroke-width:1.5}
.grid{stroke:#8884}.base{stroke:CanvasText;stroke-width:1.5}.none{fill-opacity:.75}
table{border-collapse:collapse}th,td{border:1px solid #8886;padding:.3rem .5rem;text-align:left;vertical-align:top}
</style></head><body><h1>What each setting does around the recommendation</h1>
)";
  text += fmt::format(
      "<p>{} As recommended it is <b>{}</b>. Blue: half of the setting. Ochre: double. ✗ and a red edge: a bound "
      "breaks there.</p>\n",
      html(what_it_is(tornado)), html(report::quantity(tornado.error, "fraction")));
  text += "<div class=\"scroll\">" + chart(tornado) + "</div>\n";
  text +=
      "<h2>The "
      "numbers</h2><div "
      "class=\"scroll\"><table><thead><tr><th>Setting</th><th>Recommended</th><th>Half</th><th>Error</th><th>Double</"
      "th>"
      "<th>Error</th><th>The bounds hold from</th><th>Error</th><th>to</th><th>Error</th></tr></thead><tbody>\n";
  for (const TornadoRow& row : tornado.rows)
    text += fmt::format(
        "<tr><th "
        "scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}{}</td><td>{}</td><td>{}{}</"
        "td>"
        "<td>{}</td></tr>\n",
        html(row.setting), html(with_unit(row.value, row)), html(row.half.value), html(tornado_error(row.half)),
        html(row.twice.value), html(tornado_error(row.twice)), row.low_open ? "at most " : "", html(row.low.value),
        html(tornado_error(row.low)), row.high_open ? "at least " : "", html(row.high.value),
        html(tornado_error(row.high)));
  return text + "</tbody></table></div></body></html>\n";
}

}  // namespace noonmark
