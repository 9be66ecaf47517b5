#include "compare/report/junit.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <string_view>

#include "base/text.h"
#include "compare/report/escape.h"

namespace noonmark {
namespace {

constexpr std::string_view head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
constexpr std::string_view foot = "    <system-out/>\n    <system-err/>\n  </testsuite>\n</testsuites>\n";

// The schema requires the form 2025-01-31T12:00:00 without a time zone.
std::string timestamp(const std::string& started) {
  constexpr size_t length = std::string_view("2025-01-31T12:00:00").size();
  return started.size() >= length ? started.substr(0, length) : "1970-01-01T00:00:00";
}

// What these points took.
double seconds_of(std::span<const PointRecord> points) {
  double ms = 0;
  for (const PointRecord& point : points)
    if (const auto time = point.times.find(point_time); time != point.times.end()) ms += time->second;
  return ms / 1000;
}

std::string properties_of(const Findings& found) {
  const RunInfo& info = found.all.info;
  const std::string verdict(word_of(found.verdict));
  const std::pair<std::string_view, const std::string&> properties[] = {{"experiment", info.experiment},
                                                                        {"command", info.command},
                                                                        {"commit", info.commit},
                                                                        {"version", info.version},
                                                                        {"gl_renderer", info.gl_renderer},
                                                                        {"embree_isa", info.embree_isa},
                                                                        {"verdict", verdict},
                                                                        {"verdict_text", found.sentence}};
  std::string xml = "    <properties>\n";
  for (const auto& [name, value] : properties)
    xml += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", name, xml_text(printable(value)));
  return xml + "    </properties>\n";
}

// What stands within the testcase of a promise; a frame also says what was not checked where it is right.
std::string outcome_of(const Promise& one) {
  const std::string found = xml_text(printable(one.found)), text = xml_text(one.text);
  switch (one.state) {
    case Promise::State::held:
      return one.of == Promise::Of::delivery ? fmt::format("<system-out>{}</system-out>", found) : "";
    case Promise::State::warning:
      return fmt::format("<skipped message=\"warning: {}\">{}</skipped>", found, text);
    case Promise::State::refused:
      return fmt::format("<error message=\"{}\" type=\"refused\">{}</error>", found, text);
    case Promise::State::broken:
      break;
  }
  constexpr std::string_view types[] = {"delivery", "bound", "law", "baseline"};
  return fmt::format("<failure message=\"{}\" type=\"{}\">{}</failure>", found, types[static_cast<size_t>(one.of)],
                     text);
}

}  // namespace

std::string to_junit(const Findings& found) {
  const Results& results = found.all;
  const bool complete = found.verdict != Verdict::incomplete, trusted = complete && found.verdict != Verdict::unsound;
  const std::string suite = xml_text(results.info.title.empty() ? "noonmark" : printable(results.info.title));
  std::string cases;
  std::set<std::string> taken;  // CI servers identify a testcase by its name, so names differ
  const auto add = [&](const std::string& title, const std::string& time, const std::string& outcome) {
    std::string name = printable(title);
    for (int copy = 2; !taken.insert(name).second; ++copy) name = fmt::format("{} #{}", printable(title), copy);
    cases += fmt::format("    <testcase classname=\"{}\" name=\"{}\"{}", suite, xml_text(name), time);
    cases += outcome.empty() ? "/>\n" : fmt::format(">\n      {}\n    </testcase>\n", outcome);
  };
  for (const Promise& one : found.promises)
    add(one.title, one.of == Promise::Of::delivery ? fmt::format(" time=\"{:.3f}\"", seconds_of({one.point, 1})) : "",
        outcome_of(one));
  if (!trusted)
    add(complete ? "the measurement is sound" : "the sweep is complete", "",
        fmt::format("<error message=\"{}\" type=\"{}\"/>", xml_text(found.sentence), word_of(found.verdict)));
  const auto count = [&](Promise::State state) {
    return std::count_if(found.promises.begin(), found.promises.end(),
                         [&](const Promise& one) { return one.state == state; });
  };
  std::string xml(head);
  xml += fmt::format(
      "  <testsuite name=\"{}\" package=\"noonmark\" id=\"0\" tests=\"{}\" failures=\"{}\" errors=\"{}\" "
      "time=\"{:.3f}\" timestamp=\"{}\" hostname=\"localhost\">\n",
      suite, taken.size(), count(Promise::State::broken), count(Promise::State::refused) + (trusted ? 0 : 1),
      seconds_of(results.points), xml_text(timestamp(results.info.started)));
  return xml.append(properties_of(found)).append(cases).append(foot);
}

std::string to_junit(const Unjudged& unjudged) {
  const std::string suite = xml_text(printable(unjudged.experiment));
  return fmt::format(
      "{0}  <testsuite name=\"{1}\" package=\"noonmark\" id=\"0\" tests=\"1\" failures=\"0\" errors=\"1\" "
      "timestamp=\"{2}\" hostname=\"localhost\">\n    <properties>\n      <property name=\"command\" value=\"{3}\"/>\n"
      "    </properties>\n    <testcase classname=\"{1}\" name=\"the experiment can be judged\">\n"
      "      <error message=\"{4}\" type=\"exit code {5}\"/>\n    </testcase>\n{6}",
      head, suite, xml_text(timestamp(unjudged.started)), xml_text(printable(unjudged.command)),
      xml_text(printable(unjudged.why)), unjudged.exit_code, foot);
}

}  // namespace noonmark
