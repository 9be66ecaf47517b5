// A page in a real browser, headless Chromium, for tests of what its scripts draw and what clicks and keys do.
//
//   class Page : public Browser { void SetUp() override { open(render_report(results, read), "page_probe.js"); } };
//   TEST_F(Page, Draws) { EXPECT_EQ(saw_["marks"], 3); }
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "base/file.h"
#include "tests/support/source_dir.h"

namespace noonmark {

inline std::string output_of(const std::string& command) {
  FILE* const pipe = popen(command.c_str(), "r");
  std::string text;
  char block[65536];
  for (size_t n = 0; pipe && (n = fread(block, 1, sizeof block, pipe)) > 0;) text.append(block, n);
  if (pipe) pclose(pipe);
  return text;
}

class Browser : public testing::Test {
 protected:
  // Opens the page and runs a probe in it (a file beside this one), which leaves what it saw. Without a browser the test
  // is skipped, with this reason. window: "WIDTH,HEIGHT" in CSS pixels; Chromium's windows have at least 500, so a
  // narrower page stands in a frame of that width. Tests of one process that open the same page
  // share one start of the browser, because a start takes two seconds of processor time.
  void open(std::string page, const char* probe, const std::string& window = "1200,900") {
    const std::string browser = name_of_browser();
    if (browser.empty()) GTEST_SKIP() << why_skipped;
    const auto insert = [&](const std::string& before, const std::string& script) {
      const size_t at = page.rfind(before);
      ASSERT_NE(at, std::string::npos);
      page.insert(at, "<script>" + script + "</script>");
    };
    const std::string folder = noonmark::test::source_dir() + "/tests/compare/report/";
    // A probe starts when the page's scripts have, and finds what is folded unfolded.
    insert("</body>",
           "(async () => { await window.noonmarkReady; await unfold();\n" + read_file(folder + probe) + "})();");
    insert("</head>", read_file(folder + "probe_tools.js"));
    static std::map<std::string, nlohmann::json> seen;
    if (const auto known = seen.find(window + page); known != seen.end()) {
      saw_ = known->second;
      EXPECT_EQ(saw_["errors"], nlohmann::json::array()) << "errors of the page's scripts";
      return;
    }
    make_folder();
    std::string file = (folder_ / "report.html").string();
    write_file_atomically(file, page);
    if (const int width = std::stoi(window); width < 500) {
      file = (folder_ / "frame.html").string();
      write_file_atomically(file,
                            "<!doctype html><body><iframe src=\"report.html\" style=\"border:0;height:900px;width:" +
                                std::to_string(width) +
                                "px\"></iframe><script>addEventListener('message', function(e) { var probe = "
                                "document.createElement('pre'); probe.id = 'probe'; probe.textContent = e.data; "
                                "document.body.append(probe); });</script></body>");
    }
    const std::string dom =
        output_of(command(browser) + " --window-size=" + window + " --virtual-time-budget=10000 --dump-dom 'file://" +
                  file + "' 2>'" + (folder_ / "browser.txt").string() + "'");
    const std::string head = "<pre id=\"probe\">";
    const size_t begin = dom.rfind(head);
    ASSERT_NE(begin, std::string::npos) << "the scripts of the page stopped; the output of the browser: "
                                        << read_file((folder_ / "browser.txt").string());
    saw_ = nlohmann::json::parse(dom.substr(begin + head.size(), dom.find("</pre>", begin) - begin - head.size()));
    seen[window + page] = saw_;
    EXPECT_EQ(saw_["errors"], nlohmann::json::array()) << "errors of the page's scripts";
  }
  // The bytes of the PDF that the browser prints. Without a browser the test is skipped.
  std::string printed(const std::string& page) {
    const std::string browser = name_of_browser();
    const auto skip = [] { GTEST_SKIP() << why_skipped; };
    if (browser.empty()) return skip(), "";
    make_folder();
    const std::string file = (folder_ / "report.html").string(), pdf = (folder_ / "report.pdf").string();
    write_file_atomically(file, page);
    output_of(command(browser) + " --print-to-pdf='" + pdf + "' --virtual-time-budget=10000 'file://" + file +
              "' 2>&1");
    return read_file(pdf);
  }
  void TearDown() override {
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
  }
  int marks(const char* chart, const char* kind) const { return saw_["charts"].at(chart).at(kind); }

  static constexpr const char* why_skipped = "there is no chromium, so the page is not tested in a browser";
  static std::string name_of_browser() {
    std::string name = output_of("command -v chromium || command -v chromium-browser || command -v google-chrome");
    if (!name.empty()) name.pop_back();
    return name;
  }
  void make_folder() {
    folder_ = std::filesystem::path(testing::TempDir()) / ("noonmark-page-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  // The start of a command that runs the browser without a window.
  std::string command(const std::string& browser) const {
    return "HOME='" + folder_.string() + "' timeout " + std::to_string(timeout_s_) + " '" + browser + "'" +
           more_flags_ +
           " --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run --user-data-dir='" +
           (folder_ / "profile").string() + "'";
  }

  std::filesystem::path folder_;
  nlohmann::json saw_;
  int timeout_s_ = 400;     // a start takes seconds, and 70 s on a machine that many others use
  std::string more_flags_;  // of the browser, each after a space
};

}  // namespace noonmark
