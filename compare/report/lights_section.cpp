#include "compare/report/lights_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "compare/report/blocks.h"
#include "compare/report/cause_colors.h"
#include "compare/report/tables.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

constexpr size_t most_frames = 12;

// One frame: the points of its lights, in the order of the parts.
using Frame = std::vector<const PointRecord*>;

double error_of_frame(const Frame& frame) { return metric_of(*frame.front(), "lights_error"); }

// The frame with the largest error comes first, and before it any frame whose error is not a number.
std::vector<Frame> frames_of(const Results& results) {
  std::map<double, Frame> by_number;
  for (const PointRecord& point : results.points)
    if (point.metrics.contains("lights_frame")) by_number[point.metrics.at("lights_frame")].push_back(&point);
  std::vector<Frame> frames;
  for (auto& [number, frame] : by_number) frames.push_back(std::move(frame));
  std::stable_sort(frames.begin(), frames.end(), [](const Frame& a, const Frame& b) {
    const double x = error_of_frame(a), y = error_of_frame(b);
    return std::isnan(x) ? !std::isnan(y) : x > y;
  });
  return frames;
}

// The cause with the largest share of the light's own error; null if it has none.
const CauseColor* largest_cause(const PointRecord& point) {
  const CauseColor* largest = nullptr;
  double most = 0;
  for (const CauseColor& color : causes_of(std::span(&point, 1))) {
    if (color.name == "aliasing" || color.name == "coverage") continue;  // their dark and light parts stand alone
    const double value = metric_of(point, std::string(color.name));
    if (value > most) {
      most = value;
      largest = find_color(color.name);
    }
  }
  return largest;
}

const PointRecord* with_largest_share(const Frame& frame) {
  return *std::max_element(frame.begin(), frame.end(), [](const PointRecord* a, const PointRecord* b) {
    return metric_of(*a, "light_share") < metric_of(*b, "light_share");
  });
}

std::string setting_of(const PointRecord& point, const char* name) {
  const auto found = point.settings.find(name);
  return found == point.settings.end() ? "" : found->second;
}

struct Column {
  const char *name, *unit;
  // On a narrow screen each cell stands in a line of its own, with this before it (table.stacked in page/style.css).
  Attribute label() const { return {"data-label", *unit ? fmt::format("{}, {}", name, unit) : name}; }
  Markup head() const { return *unit ? th(with_small(name, unit)) : th(css("text"), name); }
};
constexpr Column columns[] = {{"Resolution", "texels"},    {"Share of the light", "%"},
                              {"Its own error", "%"},      {"Its part of the frame's error", "%"},
                              {"Share of all parts", "%"}, {"Largest cause", ""}};

Markup row_of(const PointRecord& point) {
  const auto percent = [&](const Column& column, const char* name) {
    return td(column.label(), cell(metric_of(point, name), "fraction"));
  };
  const CauseColor* cause = largest_cause(point);
  return tr(
      row_head(css("text"), point_link(point.id, point.part)),
      td(columns[0].label(), setting_of(point, "map.resolution")), percent(columns[1], "light_weight"),
      percent(columns[2], "error"), percent(columns[3], "light_error"), percent(columns[4], "light_share"),
      td(css("text"), columns[5].label(), cause ? swatch(cause->name) + " " + Markup(cause->label) : Markup("none")));
}

Markup table_of(const Frame& frame) {
  Markup rows;
  for (const PointRecord* point : frame) rows += row_of(*point);
  Markup head = th(css("text"), "Light");
  for (const Column& column : columns) head += column.head();
  return div(css("scroll"), table("numbers stacked", head, rows));
}

std::string frame_name(const Frame& frame, const std::vector<std::string>& swept) {
  return settings_phrase(*frame.front(), swept);
}

}  // namespace

Markup lights_section(const Results& results, const std::function<std::string(const std::string&)>& read_file) {
  const std::vector<Frame> frames = frames_of(results);
  if (frames.empty()) return "";
  Markup content = paragraph(
      "Each light has its own map and is measured by itself. At a pixel, a light counts by its share of the light that "
      "would reach it without shadows.");
  for (size_t f = 0; f < std::min(frames.size(), most_frames); ++f) {
    const Frame& frame = frames[f];
    const PointRecord& first = *frame.front();
    const std::string name = frame_name(frame, results.info.swept);
    if (!name.empty()) content += element("h3", name) + "\n";
    content +=
        paragraph(prose("Frame of {} lights: error {}; shaded, a root mean square difference of {} and a FLIP of {}.",
                        frame.size(), bold(quantity(error_of_frame(frame), "fraction")),
                        number(metric_of(first, "lights_rmse")), number(metric_of(first, "lights_flip"))));
    content += table_of(frame) + "\n";
    Markup figures;
    for (const PictureRecord& record : first.pictures)
      if (record.name.starts_with(lights_pictures)) figures += picture_figure(record, read_file);
    if (!figures.empty()) content += div(css("stage"), "\n", figures) + "\n";
  }
  if (frames.size() > most_frames)
    content += paragraph(css("small"), prose("The {} frames with the largest error of {} are shown; the others are in "
                                             "the table of points and in {}.",
                                             most_frames, frames.size(), code("results.csv")));
  return section("lights", "Lights", content);
}

const PointRecord* largest_light(const Results& results) {
  const std::vector<Frame> frames = frames_of(results);
  if (frames.empty()) return nullptr;
  const PointRecord* const most = with_largest_share(frames.front());
  return metric_of(*most, "light_share") > 0 ? most : nullptr;
}

Markup lights_sentence(const Results& results) {
  const std::vector<Frame> frames = frames_of(results);
  if (frames.empty()) return "";
  const Frame& worst = frames.front();
  const PointRecord& most = *with_largest_share(worst);
  const CauseColor* cause = largest_cause(most);
  return prose("Together the {} lights make a frame with an error of {}; {} makes {} of it{}.", worst.size(),
               bold(quantity(error_of_frame(worst), "fraction")), bold(most.part),
               quantity(metric_of(most, "light_share"), "fraction"),
               cause ? fmt::format(": {}", cause->label) : std::string());
}

}  // namespace noonmark::report
