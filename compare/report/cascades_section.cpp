#include "compare/report/cascades_section.h"

#include <algorithm>
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
  Markup rows;
  for (const CascadeRow& row : cascade_rows_of(point))
    rows +=
        tr(row_head(css("text"), row.number), td(row.depths), td(row.texel), td(number(row.receivers)), td(row.error),
           td(row.share), td(css("text"), row.cause.empty() ? "-" : row.cause), td(row.needed), td(row.set));
  const Markup head = th(css("text"), "Cascade") + th("Depth") + th("Texel") + th("Receivers") + th("Error") +
                      th("Of all error") + th(css("text"), "Largest cause") + th("Bias needed") + th("Bias set");
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
      "the share is of the whole picture's error. The bias that it needs is the least one without acne. Elsewhere on "
      "this "
      "page, a bias in another unit than bias.unit is that at the median receiver: depth and texels differ between "
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
