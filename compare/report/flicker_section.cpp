#include "compare/report/flicker_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "compare/ladder/flicker.h"
#include "compare/report/blocks.h"
#include "compare/report/cause_colors.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

constexpr size_t most_strips = 12;
constexpr size_t most_frame_rows = 2000;
constexpr double strip_width = 1000, strip_height = 60;

// All frames of one choice, in their order.
struct Strip {
  std::string name;
  std::vector<const PointRecord*> frames;
  double mean = 0;
  const PointRecord* worst = nullptr;
};

// The classes of flicker that these results can have. Without cascades no point goes to another cascade.
using ShownClasses = std::span<const CauseColor>;
ShownClasses classes_of(const Results& results) {
  const bool cascades = std::any_of(results.points.begin(), results.points.end(),
                                    [](const PointRecord& point) { return !point.cascades.empty(); });
  static_assert(flicker_colors.front().name == "flicker_cascade");
  return ShownClasses(flicker_colors).subspan(cascades ? 0 : 1);
}

double flicker_of_point(const PointRecord& point) { return metric_of(point, "flicker"); }

// What a NaN does to a mean and to a maximum: it shows.
bool flickers_more(const PointRecord& a, const PointRecord& b) {
  const double x = flicker_of_point(a), y = flicker_of_point(b);
  return std::isnan(x) ? !std::isnan(y) : x > y;
}

std::vector<Strip> strips_of_motion(const Results& results) {
  std::vector<std::string> names;
  for (const std::string& name : results.info.swept)
    if (!names_a_frame(name)) names.push_back(name);
  std::vector<Strip> strips;
  std::map<std::string, size_t> known;
  for (const PointRecord& point : results.points) {
    if (!point.metrics.contains("flicker")) continue;
    const std::string phrase = settings_phrase(point, names);
    std::string name = point.part;
    if (!phrase.empty()) name += (name.empty() ? "" : ": ") + phrase;
    const auto [at, fresh] = known.emplace(name, strips.size());
    if (fresh) strips.push_back({name.empty() ? "All frames" : name, {}, 0, nullptr});
    strips[at->second].frames.push_back(&point);
  }
  for (Strip& strip : strips) {
    for (const PointRecord* point : strip.frames) {
      strip.mean += flicker_of_point(*point) / static_cast<double>(strip.frames.size());
      if (!strip.worst || flickers_more(*point, *strip.worst)) strip.worst = point;
    }
  }
  return strips;
}

std::string frame_of(const PointRecord& point) {
  const auto value = [&](const char* name) {
    const auto found = point.settings.find(name);
    return found == point.settings.end() ? std::string() : found->second;
  };
  const std::string time = value("scene.time_s");
  return time.empty() || time == "auto" ? value("motion.frame") : time + " s";
}

std::string rgb_of(const CauseColor& color) { return fmt::format("rgb({},{},{})", color.r, color.g, color.b); }

// The bar of one frame: its parts, one on the other, with its number as a title. Empty if nothing flickers.
Markup bar_of(const PointRecord& point, double left, double step, double largest) {
  double top = strip_height;
  Markup parts;
  for (const CauseColor& color : flicker_colors) {
    const double value = metric_of(point, std::string(color.name));
    if (!(value > 0) || !std::isfinite(value) || !(largest > 0)) continue;
    const double height = value / largest * strip_height;
    top -= height;
    parts += element("rect", Attribute("x", fmt::format("{:.2f}", left)), Attribute("y", fmt::format("{:.3f}", top)),
                     Attribute("width", fmt::format("{:.2f}", std::max(step * 0.9, 0.5))),
                     Attribute("height", fmt::format("{:.3f}", height)), Attribute("fill", rgb_of(color)));
  }
  if (parts.empty()) return "";
  const std::string flicker = quantity(flicker_of_point(point), "fraction");
  return element("g", element("title", prose("frame {}: {}", frame_of(point), flicker)), parts);
}

// A bar for each frame, as high as its flicker; `largest` is the whole height.
Markup strip_svg(const Strip& strip, double largest) {
  const double step = strip_width / static_cast<double>(strip.frames.size());
  const std::string width = fmt::format("{:g}", strip_width), height = fmt::format("{:g}", strip_height);
  Markup bars;
  for (size_t i = 0; i < strip.frames.size(); ++i)
    bars += bar_of(*strip.frames[i], static_cast<double>(i) * step, step, largest);
  const Markup base =
      element("line", Attribute("x1", 0), Attribute("x2", width), Attribute("y1", height), Attribute("y2", height),
              Attribute("stroke", "currentColor"), Attribute("vector-effect", "non-scaling-stroke"));
  return element("svg", Attribute("viewBox", fmt::format("0 0 {} {}", width, height)), Attribute("width", "100%"),
                 Attribute("height", height), Attribute("preserveAspectRatio", "none"), Attribute("role", "img"),
                 Attribute("aria-label", fmt::format("Flicker over {} frames", strip.frames.size())), base, bars);
}

Markup numbers_of_point(const PointRecord& point, ShownClasses classes) {
  const auto percent = [&](std::string_view metric) {
    return td(cell(metric_of(point, std::string(metric)), "fraction"));
  };
  Markup cells = percent("flicker") + percent("flicker_changed");
  for (const CauseColor& color : classes) cells += percent(color.name);
  return cells + percent("flicker_truth");
}

Markup head_of_numbers(ShownClasses classes) {
  Markup head = th(with_small("Flicker", "%")) + th(with_small("Changed", "%"));
  for (const CauseColor& color : classes) head += th(with_small(color.label, "%"));
  return head + th(with_small("Truth changed", "%"));
}

Markup strip_figure(const Strip& strip, double largest) {
  const PointRecord& worst = *strip.worst;
  const std::string most =
      flicker_of_point(worst) == 0
          ? "no point of the world changes in any frame"
          : fmt::format("at most {}, at frame {}", quantity(flicker_of_point(worst), "fraction"), frame_of(worst));
  return element("figure", css("chart strip"), element("figcaption", bold(strip.name), ": ", most),
                 strip_svg(strip, largest)) +
         "\n";
}

// Every frame of every choice. Empty if they are too many.
Markup frames_table(const std::vector<Strip>& strips, ShownClasses classes) {
  size_t frames = 0;
  for (const Strip& strip : strips) frames += strip.frames.size();
  if (frames > most_frame_rows) return "";
  Markup rows;
  for (const Strip& strip : strips)
    for (const PointRecord* point : strip.frames)
      rows += tr(row_head(css("text"), strip.name), td(point_link(point->id, frame_of(*point))),
                 numbers_of_point(*point, classes));
  return folded("more", false, prose("Every frame ({})", frames),
                div(css("scroll tall"),
                    table("numbers", th(css("text"), "Choice") + th("Frame") + head_of_numbers(classes), rows)));
}

}  // namespace

bool has_flicker(const Results& results) {
  return std::any_of(results.points.begin(), results.points.end(),
                     [](const PointRecord& point) { return point.metrics.contains("flicker"); });
}

Markup flicker_strips(const Results& results) {
  const std::vector<Strip> strips = strips_of_motion(results);
  Markup legend, figures, left_out;
  for (const CauseColor& color : classes_of(results))
    legend += span(element("i", css("sw"), Attribute("style", "background:" + rgb_of(color))), color.label) + "\n";
  std::vector<const Strip*> drawn;
  double largest = 0;
  for (const Strip& strip : strips) {
    drawn.push_back(&strip);
    if (const double most = flicker_of_point(*strip.worst); most > largest) largest = most;
  }
  std::stable_sort(drawn.begin(), drawn.end(),
                   [](const Strip* a, const Strip* b) { return flickers_more(*a->worst, *b->worst); });
  if (drawn.size() > most_strips) drawn.resize(most_strips);
  std::sort(drawn.begin(), drawn.end());  // in the order of the results
  for (const Strip* strip : drawn) figures += strip_figure(*strip, largest);
  if (strips.size() > drawn.size())
    left_out = paragraph(css("small"),
                         prose("The {} choices that flicker most of {} are drawn.", drawn.size(), strips.size()));
  return paragraph(prose("How much the shadow of a point of the world changes from each frame to the next although its "
                         "truth does not: the mean change of its light over the points that both frames see. The "
                         "colours say what brought the change. All strips have one scale; their top is {}.",
                         quantity(largest, "fraction"))) +
         div(css("legend"), legend) + "\n" + figures + left_out;
}

Markup flicker_sentence(const Results& results) {
  const std::vector<Strip> strips = strips_of_motion(results);
  if (strips.empty()) return "";
  std::vector<Markup> still;
  const Strip* most = &strips.front();
  for (const Strip& strip : strips) {
    if (flicker_of_point(*strip.worst) == 0) still.push_back(strip.name);
    if (flickers_more(*strip.worst, *most->worst)) most = &strip;
  }
  constexpr size_t most_named = 3;
  Markup out;
  if (!still.empty())
    out = prose("Of {} choices {} {} not flicker in any frame{}.", strips.size(), still.size(),
                still.size() == 1 ? "does" : "do", still.size() <= most_named ? ": " + joined(still, ", ") : "");
  if (still.size() < strips.size())
    out += prose("{}{} flickers most: {} of the light at {}.", out.empty() ? "" : " ", bold(most->name),
                 quantity(flicker_of_point(*most->worst), "fraction"),
                 point_link(most->worst->id, "frame " + frame_of(*most->worst)));
  return out;
}

Markup flicker_section(const Results& results, bool strips_on_first_screen) {
  const std::vector<Strip> strips = strips_of_motion(results);
  const ShownClasses classes = classes_of(results);
  Markup rows;
  for (const Strip& strip : strips)
    rows += tr(row_head(css("text"), strip.name), td(strip.frames.size()), td(cell(strip.mean, "fraction")),
               td(point_link(strip.worst->id, frame_of(*strip.worst))), numbers_of_point(*strip.worst, classes));
  const Markup head = th(css("text"), "Choice") + th("Frames") + th(with_small("Mean flicker", "%")) +
                      th("Worst frame") + head_of_numbers(classes);
  return section("motion", "Motion",
                 (strips_on_first_screen ? paragraph("The strips of all choices are at the top of this page.")
                                         : flicker_strips(results)) +
                     div(css("scroll"), table("numbers", head, rows)) + "\n" + frames_table(strips, classes));
}

}  // namespace noonmark::report
