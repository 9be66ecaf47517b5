// The report: one HTML file that needs nothing else. It works offline (a Content-Security-Policy in it forbids every
// request), every number in it is readable without JavaScript, and the same results always give the same bytes.
//
//   write(dir + "/report.html", render_report(results, [&](const std::string& path) { return bytes_of(dir, path); }));
#pragma once
#include <functional>
#include <string>

#include "compare/store/records.h"

namespace noonmark {

// read_file: the bytes of a picture by PictureRecord::path. When it throws a std::exception or gives nothing, the
// report says so in the picture's place. Values that are not finite are shown as "not finite".
std::string render_report(const Results& results, const std::function<std::string(const std::string& path)>& read_file);

}  // namespace noonmark
