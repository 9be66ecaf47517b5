#include "compare/junit.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "compare/bounds.h"
#include "compare/laws.h"

namespace noonmark {
namespace {

// Length of the UTF-8 sequence at the start of text that XML 1.0 allows, or 0. Byte ranges: RFC 3629, section 4.
size_t allowed_length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [&](size_t i, unsigned from = 0x80, unsigned to = 0xbf) {
    return byte(i) >= from && byte(i) <= to;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  if (first >= 0xc2 && first <= 0xdf) return follows(1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    const bool second = follows(1, first == 0xe0 ? 0xa0 : 0x80, first == 0xed ? 0x9f : 0xbf);
    const bool noncharacter = first == 0xef && byte(1) == 0xbf && byte(2) >= 0xbe;  // U+FFFE, U+FFFF
    return second && follows(2) && !noncharacter ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4)
    return follows(1, first == 0xf0 ? 0x90 : 0x80, first == 0xf4 ? 0x8f : 0xbf) && follows(2) && follows(3) ? 4 : 0;
  return 0;
}

// For text and attributes alike. What XML cannot hold becomes U+FFFD.
std::string escaped(std::string_view text) {
  std::string xml;
  while (!text.empty()) {
    const size_t length = allowed_length(text);
    switch (length == 1 ? text.front() : 'x') {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      case '"':
        xml += "&quot;";
        break;
      case '\n':
        xml += "&#10;";
        break;
      case '\r':
        xml += "&#13;";
        break;
      case '\t':
        xml += "&#9;";
        break;
      default:
        xml += length == 0 ? std::string_view("\xef\xbf\xbd") : text.substr(0, length);
    }
    text.remove_prefix(std::max<size_t>(length, 1));
  }
  return xml;
}

// The schema wants 2025-01-31T12:00:00 without a zone.
std::string timestamp(const std::string& started) {
  constexpr size_t length = std::string_view("2025-01-31T12:00:00").size();
  return started.size() >= length ? started.substr(0, length) : "1970-01-01T00:00:00";
}

}  // namespace

std::string to_junit(const Results& results) {
  const auto finished = static_cast<int64_t>(results.points.size());
  const bool incomplete = finished < results.planned_points;
  const auto failures =
      std::count_if(results.bounds.begin(), results.bounds.end(), [](const BoundResult& b) { return !b.held; }) +
      std::count_if(results.laws.begin(), results.laws.end(), [](const LawResult& l) { return !l.held; });
  const std::string suite = results.info.title.empty() ? "noonmark" : results.info.title;

  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  xml += fmt::format(
      "  <testsuite name=\"{}\" package=\"noonmark\" id=\"0\" tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"0\" "
      "timestamp=\"{}\" hostname=\"localhost\">\n",
      escaped(suite), results.bounds.size() + results.laws.size() + (incomplete ? 1 : 0), failures, incomplete ? 1 : 0,
      escaped(timestamp(results.info.started)));
  xml += "    <properties>\n";
  const std::pair<std::string_view, const std::string&> properties[] = {
      {"experiment", results.info.experiment},   {"command", results.info.command},
      {"commit", results.info.commit},           {"version", results.info.version},
      {"gl_renderer", results.info.gl_renderer}, {"embree_isa", results.info.embree_isa}};
  for (const auto& [name, value] : properties)
    xml += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", name, escaped(value));
  xml += "    </properties>\n";

  std::set<std::string> taken;  // CI servers follow a testcase by its name, so no two may share one
  const auto testcase = [&](const std::string& title, bool held, std::string_view type, const auto& message,
                            const auto& text) {
    std::string name = title;
    for (int copy = 2; !taken.insert(name).second; ++copy) name = fmt::format("{} #{}", title, copy);
    xml += fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0\"", escaped(suite), escaped(name));
    xml += held ? "/>\n"
                : fmt::format(">\n      <failure message=\"{}\" type=\"{}\">{}</failure>\n    </testcase>\n",
                              escaped(message()), type, escaped(text()));
  };
  for (const BoundResult& bound : results.bounds)
    testcase(
        bound_text(bound), bound.held, "bound",
        [&] {
          return bound.points == 0 ? "no finished point matches the bound" : fmt::format("found {}", found_text(bound));
        },
        [&] { return describe(bound, find_point(results.points, bound.point), results.info.swept); });
  for (const LawResult& law : results.laws)
    testcase(
        law.name, law.held, "law", [&] { return law_text(law); },
        [&] {
          return law_table({&law, 1});
        });
  if (incomplete)
    xml += fmt::format(
        "    <testcase classname=\"{}\" name=\"the sweep is complete\" time=\"0\">\n      <error "
        "message=\"{} of {} points are finished; run it again to go on\" type=\"incomplete\"/>\n    </testcase>\n",
        escaped(suite), finished, results.planned_points);
  return xml + "    <system-out/>\n    <system-err/>\n  </testsuite>\n</testsuites>\n";
}

}  // namespace noonmark
