// The page of `noonmark settings --html`: every row of the program stands in it, once. The names by which people know a technique
// find the setting.
#include "app/verbs/settings_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "app/definition/experiment_keys.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "frames/checks.h"
#include "frames/frame_keys.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

size_t count_of(std::string_view text, std::string_view words) {
  size_t count = 0;
  for (size_t at = text.find(words); at != std::string_view::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

std::string section_of(const std::string& page, const std::string& id) {
  const size_t begin = page.find("<section id=\"" + id + "\">");
  if (begin == std::string::npos) return "";
  return page.substr(begin, page.find("</section>", begin) - begin);
}

TEST(SettingsPage, HasEveryRowOnce) {
  const std::string page = settings_page("0");
  const auto once = [&](const std::string& section, std::string_view name) {
    EXPECT_EQ(count_of(section_of(page, section), " scope=\"row\"><code>" + std::string(name) + "</code></th>"), 1u)
        << section << ": " << name;
  };
  for (const Setting& row : settings_table()) once("settings", row.name);
  for (const Metric& row : metrics_table()) once("metrics", row.name);
  for (const CurveQuantity& row : curve_quantities()) once("quantities", row.name);
  for (const FrameKey& row : frame_keys()) once("frame", row.object.empty() ? std::string(row.name) : row.full_name());
  for (const FrameCheck& row : frame_checks()) once("checks", row.name);
  size_t keys = 0;
  for (const char* table :
       {"root", "plot", "answer", "curve", "phase", "frame", "bound", "law", "range", "lights"})
    keys += experiment_keys(table).size();
  EXPECT_EQ(count_of(section_of(page, "experiment"), " scope=\"row\">"), keys);
}

std::string settings_that_say(std::string words) {
  std::string found;
  for (const Setting& row : settings_table()) {
    std::string help = row.help;
    std::transform(help.begin(), help.end(), help.begin(), [](unsigned char c) { return std::tolower(c); });
    if (help.find(words) != std::string::npos) found += std::string(row.name) + " ";
  }
  return found;
}

TEST(SettingsPage, CommonNamesFindTheirSetting) {
  EXPECT_EQ(settings_that_say("pcf").substr(0, 12), "filter.kind ");
  EXPECT_NE(settings_that_say("shadow acne").find("bias.constant "), std::string::npos);
  EXPECT_NE(settings_that_say("omnidirectional").find("light.kind "), std::string::npos);
  EXPECT_NE(settings_that_say("csm").find("cascades.count "), std::string::npos);
  for (const char* name : {"variance shadow map", "exponential shadow map", "moment shadow map"})
    EXPECT_NE(settings_that_say(name).find("lookup.kind "), std::string::npos) << name;
}

// In a narrow column a browser breaks "as_built" inside the word.
TEST(SettingsPage, KeepsADefaultOnOneLine) {
  const std::string page = settings_page("1.2.3");
  EXPECT_NE(page.find("<td style=\"white-space: nowrap\"><code>as_built</code></td>"), std::string::npos);
}

}  // namespace
}  // namespace noonmark
