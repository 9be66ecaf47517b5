// The report's first words: of which point, bias and bound they speak.
#include <gtest/gtest.h>

#include <string>

#include "compare/judge/curve_reading.h"
#include "compare/report/report.h"
#include "tests/compare/report/page_text.h"
#include "tests/compare/report/sample.h"

namespace noonmark {
namespace {

// The answer names its bias, and not the bias with which its point was rendered too.
TEST(Answer, OneBiasIsSaidOfAnAnswer) {
  Results results = sample_results();
  results.info.swept.push_back("bias.constant");
  for (PointRecord& point : results.points) point.settings["bias.constant"] = point.id % 2 ? "0" : "0.005";
  const std::string body = without_scripts(render_report(results, sample_picture));
  const auto between = [&](const std::string& from, const std::string& to) {
    const size_t at = body.find(from);
    return at == std::string::npos ? "" : body.substr(at, body.find(to, at) - at);
  };
  const std::string said = between("<p class=\"said\">", "</p>"),
                    box = between("<div class=\"recommend ", "</div>\n<p");
  EXPECT_NE(said.find(" with a bias of "), std::string::npos) << said;
  EXPECT_EQ(said.find("bias constant"), std::string::npos) << said;
  EXPECT_NE(box.find("<dt>bias.constant</dt>"), std::string::npos) << box;
  EXPECT_EQ(box.find("<dt>bias.constant</dt>"), box.rfind("<dt>bias.constant</dt>")) << "the swept one is there too";
  EXPECT_EQ(body.find("Largest causes there, with the bias as rendered"), std::string::npos);
  EXPECT_NE(body.find("Largest causes there, with this bias"), std::string::npos);
  EXPECT_NE(body.find("Held: all 2 bounds at these 32 points"), std::string::npos) << "no one bias was set";
  for (PointRecord& point : results.points) point.settings["bias.constant"] = "0.005";
  const std::string one = without_scripts(render_report(results, sample_picture));
  EXPECT_NE(one.find("(0.005 of the depth) holds all 2 bounds"), std::string::npos);
  EXPECT_NE(one.find("<p class=\"said\">Cheaper: <a "), std::string::npos);
}

TEST(Answer, WhatIsBrokenComesFirstWithItsBias) {
  Results results = sample_results();
  results.bounds.push_back(
      {.metric = "acne", .max = 0.005, .join = "worst", .found = 0.0083, .point = 18, .points = 32});
  results.points[18].worst_of = {{"acne", 56, 78, 0.5}};
  const std::string body = without_scripts(render_report(results, sample_picture));
  const size_t said = body.find(
      "<p class=\"said\">Acne is 0.83\u202f% where at most 0.5\u202f% is allowed, at <a "
      "href=\"#p18\" data-failure=\"acne\">");
  ASSERT_NE(said, std::string::npos) << body.substr(body.find("<p class=\"said\">"), 300);
  EXPECT_LT(body.find(" as set.", said), body.find(" Of these 32 points the cheapest ", said));
  EXPECT_NE(body.find("worst pixel by acne: x = 56, y = 78"), std::string::npos);
  EXPECT_EQ(body.find("recommend held"), std::string::npos) << "green beside the broken bound";
}

// A filtered map has no bias curve: the page speaks of its reduction, wherever it would speak of a bias.
TEST(Answer, AFilteredMapIsAnsweredWithItsReduction) {
  const std::string body = without_scripts(render_report(filtered_sample_results(), sample_picture));
  const auto says = [&](const std::string& words) { return body.find(words) != std::string::npos; };
  for (const char* fact :
       {"lookup.reduction of 0.19", "<dt>lookup.reduction</dt>", "<section id=\"reduction\"",
        "Of 3 choices 2 have a usable", "No reduction is usable at 1 of 3 points",
        "The reduction as set is too small at 1 of 3 points", "as set is too large at 1 of 3 points"})
    EXPECT_TRUE(says(fact)) << fact;
  EXPECT_TRUE(says(why_no_usable_reduction(filtered_sample_results().points[0])));
  for (const char* wrong :
       {"bias curve", "No bias", "usable bias", "The bias as", "with this bias", "the bias as", "Bias</th>"})
    EXPECT_FALSE(says(wrong)) << wrong << ": " << body.substr(body.find(wrong) - 100, 300);
}

// Where rounding decides the truth of many receivers, the page neither praises a bias nor denies that there is one.
TEST(Answer, NothingIsSaidOfABiasWhereMuchIsAmbiguous) {
  for (Results results : {sample_results(), filtered_sample_results()}) {
    for (PointRecord& point : results.points) {
      point.metrics["ambiguous"] = 0.142;
      point.metrics["facing"] = point.metrics["counted"] = 1e6;
    }
    const std::string page = render_report(results, sample_picture), body = without_scripts(page);
    const auto says = [&](const std::string& words) { return body.find(words) != std::string::npos; };
    EXPECT_TRUE(says("is not known, because too much is ambiguous"));
    EXPECT_TRUE(says(" is known to be good enough"));
    for (const char* wrong :
         {"A usable", "The method fails", "No reduction is usable", "lies within the usable window",
          "is good enough:", "Good enough", "no bias is good enough", "makes it good enough", "Least error by"})
      EXPECT_FALSE(says(wrong)) << wrong << ": " << body.substr(body.find(wrong) - 200, 400);
    EXPECT_NE(page.find("\"no_window\":"), std::string::npos) << "what the charts say";
    EXPECT_EQ(page.find("\"window_min_depth\":"), std::string::npos);
  }
}

}  // namespace
}  // namespace noonmark
