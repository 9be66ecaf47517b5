#include "compare/report/tornado.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/report/blocks.h"
#include "compare/report/page_parts.h"
#include "compare/report/text.h"

namespace noonmark {
namespace {

using report::Markup;

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

report::Attribute pixels(report::Name name, double value) { return {name, fmt::format("{:.1f}", value)}; }

Markup text_at(double x, double y, std::string_view classes, const Markup& text) {
  return report::element("text", report::css(classes), pixels("x", x), pixels("y", y), text) + "\n";
}

Markup line_at(double x, double top, double bottom, std::string_view classes) {
  return report::element("line", report::css(classes), pixels("x1", x), pixels("x2", x), pixels("y1", top),
                         pixels("y2", bottom));
}

Markup bar(const ErrorAxis& axis, double from, const TornadoEnd& end, double y, std::string_view kind,
           const char* label) {
  using namespace report;
  if (!end.why_not.empty()) return text_at(from + 6, y + 13, "none", prose("{}: not possible", label));
  const double to = axis.at(end.error);
  const bool right = to >= from;
  return element("rect", css(fmt::format("{}{}", kind, end.held ? "" : " broken")), pixels("x", std::min(from, to)),
                 pixels("y", y), pixels("width", std::max(1.5, std::abs(to - from))), Attribute("height", 16)) +
         text_at(right ? to + 5 : to - 5, y + 13, right ? "" : "end",
                 prose("{}: {}{}", label, end.value, end.held ? "" : " ✗"));
}

Markup chart(const Tornado& tornado) {
  using namespace report;
  const ErrorAxis axis(tornado);
  const double base = axis.at(tornado.error),
               bottom = chart_top + row_height * static_cast<double>(tornado.rows.size());
  Markup drawn;
  for (double tick : axis.ticks())
    drawn += line_at(axis.at(tick), chart_top, bottom, "grid") +
             text_at(axis.at(tick), bottom + 18, "tick", quantity(tick, "fraction"));
  double y = chart_top;
  for (const TornadoRow& row : tornado.rows) {
    drawn += text_at(ErrorAxis::left - 12, y + 18, "end name", row.setting);
    drawn += text_at(ErrorAxis::left - 12, y + 34, "end", with_unit(row.value, row));
    drawn += bar(axis, base, row.half, y + 4, "half", "½") + bar(axis, base, row.twice, y + 22, "twice", "2×");
    y += row_height;
  }
  drawn += line_at(base, chart_top - 8, bottom, "base") +
           text_at(base, chart_top - 14, "tick", prose("as recommended: {}", quantity(tornado.error, "fraction")));
  return element("svg", css("tornado"), Attribute("viewBox", fmt::format("0 0 1010 {:.0f}", bottom + 30)),
                 Attribute("role", "img"),
                 Attribute("aria-label",
                           "Tornado chart: the error at half and at double of each setting; the table below has its "
                           "numbers"),
                 "\n", drawn);
}

Markup numbers(const Tornado& tornado) {
  using namespace report;
  Markup rows;
  const auto ends = [](const char* open, const TornadoEnd& end) {
    return td(open, end.value) + td(tornado_error(end));
  };
  for (const TornadoRow& row : tornado.rows)
    rows += tr(row_head(row.setting), td(with_unit(row.value, row)), ends("", row.half), ends("", row.twice),
               ends(row.low_open ? "at most " : "", row.low), ends(row.high_open ? "at least " : "", row.high));
  return table("",
               heads({"Setting", "Recommended", "Half", "Error", "Double", "Error", "The bounds hold from", "Error",
                      "to", "Error"}),
               rows);
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

std::string to_tornado_page(const Tornado& tornado, const std::string& version) {
  using namespace report;
  const Markup words = prose(
      "{} As recommended it is {}. Blue: half of the setting. Ochre: double. ✗ and a red edge: a bound breaks there.",
      what_it_is(tornado), bold(quantity(tornado.error, "fraction")));
  return plain_page({.title = "What each setting does around the recommendation",
                     .body = paragraph(words) + div(css("scroll"), chart(tornado)) + "\n" +
                             element("h2", "The numbers") + "\n" + div(css("scroll"), numbers(tornado)) + "\n",
                     .version = version,
                     .style = "tornado"});
}

}  // namespace noonmark
