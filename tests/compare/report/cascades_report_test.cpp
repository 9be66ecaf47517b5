// The report's section of cascades, and the sentence about the worst of them.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/report/cascade_rows.h"
#include "compare/report/cascades_section.h"
#include "compare/results/causes.h"

namespace noonmark::report {
namespace {

// Two cascades: 300 receivers with an error of 1%, of which acne is a quarter, and 100 with one of 5%, all of it acne.
PointRecord two_cascades(int64_t id = 0) {
  PointRecord point;
  point.id = id;
  point.settings = {
      {"bias.constant", "1.5"}, {"bias.unit", "texel"}, {"map.resolution", "512"}, {"cascades.count", "2"}};
  point.metrics = {{"error", 0.02}};
  point.curve.emplace();
  point.curve->parameter = "bias.constant";
  for (int k = 0; k < 2; ++k) {
    PointRecord::Cascade cascade{k == 0 ? 0.2 : 10.0, k == 0 ? 10.0 : 80.0, {}, k == 0 ? 1.25 : 2.25};
    for (const char* metric : cascade_metrics) cascade.metrics[metric] = 0;
    for (const CauseRow& row : cause_rows) cascade.metrics[std::string(row.name)] = 0;
    cascade.metrics["counted"] = k == 0 ? 300 : 100;
    cascade.metrics["error"] = k == 0 ? 0.01 : 0.05;
    cascade.metrics["acne"] = k == 0 ? 0.0025 : 0.05;
    cascade.metrics["aliasing_dark"] = k == 0 ? 0.004 : 0;
    cascade.metrics["aliasing_light"] = k == 0 ? 0.0035 : 0;
    cascade.metrics["texel_m"] = k == 0 ? 0.02 : 0.16;
    cascade.metrics["map_range_m"] = 50;
    point.cascades.push_back(cascade);
  }
  return point;
}

Results results_of(std::vector<PointRecord> points) {
  Results results;
  results.info.swept = {"map.resolution"};
  results.points = std::move(points);
  return results;
}

size_t count_of(const std::string& text, const std::string& what) {
  size_t count = 0;
  for (size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++count;
  return count;
}

// The texts of the cells of the n-th table's row, with '|' between them.
std::string row_text(const std::string& html, size_t row) {
  size_t at = 0;
  for (size_t n = 0; n <= row; ++n) at = html.find("<tr", at + 1);
  std::string text;
  bool inside = false;
  for (const char c : html.substr(at, html.find("</tr>", at) - at)) {
    if (c == '<') inside = true;
    if (!inside) text += c;
    if (c == '>') {
      inside = false;
      if (!text.empty() && text.back() != '|') text += '|';
    }
  }
  return text;
}

TEST(CascadesSection, IsLeftOutWithoutCascades) {
  PointRecord point;
  point.metrics = {{"error", 0.1}};
  EXPECT_EQ(cascades_section(results_of({point})).html(), "");
}

TEST(CascadesSection, HasARowForEachCascade) {
  const std::string html = cascades_section(results_of({two_cascades()})).html();
  EXPECT_EQ(count_of(html, "<table"), 1u);
  EXPECT_EQ(row_text(html, 1), "1|0.2|10|0.02|300|1|37.5|Aliasing|-|1.25|0.025|1.5|0.03|") << html;
  EXPECT_EQ(row_text(html, 2), "2|10|80|0.16|100|5|62.5|Acne (too dark)|-|2.25|0.36|1.5|0.24|");
  EXPECT_NE(
      html.find(
          "Cascade 2 (10 to 80 m, texel 0.16 m) holds 62% of the error; its largest cause: Acne (too dark), 100%. "
          "Its bias.constant is 1.5 texels = 0.24 m where 2.25 texels = 0.36 m is needed against acne."),
      std::string::npos)
      << html;
}

TEST(CascadesSection, ABiasInMetresHasOneColumn) {
  PointRecord point = two_cascades();
  point.settings["bias.unit"] = "m";
  point.settings["bias.constant"] = "2.25";  // enough for both: the sentence asks for nothing
  const std::string html = cascades_section(results_of({point})).html();
  EXPECT_EQ(row_text(html, 1), "1|0.2|10|0.02|300|1|37.5|Aliasing|-|1.25|2.25|") << html;
  EXPECT_EQ(html.find("is needed against acne"), std::string::npos);
}

// With cascades.select = map or sphere a receiver can be looked up in another cascade than that of its slice. So the table shows
// the depths of the receivers, not those of the slice.
TEST(CascadesSection, ShowsTheReceiversWhereTheDepthDoesNotChoose) {
  PointRecord point = two_cascades();
  point.settings["cascades.select"] = "depth";
  EXPECT_EQ(row_text(cascades_section(results_of({point})).html(), 1).substr(0, 9), "1|0.2|10|");
  point.settings["cascades.select"] = "map";
  point.cascades[0].metrics["nearest_receiver_m"] = 3;
  point.cascades[0].metrics["farthest_receiver_m"] = 17;
  point.cascades[1].metrics["nearest_receiver_m"] = 15;
  point.cascades[1].metrics["farthest_receiver_m"] = 88;
  const std::string html = cascades_section(results_of({point})).html();
  EXPECT_NE(row_text(html, 0).find("Receivers from"), std::string::npos) << row_text(html, 0);
  EXPECT_EQ(row_text(html, 1).substr(0, 7), "1|3|17|");
  EXPECT_NE(html.find("Cascade 2 (receivers from 15 to 88 m, texel 0.16 m) holds 62% of the error"), std::string::npos);
  point.cascades[0].metrics["counted"] = 0;
  point.cascades[0].metrics["nearest_receiver_m"] = point.cascades[0].metrics["farthest_receiver_m"] = NAN;
  EXPECT_EQ(row_text(cascades_section(results_of({point})).html(), 1).substr(0, 6), "1|-|-|");
  EXPECT_EQ(cascade_depths_text(cascade_rows_of(point)[0]), "-");
}

TEST(CascadesSection, SaysWhereThereIsNothing) {
  PointRecord point = two_cascades();
  point.cascades[0].metrics["counted"] = 0;
  point.cascades[1].bias_needed = std::nullopt;
  EXPECT_EQ(row_text(cascades_section(results_of({point})).html(), 1),
            "1|0.2|10|0.02|0|-|0|Aliasing|-|1.25|0.025|1.5|0.03|");
  EXPECT_EQ(row_text(cascades_section(results_of({point})).html(), 2),
            "2|10|80|0.16|100|5|100|Acne (too dark)|-|-|-|1.5|0.24|");
  point.settings["bias.constant"] = "0";
  point.cascades[1].bias_needed = 2;
  EXPECT_NE(worst_cascade(point).find("Its bias.constant is 0 where 2 texels = 0.32 m is needed"), std::string::npos)
      << worst_cascade(point);
  point.curve = std::nullopt;
  EXPECT_EQ(row_text(cascades_section(results_of({point})).html(), 2), "2|10|80|0.16|100|5|100|Acne (too dark)|-|-|-|");
  for (PointRecord::Cascade& cascade : point.cascades)
    for (auto& [name, value] : cascade.metrics)
      if (name != "counted" && name != "texel_m") value = 0;
  EXPECT_EQ(worst_cascade(point), "") << "nothing is wrong";
  EXPECT_EQ(row_text(cascades_section(results_of({point})).html(), 2), "2|10|80|0.16|100|0|-|-|-|-|-|");
}

// Of several choices those with the largest error, in the order of the sweep; of a motion's frames the worst one.
TEST(CascadesSection, ShowsTheChoicesWithTheLargestError) {
  std::vector<PointRecord> points;
  for (int64_t id = 0; id < 14; ++id) {
    PointRecord point = two_cascades(id);
    point.settings["map.resolution"] = std::to_string(100 + id);
    point.metrics["error"] = id == 3 || id == 5 ? 0.001 : 0.02 + 0.001 * static_cast<double>(id);
    points.push_back(point);
  }
  const std::string html = cascades_section(results_of(points)).html();
  EXPECT_EQ(count_of(html, "<table"), most_cascade_points);
  EXPECT_NE(html.find("The 12 choices with the largest error of 14 that have cascades."), std::string::npos);
  for (int id = 0; id < 14; ++id)
    EXPECT_EQ(html.find("resolution " + std::to_string(100 + id)) != html.npos, id != 3 && id != 5) << id;
  EXPECT_LT(html.find("resolution 100"), html.find("resolution 113"));

  Results frames = results_of({two_cascades(0), two_cascades(1)});
  frames.info.swept = {"motion.frame"};
  frames.points[0].settings["motion.frame"] = "0";
  frames.points[1].settings["motion.frame"] = "1";
  frames.points[1].metrics["error"] = 0.5;
  const std::string of_frames = cascades_section(frames).html();
  EXPECT_EQ(count_of(of_frames, "<table"), 1u);
  EXPECT_NE(of_frames.find("frame 1"), std::string::npos) << of_frames;
}

}  // namespace
}  // namespace noonmark::report
