#include "compare/report/junit.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <string_view>

#include "base/text.h"
#include "compare/judge/baseline.h"
#include "compare/judge/bounds.h"
#include "compare/judge/deliveries.h"
#include "compare/judge/law_table.h"
#include "compare/judge/laws.h"
#include "compare/judge/verdict.h"
#include "compare/report/escape.h"
#include "compare/results/quantities.h"

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

std::string properties_of(const Results& results) {
  const std::string verdict(word_of(verdict_of(results)));
  const std::pair<std::string_view, const std::string&> properties[] = {{"experiment", results.info.experiment},
                                                                        {"command", results.info.command},
                                                                        {"commit", results.info.commit},
                                                                        {"version", results.info.version},
                                                                        {"gl_renderer", results.info.gl_renderer},
                                                                        {"embree_isa", results.info.embree_isa},
                                                                        {"verdict", verdict}};
  std::string xml = "    <properties>\n";
  for (const auto& [name, value] : properties)
    xml += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", name, xml_text(printable(value)));
  return xml + "    </properties>\n";
}

// The testcases of a suite. CI servers identify one by its name, so names differ.
class Testcases {
 public:
  explicit Testcases(std::string suite) : suite_(std::move(suite)) {}
  const std::string& xml() const { return xml_; }

  // Neither message nor text is asked for where it held.
  void add(const std::string& title, bool held, bool warns, std::string_view type, const auto& message,
           const auto& text) {
    std::string name = printable(title);
    for (int copy = 2; !taken_.insert(name).second; ++copy) name = fmt::format("{} #{}", printable(title), copy);
    xml_ += fmt::format("    <testcase classname=\"{}\" name=\"{}\"", xml_text(suite_), xml_text(name));
    if (held)
      xml_ += "/>\n";
    else if (warns)
      xml_ += fmt::format(">\n      <skipped message=\"warning: {}\">{}</skipped>\n    </testcase>\n",
                          xml_text(printable(message())), xml_text(text()));
    else
      xml_ += fmt::format(">\n      <failure message=\"{}\" type=\"{}\">{}</failure>\n    </testcase>\n",
                          xml_text(printable(message())), type, xml_text(text()));
  }

  // Each frame is a test case of its own: a server shows which was refused. What was not checked is in its output.
  void add_frame(const PointRecord& frame) {
    const std::string name = printable("the delivery of " + frame_name(frame));
    taken_.insert(name);
    xml_ += fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">\n", xml_text(suite_),
                        xml_text(name), seconds_of({&frame, 1}));
    if (!frame.delivery.refused.empty())
      xml_ += fmt::format("      <error message=\"{}\" type=\"refused\">{}</error>\n",
                          xml_text(printable(frame.delivery.refused)), xml_text(printable(why_refused(frame))));
    else
      xml_ += fmt::format("      <system-out>{}</system-out>\n", xml_text(printable(delivery_text(frame))));
    xml_ += "    </testcase>\n";
  }

  void add_incomplete(int64_t finished, int64_t planned) {
    xml_ += fmt::format(
        "    <testcase classname=\"{}\" name=\"the sweep is complete\">\n      <error "
        "message=\"{} of {} points are finished; run it again to continue\" type=\"incomplete\"/>\n    </testcase>\n",
        xml_text(suite_), finished, planned);
  }

 private:
  std::string suite_, xml_;
  std::set<std::string> taken_;
};

void add_promises(Testcases& cases, const Results& results) {
  for (const BoundResult& bound : results.bounds)
    cases.add(
        bound_text(bound), bound.held, bound.warns, "bound",
        [&] {
          return bound.points == 0 ? "no finished point matches the bound"
                                   : fmt::format("found {}", found_text(bound, results.points));
        },
        [&] { return describe(bound, find_point(results.points, bound.point), results.info.swept); });
  for (const LawResult& law : results.laws)
    cases.add(
        law.name, law.held, false, "law", [&] { return law_text(law); },
        [&] {
          return law_table({&law, 1});
        });
  if (const auto& baseline = results.baseline)
    cases.add(
        "no value is worse than in the baseline", baseline->held(), false, "baseline",
        [&] { return baseline_verdict(*baseline); },
        [&] {
          std::string lines;
          for (const std::string& line : baseline->worse) lines += printable(line) + "\n";
          return lines;
        });
}

}  // namespace

std::string to_junit(const Results& results) {
  const auto finished = static_cast<int64_t>(results.points.size());
  const bool incomplete = results.stopped || finished < results.planned_points;
  const bool frames = judges_frames(results.points);
  const size_t refused = refused_frames(results.points).size();
  const auto failures =
      std::count_if(results.bounds.begin(), results.bounds.end(), breaks) +
      std::count_if(results.laws.begin(), results.laws.end(), [](const LawResult& l) { return !l.held; }) +
      (results.baseline && !results.baseline->held() ? 1 : 0);
  const std::string suite = results.info.title.empty() ? "noonmark" : printable(results.info.title);
  Testcases cases(suite);
  if (frames)
    for (const PointRecord& frame : results.points) cases.add_frame(frame);
  add_promises(cases, results);
  if (incomplete) cases.add_incomplete(finished, results.planned_points);

  std::string xml(head);
  xml += fmt::format(
      "  <testsuite name=\"{}\" package=\"noonmark\" id=\"0\" tests=\"{}\" failures=\"{}\" errors=\"{}\" "
      "time=\"{:.3f}\" timestamp=\"{}\" hostname=\"localhost\">\n",
      xml_text(suite),
      results.bounds.size() + results.laws.size() + (frames ? results.points.size() : 0) + (results.baseline ? 1 : 0) +
          (incomplete ? 1 : 0),
      failures, refused + (incomplete ? 1 : 0), seconds_of(results.points), xml_text(timestamp(results.info.started)));
  return xml.append(properties_of(results)).append(cases.xml()).append(foot);
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
