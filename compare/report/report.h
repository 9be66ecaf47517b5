// compare/report/: how results are shown: HTML, CSV, JUnit, Markdown. Turns records into text and nothing else. May include
// what compare/judge may, and the judge; no store.
//
// The report: one HTML file without other files. It works offline, because a Content-Security-Policy in it forbids
// every request. Every number in it can be read without JavaScript, and the same results always give the same bytes.
//
//   write_file_atomically(dir + "/report.html", render_report(results, [&](const std::string& path) { return read_file(dir + "/" + path); }));
#pragma once
#include <functional>
#include <string>

#include "compare/results/records.h"

namespace noonmark {

// read_file: returns the bytes of a picture from PictureRecord::path. If it throws a std::exception or returns nothing,
// the report says so in the picture's place. Values that are not finite are shown as "not finite".
std::string render_report(const Results& results, const std::function<std::string(const std::string& path)>& read_file);

}  // namespace noonmark
