// Every address in a page is an anchor or a file beside it, whatever the names in it are.
#include "compare/report/links.h"

#include <gtest/gtest.h>

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

TEST(Links, OfTheIndexRunNoCode) {
  IndexEntry entry;
  entry.title = code;
  entry.report = code + "/report.html";
  size_t paths = 0;
  for (const std::string& address : values_of(index_page({entry}, "0"), "href")) {
    if (address == "data:,") continue;  // the page's icon
    EXPECT_TRUE(is_path(address)) << address;
    ++paths;
  }
  EXPECT_GE(paths, 1u);
}

}  // namespace
}  // namespace noonmark
