#include "compare/report/flicker_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/ladder/flicker.h"
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

// A bar for each frame, as high as its flicker; `largest` is the whole height.
std::string strip_svg(const Strip& strip, double largest) {
  const double step = strip_width / static_cast<double>(strip.frames.size());
  std::string bars;
  for (size_t i = 0; i < strip.frames.size(); ++i) {
    const PointRecord& point = *strip.frames[i];
    double top = strip_height;
    std::string parts;
    for (const CauseColor& color : flicker_colors) {
      const double value = metric_of(point, std::string(color.name));
      if (!(value > 0) || !std::isfinite(value) || !(largest > 0)) continue;
      const double height = value / largest * strip_height;
      top -= height;
      parts += fmt::format("<rect x=\"{:.2f}\" y=\"{:.3f}\" width=\"{:.2f}\" height=\"{:.3f}\" fill=\"{}\"/>",
                           static_cast<double>(i) * step, top, std::max(step * 0.9, 0.5), height, rgb_of(color));
    }
    if (!parts.empty())
      bars += fmt::format("<g><title>frame {}: {}</title>{}</g>", html(frame_of(point)),
                          quantity(flicker_of_point(point), "fraction"), parts);
  }
  return fmt::format(
      "<svg viewBox=\"0 0 {0:g} {1:g}\" width=\"100%\" height=\"{1:g}\" preserveAspectRatio=\"none\" role=\"img\" "
      "aria-label=\"Flicker over {2} frames\"><line x1=\"0\" x2=\"{0:g}\" y1=\"{1:g}\" y2=\"{1:g}\" "
      "stroke=\"currentColor\" vector-effect=\"non-scaling-stroke\"/>{3}</svg>",
      strip_width, strip_height, strip.frames.size(), bars);
}

std::string numbers_of_point(const PointRecord& point) {
  std::string cells = fmt::format("<td>{}</td><td>{}</td>", cell(flicker_of_point(point), "fraction"),
                                  cell(metric_of(point, "flicker_changed"), "fraction"));
  for (const CauseColor& color : flicker_colors)
    cells += fmt::format("<td>{}</td>", cell(metric_of(point, std::string(color.name)), "fraction"));
  return cells + fmt::format("<td>{}</td>", cell(metric_of(point, "flicker_truth"), "fraction"));
}

std::string head_of_numbers() {
  std::string head = "<th>Flicker <small>%</small></th><th>Changed <small>%</small></th>";
  for (const CauseColor& color : flicker_colors) head += fmt::format("<th>{} <small>%</small></th>", html(color.label));
  return head + "<th>Truth changed <small>%</small></th>";
}

}  // namespace

bool has_flicker(const Results& results) {
  return std::any_of(results.points.begin(), results.points.end(),
                     [](const PointRecord& point) { return point.metrics.contains("flicker"); });
}

std::string flicker_strips(const Results& results) {
  const std::vector<Strip> strips = strips_of_motion(results);
  std::string legend, figures;
  for (const CauseColor& color : flicker_colors)
    legend +=
        fmt::format("<span><i class=\"sw\" style=\"background:{}\"></i>{}</span>\n", rgb_of(color), html(color.label));
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
  for (const Strip* strip : drawn)
    figures += fmt::format(
        "<figure class=\"chart strip\"><figcaption><b>{}</b>: {}</figcaption>{}</figure>\n", html(strip->name),
        flicker_of_point(*strip->worst) == 0 ? "no point of the world changes in any frame"
                                             : "at most " + quantity(flicker_of_point(*strip->worst), "fraction") +
                                                   ", at frame " + html(frame_of(*strip->worst)),
        strip_svg(*strip, largest));
  return fmt::format(
      "<p>How much the shadow of a point of the world changes from each frame to the next although its truth does not: "
      "the "
      "mean change of its light over the points that both frames see. The colours say what brought the change. All "
      "strips "
      "have one scale; their top is {}.</p>\n<div class=\"legend\">{}</div>\n{}{}",
      quantity(largest, "fraction"), legend, figures,
      strips.size() > drawn.size()
          ? fmt::format("<p class=\"small\">The {} choices that flicker most of {} are drawn.</p>\n", drawn.size(),
                        strips.size())
          : "");
}

std::string flicker_sentence(const Results& results) {
  const std::vector<Strip> strips = strips_of_motion(results);
  if (strips.empty()) return "";
  std::vector<std::string> still;
  const Strip* most = &strips.front();
  for (const Strip& strip : strips) {
    if (flicker_of_point(*strip.worst) == 0) still.push_back(html(strip.name));
    if (flickers_more(*strip.worst, *most->worst)) most = &strip;
  }
  constexpr size_t most_named = 3;
  std::string out;
  if (!still.empty())
    out = fmt::format("Of {} choices {} {} not flicker in any frame{}.", strips.size(), still.size(),
                      still.size() == 1 ? "does" : "do",
                      still.size() <= most_named ? fmt::format(": {}", fmt::join(still, ", ")) : "");
  if (still.size() < strips.size())
    out += fmt::format("{}<b>{}</b> flickers most: {} of the light at <a href=\"#p{}\">frame {}</a>.",
                       out.empty() ? "" : " ", html(most->name), quantity(flicker_of_point(*most->worst), "fraction"),
                       most->worst->id, html(frame_of(*most->worst)));
  return out;
}

std::string flicker_section(const Results& results, bool strips_on_first_screen) {
  const std::vector<Strip> strips = strips_of_motion(results);
  std::string table, rows;
  size_t frames = 0;
  for (const Strip& strip : strips) {
    frames += strip.frames.size();
    table += fmt::format(
        "<tr><th class=\"text\" scope=\"row\">{}</th><td>{}</td><td>{}</td><td><a href=\"#p{}\">{}</a></td>{}</tr>\n",
        html(strip.name), strip.frames.size(), cell(strip.mean, "fraction"), strip.worst->id,
        html(frame_of(*strip.worst)), numbers_of_point(*strip.worst));
  }
  if (frames <= most_frame_rows) {
    for (const Strip& strip : strips)
      for (const PointRecord* point : strip.frames)
        rows += fmt::format("<tr><th class=\"text\" scope=\"row\">{}</th><td><a href=\"#p{}\">{}</a></td>{}</tr>\n",
                            html(strip.name), point->id, html(frame_of(*point)), numbers_of_point(*point));
    rows = fmt::format(
        "<details class=\"more\"><summary>Every frame ({})</summary><div class=\"scroll tall\"><table "
        "class=\"numbers\"><thead><tr>"
        "<th class=\"text\">Choice</th><th>Frame</th>{}</tr></thead><tbody>\n{}</tbody></table></div></details>\n",
        frames, head_of_numbers(), rows);
  }
  return fmt::format(
      "<section id=\"motion\"><h2>Motion</h2>\n{}"
      "<div class=\"scroll\"><table class=\"numbers\"><thead><tr><th class=\"text\">Choice</th><th>Frames</th><th>Mean "
      "flicker "
      "<small>%</small></th><th>Worst frame</th>{}</tr></thead><tbody>\n{}</tbody></table></div>\n{}</section>\n",
      strips_on_first_screen ? "<p>The strips of all choices are at the top of this page.</p>\n"
                             : flicker_strips(results),
      head_of_numbers(), table, rows);
}

}  // namespace noonmark::report
