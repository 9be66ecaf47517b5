// Every address in a page is an anchor, a web address or a file beside it, whatever the names in it are.
#include "compare/report/links.h"

#include <gtest/gtest.h>

#include "compare/report/atlas.h"
#include "compare/report/index_page.h"
#include "compare/report/report.h"

namespace noonmark {
namespace {

const std::string code = "javascript:alert(1)";

// The values of all attributes of this name.
std::vector<std::string> values_of(const std::string& page, const std::string& attribute) {
  std::vector<std::string> values;
  const std::string begin = " " + attribute + "=\"";
  for (size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at + 1)) {
    const size_t first = at + begin.size();
    values.push_back(page.substr(first, page.find('"', first) - first));
  }
  return values;
}

// Whether a browser reads it as a path: what stands before the first ':' would be a scheme.
bool is_path(const std::string& address) {
  return address.find(':') == std::string::npos && !address.starts_with("//");
}

TEST(Links, AreOfTheWebOrText) {
  using report::web_link;
  EXPECT_EQ(web_link("https://a.org/b?c=d&e", "b<").html(), "<a href=\"https://a.org/b?c=d&amp;e\">b&lt;</a>");
  EXPECT_EQ(web_link("http://a.org", "a").html(), "<a href=\"http://a.org\">a</a>");
  EXPECT_EQ(web_link("HTTPS://a.org", "a").html(), "<a href=\"HTTPS://a.org\">a</a>");
  for (const std::string& address :
       std::vector<std::string>{code, "JavaScript:alert(1)", " javascript:alert(1)", "java\nscript:alert(1)",
                                "data:text/html,<script>", "file:///etc/passwd", "vbscript:x", "https://a.org/b c",
                                "http://a.org\n", "https://a.org\t", "//a.org", "https:", ""}) {
    const std::string shown = web_link(address, "text").html();
    EXPECT_EQ(shown.find("href"), std::string::npos) << shown;
    EXPECT_EQ(shown.find('<'), std::string::npos) << shown;
  }
  EXPECT_EQ(web_link("https://a.org/\"onclick=\"x", "t").html().find("\"onclick"), std::string::npos);
}

TEST(Links, ToFilesHaveNoScheme) {
  EXPECT_EQ(report::file_address("a b/c-1_2.~d/report.html"), "a%20b/c-1_2.~d/report.html");
  EXPECT_EQ(report::file_address(code + "/report.html"), "javascript%3Aalert%281%29/report.html");
}

// What the page's Content-Security-Policy allows.
std::string allowed_in(const std::string& page) {
  const std::string before = "http-equiv=\"Content-Security-Policy\" content=\"";
  const size_t from = page.find(before) + before.size();
  return page.substr(from, page.find('"', from) - from);
}

TEST(Links, APageLoadsNothingAndRunsOnlyScriptsThatItHas) {
  const std::string plain = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
  EXPECT_EQ(allowed_in(index_page({}, "0")), plain);
  EXPECT_EQ(allowed_in(render_report({}, [](const std::string&) { return std::string(); })),
            plain + "; script-src 'unsafe-inline'");
}

TEST(Links, OfTheAtlasAndTheIndexRunNoCode) {
  AtlasRow row;
  row.entry.failure = "acne";
  row.entry.thread = code;
  row.report = code + "/report.html";
  row.picture = code + "/images/p0000-classes.png";
  IndexEntry entry;
  entry.title = code;
  entry.report = code + "/report.html";
  for (const std::string& page : {to_atlas_page({&row, 1}, "0"), index_page({entry}, "0")}) {
    std::vector<std::string> addresses = values_of(page, "href");
    for (const std::string& source : values_of(page, "src")) addresses.push_back(source);
    size_t paths = 0;
    for (const std::string& address : addresses) {
      if (address == "data:,") continue;  // the page's icon
      EXPECT_TRUE(is_path(address)) << address;
      ++paths;
    }
    EXPECT_GE(paths, 1u);
  }
  EXPECT_NE(to_atlas_page({&row, 1}, "0").find("<br>" + code + ": "), std::string::npos) << "the thread as text";
  row.entry.thread = "https://github.com/a/b/issues/1";
  EXPECT_NE(to_atlas_page({&row, 1}, "0").find("<a href=\"https://github.com/a/b/issues/1\">a/b/issues/1</a>: "),
            std::string::npos);
}

}  // namespace
}  // namespace noonmark
