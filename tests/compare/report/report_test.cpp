// The report: what must hold for its bytes with any results.
#include "compare/report/report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <tuple>

#include "base/error.h"
#include "compare/judge/soundness.h"
#include "compare/ladder/ladder.h"
#include "compare/ladder/numbers.h"
#include "compare/report/cause_colors.h"
#include "compare/report/cause_shares.h"
#include "compare/report/data.h"
#include "compare/report/element.h"
#include "compare/report/section_picture.h"
#include "compare/report/sections.h"
#include "compare/report/summary.h"
#include "compare/report/text.h"
#include "compare/results/metrics.h"
#include "tests/compare/report/page_text.h"
#include "tests/compare/report/sample.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

using nlohmann::json;

TEST(ReportText, NumbersReadAsPeopleWriteThem) {
  using report::number;
  EXPECT_EQ(number(0), "0");
  EXPECT_EQ(number(0.5), "0.5");
  EXPECT_EQ(number(100), "100");
  EXPECT_EQ(number(12.345), "12.3");
  EXPECT_EQ(number(0.00123456), "0.00123");
  EXPECT_EQ(number(1234.4), "1234");
  EXPECT_EQ(number(742657), "742\u202f700");
  EXPECT_EQ(number(-1234567), "-1\u202f235\u202f000");
  EXPECT_EQ(number(1.2e-7), "1.2×10⁻⁷");
  EXPECT_EQ(number(-3e12), "-3×10¹²");
  EXPECT_EQ(number(not_a_number), "not finite");
  EXPECT_EQ(report::quantity(0.0042, "fraction"), "0.42\u202f%");
  EXPECT_EQ(report::quantity(infinity, "fraction"), "not finite");
  EXPECT_EQ(report::cell(not_a_number, "count"), "not finite");
  EXPECT_EQ(report::cell(2.2e-17, "fraction"), "0") << "the rounding of a sum of shares";
  EXPECT_EQ(report::quantity(-2.2e-17, ""), "0");
  EXPECT_EQ(report::cell(1e-15, "fraction"), "1×10⁻¹³");
  EXPECT_EQ(report::cell(2.2e-17, "depth"), "2.2×10⁻¹⁷") << "a depth may be as small";
  EXPECT_EQ(report::setting_label("map.extent_m"), "extent");
  EXPECT_EQ(report::setting_label("filter.kind"), "filter");
  EXPECT_EQ(report::setting_label("bias.constant"), "bias constant");
}

TEST(ReportText, Base64AsInRfc4648) {
  const std::pair<const char*, const char*> cases[] = {{"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"},
                                                       {"\xff\xfe\xfd", "//79"}};
  for (const auto& [bytes, text] : cases) EXPECT_EQ(report::base64(bytes), text);
}

TEST(Report, TellsEveryLaw) {
  Results results = sample_results();
  LawResult held = sample_law();
  held.name = "6: the same texels";
  held.held = true;
  LawResult unasked = sample_law();
  unasked.samples.clear();
  unasked.worst = -1;
  results.laws = {sample_law(), held, unasked};
  const std::string page = render_report(results, sample_picture);
  for (const char* text :
       {"Broken: 2 of 3 laws", "1: acne-free bias", "6: the same texels", "✓ holds", "✗ broken",
        "acne_free_bias_m &lt;= 0.5 * texel_m (within 5%)", "&lt;= 0.1", "Off by 0.2",
        "noonmark render x.toml --point 3", "No point is left", "✗ no point", "id=\"chart-laws\"", "\"measured\":0.19"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
}

// The chart of cost against error alone compares them, because it says which can be compared. What is of one point each is there.
TEST(Report, DoesNotComparePointsOfDifferentParts) {
  Results results = sample_results();
  for (PointRecord& point : results.points) point.part = point.id < 3 ? "one" : "two";
  results.laws = {sample_law()};
  const std::string page = render_report(results, sample_picture);
  for (const char* text : {"What to set", "id=\"sweep\"", "bias curve.</p>"})
    EXPECT_EQ(page.find(text), std::string::npos) << text;
  for (const char* text : {"id=\"answer\"", "id=\"points\"", "href=\"#points\"", "<th class=\"text\">Part</th>",
                           ">two</td>", "2 parts", "id=\"cost\"", "href=\"#bias\""})
    EXPECT_NE(page.find(text), std::string::npos) << text;
}

TEST(Report, EscapesWhateverTextTheResultsHold) {
  const std::string evil = "</script><script>alert('1')</script><img src=x onerror=\"alert(2)\">&amp;{{data}}\xff\xfe";
  Results results = sample_results();
  const std::string plain = render_report(results, sample_picture);
  RunInfo& info = results.info;
  for (std::string* text : {&info.title, &info.experiment, &info.command, &info.commit, &info.version, &info.started,
                            &info.host_cpu, &info.gl_vendor, &info.gl_renderer, &info.gl_version, &info.gl_timer,
                            &info.embree_version, &info.embree_isa, &info.scene_name})
    *text = evil;
  info.libraries[evil] = evil;
  info.swept.push_back(evil);
  info.plot.push_back(evil);
  info.scene_notes.push_back(evil);
  results.bounds.push_back({evil, 1.0, {}, {{evil, {evil}}}, evil, false, not_a_number, 3, 1, evil});
  LawResult law = sample_law();
  for (std::string* text :
       {&law.part, &law.name, &law.says, &law.measured, &law.predicted, &law.tolerance, &law.join, &law.reproduce})
    *text = evil;
  results.laws.push_back(law);
  for (PointRecord& point : results.points) {
    point.settings[evil] = evil + std::to_string(point.id % 3);
    point.metrics[evil] = 1;
    point.curve->parameter = point.curve->made = evil;
    point.worst.cause = evil;
    point.causes = {{"elsewhere", evil, evil, {1, 2, 3}, evil}};
    point.metrics["elsewhere"] = 0.1;
    point.pictures.push_back({evil, "images/" + evil + ".png", evil});
    point.pictures.push_back({evil, "images/" + evil, evil});
  }
  const std::string page =
      render_report(results, [&](const std::string&) -> std::string { throw std::runtime_error(evil); });
  const auto count = [](const std::string& text, const std::string& what) {
    size_t n = 0;
    for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count(page, "<script"), count(plain, "<script"));
  EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
  EXPECT_EQ(count(page, "<img src=x"), 0u);
  EXPECT_EQ(count(page, "onerror=\""), 0u);
  EXPECT_EQ(count(page, "{{data}}"), count(page, "&amp;amp;{{data}}") + count(page, "\\u0026amp;{{data}}"));
  EXPECT_NO_THROW(embedded_data(page));
  // The whole page is UTF-8. Otherwise the strict writer would throw.
  EXPECT_NO_THROW(json(page).dump());
}

TEST(Report, FetchesNothing) {
  const std::string page = render_report(sample_results(), sample_picture);
  EXPECT_NE(page.find("default-src 'none'; img-src data:;"), std::string::npos);
  for (const char* scheme : {"http://", "https://", "ftp://", "ws://", "wss://"})
    for (size_t at = page.find(scheme); at != std::string::npos; at = page.find(scheme, at + 1))
      EXPECT_EQ(page.compare(at, 18, "http://www.w3.org/"), 0) << page.substr(at, 60);  // namespaces are not fetched
  const std::string body = without_scripts(page);
  for (const std::string attribute : {"src=\"", "href=\""})
    for (size_t at = body.find(attribute); at != std::string::npos; at = body.find(attribute, at + 1)) {
      const std::string value = body.substr(at + attribute.size(), 5);
      EXPECT_TRUE(value.starts_with("#") || value == "data:" || value.starts_with("data:")) << value;
    }
  for (const char* call : {"sourceMappingURL", "@import", "<link rel=\"stylesheet", "<iframe"})
    EXPECT_EQ(page.find(call), std::string::npos) << call;
}

TEST(Report, NumbersAreThereWithoutJavaScript) {
  Results results = sample_results();
  results.info.scene_notes = {"street: 2 animations at rest"};
  const std::string body = without_scripts(render_report(results, sample_picture));
  for (const PointRecord& point : results.points) {
    const size_t row = body.find(fmt::format("<tr id=\"p{}\"", point.id));
    ASSERT_NE(row, std::string::npos);
    const std::string cells = body.substr(row, body.find("</tr>", row) - row);
    for (const char* metric : {"error", "acne", "peter_panning", "shadow_ms"}) {
      const double value = point.metrics.at(metric);
      EXPECT_NE(cells.find(">" + report::cell(value, find_metric(metric).unit) + "</td>"), std::string::npos) << metric;
    }
    if (point.curve->window_min_depth) {
      EXPECT_NE(body.find(fmt::format("<td class=\"first\">{}</td><td>{}</td><td>{}</td>",
                                      report::number(*point.curve->window_min_depth * point.curve->m_per_depth),
                                      report::number(*point.curve->window_min_depth * point.curve->texels_per_depth),
                                      report::number(*point.curve->window_min_depth))),
                std::string::npos);
    }
  }
  for (const Metric& metric : metric_rows())
    EXPECT_NE(body.find(report::Markup(metric.help).html()), std::string::npos);
  for (const std::string text : {"noonmark run experiments/cube-room.toml", "896dc68", "llvmpipe",
                                 "CPU time of the process", "AVX2", "street: 2 animations at rest", "all 2 bounds"})
    EXPECT_NE(body.find(text), std::string::npos) << text;
}

TEST(Report, SameResultsSameBytes) {
  EXPECT_EQ(render_report(sample_results(), sample_picture), render_report(sample_results(), sample_picture));
}

// A bias that moves the lookup has no curve. First some points have no curve, then all.
TEST(Report, SaysWhyPointsHaveNoCurve) {
  Results results = sample_results();
  const char* const why = "bias.normal_offset moves the lookup";
  EXPECT_EQ(render_report(results, sample_picture).find(why), std::string::npos);
  results.points[6].curve.reset();
  results.points[6].settings["bias.constant"] = "0";
  results.points[6].settings["bias.normal_offset"] = "1";
  results.points[6].metrics["displacement"] = 0.002;
  const std::string some = render_report(results, sample_picture);
  EXPECT_NE(some.find(why), std::string::npos);
  EXPECT_NE(some.find("Displacement"), std::string::npos);
  EXPECT_EQ(some.find("A usable bias exists at every point:"), std::string::npos);
  for (PointRecord& point : results.points) {
    point.curve.reset();
    point.settings["bias.constant"] = "0";
    point.settings["bias.normal_offset"] = "1";
  }
  const std::string none = render_report(results, sample_picture);
  EXPECT_NE(none.find(why), std::string::npos);
  EXPECT_NE(none.find("No curve over a bias or a reduction was measured"), std::string::npos);
}

TEST(Report, EmbeddedDataIsTheResults) {
  Results results = sample_results();
  results.points[3].metrics["acne"] = not_a_number;
  results.points[4].metrics["error"] = infinity;
  results.points[5].metrics["error"] = -infinity;
  results.points[6].curve.reset();
  const json data = embedded_data(render_report(results, sample_picture));
  ASSERT_EQ(data["points"].size(), results.points.size());
  for (size_t i = 0; i < results.points.size(); ++i) {
    const PointRecord& point = results.points[i];
    const json& read = data["points"][i];
    EXPECT_EQ(read["id"], point.id);
    ASSERT_EQ(read["metrics"].size(), point.metrics.size());
    for (const auto& [name, value] : point.metrics) {
      const json expected = std::isfinite(value) ? json(value)
                                                 : json(std::isnan(value) ? "NaN"
                                                        : value > 0       ? "Infinity"
                                                                          : "-Infinity");
      EXPECT_EQ(read["metrics"][name], expected) << name;
    }
    for (const std::string& name : results.info.swept) EXPECT_EQ(read["settings"][name], point.settings.at(name));
    ASSERT_EQ(read.contains("curve"), point.curve.has_value());
    if (!point.curve) continue;
    const json& curve = read["curve"];
    EXPECT_EQ(curve.contains("window_min_depth"), point.curve->window_min_depth.has_value());
    if (point.curve->window_min_depth) {
      EXPECT_EQ(curve["window_min_depth"], *point.curve->window_min_depth);
      EXPECT_EQ(curve["window_max_depth"], *point.curve->window_max_depth);
    }
  }
}

// Each of the four limits alone. If one is exceeded, the report must not call anything held.
TEST(Report, AnUnsoundPointIsSaidAndNothingHoldsBesideIt) {
  for (const SoundLimit& limit : sound_limits) {
    Results results = sample_results();
    for (BoundResult& bound : results.bounds) bound.held = true;
    for (PointRecord& point : results.points)
      for (const SoundLimit& any : sound_limits) point.metrics[any.metric] = 0;
    const std::string sound = render_report(results, sample_picture);
    EXPECT_EQ(sound.find("Unsound"), std::string::npos);
    for (const double value : {limit.most + 0.5, not_a_number}) {
      results.points[1].metrics[limit.metric] = value;
      const std::string page = render_report(results, sample_picture);
      EXPECT_NE(page.find("Unsound"), std::string::npos) << limit.metric;
      EXPECT_NE(page.find(std::string("contradicts itself (") + limit.metric), std::string::npos) << limit.metric;
      EXPECT_EQ(page.find("pill held"), std::string::npos) << limit.metric;
      EXPECT_NE(to_summary(results).find("**Unsound"), std::string::npos);
    }
  }
}

TEST(Report, NotFiniteIsSaid) {
  Results results = sample_results();
  results.points[3].metrics["acne"] = not_a_number;
  results.bounds.push_back(
      {"acne", 0.5, {}, {}, "worst", false, not_a_number, 3, 32, "noonmark render x --set map.resolution=256"});
  const std::string body = without_scripts(render_report(results, sample_picture));
  const size_t row = body.find("<tr id=\"p3\"");
  EXPECT_NE(body.substr(row, body.find("</tr>", row) - row).find("not finite"), std::string::npos);
  EXPECT_NE(body.find("1 point has a metric that is <b>not finite</b>"), std::string::npos);
  EXPECT_NE(body.find("Broken: 1 of 3 bounds"), std::string::npos);
  EXPECT_NE(body.find("noonmark render x --set map.resolution=256"), std::string::npos);
}

// Found by fuzzing: std::stod refuses numbers below the smallest normal number.
TEST(Report, TheLeastNumbersAreDrawn) {
  Results results = sample_results();
  for (PointRecord& point : results.points) {
    point.metrics.at("error") = std::numeric_limits<double>::denorm_min();
    for (double& error : point.curve.value().error) error = 1e-310;
  }
  EXPECT_TRUE(embedded_data(render_report(results, sample_picture)).is_object());
}

TEST(Report, PicturesAreInlinedAndMissingOnesSaid) {
  const std::string page = render_report(sample_results(), sample_picture);
  const std::string bytes = sample_picture("images/p0018-map.png");
  EXPECT_NE(page.find("src=\"data:image/png;base64," + report::base64(bytes) + "\""), std::string::npos);
  EXPECT_NE(page.find("The picture images/p0026-truth.png is not shown: there is no images/p0026-truth.png."),
            std::string::npos);
}

// A section is an SVG, and it stands in the page as a picture: no script of it could run.
TEST(Report, SectionsAreInlinedWithTheirPixelsAndLostOnesSaid) {
  Results results = sample_results();
  results.points[18].images = {{report::section_path(18, {56, 78}), ""},
                               {report::section_path(18, {1, 2}), ""},
                               {"images/p0018-ladder.exr", ""}};
  const std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"/>";
  const std::string page = render_report(results, [&](const std::string& path) {
    if (path == "images/p0018-section-1-2.svg") throw Error(ErrorKind::file, "it is lost");
    return path == "images/p0018-section-56-78.svg" ? svg : sample_picture(path);
  });
  EXPECT_NE(page.find("<figure data-x=\"56\" data-y=\"78\"><img alt=\"Section through pixel (56, 78)\" "
                      "src=\"data:image/svg+xml;base64," +
                      report::base64(svg)),
            std::string::npos);
  EXPECT_NE(page.find("The section images/p0018-section-1-2.svg is not shown: it is lost."), std::string::npos);
  EXPECT_EQ(page.find("ladder.exr"), std::string::npos);
  EXPECT_EQ(render_report(sample_results(), sample_picture).find("Sections through"), std::string::npos);
}

TEST(Report, SmallAndEmptySweepsStillMakeAPage) {
  Results results = sample_results();
  results.info.swept.clear();
  results.points.resize(1);
  results.points[0].pictures.clear();
  const std::string one = render_report(results, sample_picture);
  EXPECT_EQ(one.find("not swept."), std::string::npos) << "a section that has nothing to show is left out";
  for (const char* left_out : {"phase", "pictures", "motion"}) {
    EXPECT_EQ(one.find(fmt::format("<section id=\"{}\"", left_out)), std::string::npos) << left_out;
    EXPECT_EQ(one.find(fmt::format("<a href=\"#{}\"", left_out)), std::string::npos) << left_out;
  }
  EXPECT_NE(one.find("<section id=\"bias\""), std::string::npos);
  EXPECT_NE(one.find("Incomplete: 1 of 32 points"), std::string::npos);
  const std::string none = render_report(Results{}, sample_picture);
  EXPECT_NE(none.find("No point was measured."), std::string::npos);
  EXPECT_EQ(none.find("<section id=\"answer\""), std::string::npos);
  EXPECT_NO_THROW(embedded_data(none));
}

TEST(Report, ALargeSweepStaysSensibleInSize) {
  Results results = sample_results();
  const std::vector<PointRecord> points = results.points;
  while (results.points.size() < 640)
    for (const PointRecord& point : points)
      results.points.push_back(point), results.points.back().id = static_cast<int64_t>(results.points.size() - 1);
  for (PointRecord& point : results.points) point.pictures.clear();
  EXPECT_LT(render_report(results, sample_picture).size(), 12u << 20);  // a browser opens this without delay
}

// The cause of a rung on top of R5 (add_rung) has its colour, its bar, its column and its meaning.
TEST(Report, ShowsTheCauseOfARung) {
  Results results = sample_results();
  const std::string without = render_report(results, sample_picture);
  for (PointRecord& point : results.points) {
    point.causes = {{"seep", "Leak <of light>", "Light that leaks.", {1, 2, 255}, "R6"}};
    point.metrics["seep"] = 0.5 + 0.001 * static_cast<double>(point.id);
  }
  const std::string page = render_report(results, sample_picture);
  for (const char* text :
       {"--c-seep:#0102ff", ".c-seep{", "Leak &lt;of light&gt;", "Light that leaks.", "<code>seep</code>",
        "mean |R6 − R1|", "R6, a picture on top of the ladder", "title=\"Light that leaks.\"", "\"name\":\"seep\""}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
    EXPECT_EQ(without.find(text), std::string::npos) << text;
  }
  EXPECT_NE(without.find("mean |R5 − R1|"), std::string::npos);
  std::vector<const PointRecord*> points;
  for (const PointRecord& point : results.points) points.push_back(&point);
  EXPECT_EQ(cause_shares(points).at(0).name, "seep");
}

TEST(CauseColors, AreDistinctAndNamed) {
  std::set<std::tuple<int, int, int>> seen;
  for (const CauseColor& c : cause_colors) {
    if (c.name == "coverage") continue;  // has the same colour as its light part
    EXPECT_TRUE(seen.insert({c.r, c.g, c.b}).second) << c.name;
    EXPECT_NO_THROW(find_metric(c.name));
  }
  for (const auto& [r, g, b] : spare_colors) EXPECT_TRUE(seen.insert({r, g, b}).second) << "a spare colour";
  EXPECT_EQ(find_color("acne")->g, 94);
  EXPECT_EQ(find_color("nothing"), nullptr);
}

}  // namespace
}  // namespace noonmark
