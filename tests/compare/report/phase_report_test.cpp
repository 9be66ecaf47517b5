// The phase diagrams in the report of a sweep.
#include <gtest/gtest.h>

#include "compare/report/report.h"
#include "tests/compare/report/page_text.h"
#include "tests/compare/report/sample.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

using nlohmann::json;

// Without JavaScript too: words, tables, links to the points, and why a part has no diagram.
TEST(Report, OpensWithThePhaseDiagrams) {
  Results results = sample_results();
  EXPECT_EQ(render_report(results, sample_picture).find("id=\"phase\""), std::string::npos);
  PhaseDiagram refused;
  refused.part = "lamp";
  refused.refused = "a <lamp> has none";
  results.phases = {sample_phase(), refused, sample_phase()};
  const std::string page = render_report(results, sample_picture), text = without_scripts(page);
  EXPECT_LT(text.find("<section id=\"phase\""), text.find("<section id=\"answer\""));
  EXPECT_LT(text.find("class=\"verdict\""), text.find("<section id=\"phase\""));
  EXPECT_LT(text.find("href=\"#phase\""), text.find("href=\"#answer\""));
  for (const char* words : {
           "At 256 texels, each 10 mm wide, a constant bias from 4 mm to 16 mm keeps acne and Peter Panning each "
           "within",
           "3 of the 4 points of part room &amp; &lt;hall&gt; are on the diagram, as rings; with the bias as set, 2 of "
           "them are",
           "1 with filter.kind = box",
           "<a href=\"#p2\">2</a>",
           "too large",
           "There is no phase diagram: a &lt;lamp&gt; has none.",
           "1000 receivers of a picture of 320 × 180 pixels",
           "id=\"chart-phase\"",
           "id=\"chart-phase-2\"",
       })
    EXPECT_NE(text.find(words), std::string::npos) << words;
  const json data = embedded_data(page);
  ASSERT_EQ(data["phases"].size(), 2u) << "only diagrams with rows";
  EXPECT_EQ(data["phases"][0]["points"].size(), 3u);
  EXPECT_EQ(data["phases"][0]["points"][2], json({{"id", 2}, {"texel_m", 0.02}, {"bias_m", 0.1}}));
}

}  // namespace
}  // namespace noonmark
