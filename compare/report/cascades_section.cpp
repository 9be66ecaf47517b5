#include "compare/report/cascades_section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "compare/ladder/flicker.h"
#include "compare/report/blocks.h"
#include "compare/report/cascade_rows.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

Markup table_of(const PointRecord& point) {
  const std::string unit = cascade_bias_unit(point);
  const bool varies = cascade_bias_unit_varies(point);
  const auto share = [](const std::optional<double>& value) { return value ? cell(*value, "fraction") : "-"; };
  const auto amounts = [&](const std::optional<double>& amount, double m_per_unit) {
    Markup cells = td(amount ? number(*amount) : "-");
    if (varies) cells += td(amount ? number(*amount * m_per_unit) : "-");
    return cells;
  };
  const auto depth = [](double m) { return std::isfinite(m) ? number(m) : "-"; };
  const bool by_depth = cascades_by_depth(point);
  Markup rows;
  for (const CascadeRow& row : cascade_rows_of(point))
    rows += tr(row_head(std::to_string(row.number)), td(depth(row.begin_m)), td(depth(row.end_m)),
               td(number(row.texel_m)), td(cell(row.receivers, "count")), td(share(row.error)), td(share(row.share)),
               td(css("text"), row.cause.empty() ? "-" : std::string(row.cause)), td(share(row.seam)),
               amounts(row.needed, row.m_per_unit), amounts(row.set, row.m_per_unit));
  const auto bias = [&](const char* name) {
    Markup heads = th(with_small(name, unit));
    if (varies) heads += th(with_small(name, "m"));
    return heads;
  };
  const Markup head = th("Cascade") + th(with_small(by_depth ? "From" : "Receivers from", "m")) +
                      th(with_small("To", "m")) + th(with_small("Texel", "m")) + th("Receivers") +
                      th(with_small("Error", "%")) + th(with_small("Of all error", "%")) +
                      th(css("text"), "Largest cause") + th(with_small("Seam", "%")) + bias("Bias needed") +
                      bias("Bias set");
  return div(css("scroll"), table("numbers", head, rows)) + "\n";
}

}  // namespace

Markup cascades_section(const Results& results) {
  std::vector<const PointRecord*> points;
  for (const PointRecord& point : results.points)
    if (!point.cascades.empty()) points.push_back(&point);
  if (points.empty()) return "";
  // Of the frames of a motion the one with the largest error.
  std::vector<std::string> names;
  for (const std::string& name : results.info.swept)
    if (!names_a_frame(name)) names.push_back(name);
  std::map<std::string, const PointRecord*> of_choices;
  for (const PointRecord* point : points) {
    const PointRecord*& worst = of_choices[point->part + '\n' + settings_phrase(*point, names)];
    if (!worst || metric_of(*point, "error") > metric_of(*worst, "error")) worst = point;
  }
  points.clear();
  for (const auto& [choice, point] : of_choices) points.push_back(point);
  const size_t all = points.size();
  std::stable_sort(points.begin(), points.end(), [](const PointRecord* a, const PointRecord* b) {
    return metric_of(*a, "error") > metric_of(*b, "error");
  });
  if (points.size() > most_cascade_points) points.resize(most_cascade_points);
  std::sort(points.begin(), points.end(), [](const PointRecord* a, const PointRecord* b) { return a->id < b->id; });
  Markup content = paragraph(
      "Each cascade is a map of its own for a slice of the view's depth. Its error is the mean over its own receivers, "
      "and "
      "the share is of the whole picture's error. Seam is how far the picture would jump if the receivers in its last "
      "4% were looked up in the next cascade. The bias "
      "that it needs is the least one without acne. From and to are the depths of the slice; where cascades.select is "
      "not depth, they are those of the receivers that are looked up in the cascade. Elsewhere on this page, a bias in "
      "another unit than bias.unit is that at the median receiver: depth and texels differ between "
      "cascades.");
  for (const PointRecord* point : points) {
    std::string phrase = settings_phrase(*point, results.info.swept);
    if (!point->part.empty()) phrase = point->part + (phrase.empty() ? "" : ": ") + phrase;
    const std::string worst = worst_cascade(*point);
    content += element("h3", point_link(point->id, phrase.empty() ? prose("Point {}", point->id) : Markup(phrase)));
    if (!worst.empty()) content += paragraph(worst);
    content += table_of(*point);
  }
  if (all > points.size())
    content += paragraph(css("small"),
                         prose("The {} choices with the largest error of {} that have cascades.", points.size(), all));
  return section("cascades", "Cascades", content);
}

}  // namespace noonmark::report
