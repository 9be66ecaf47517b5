// The pictures and images of a sweep's points: which points have them, and whether their files are still what was
// written.
//
//   for (int64_t id : points_with_pictures(experiment.pictures, results.points))
//     if (!why_not_as_written(*find_point(results.points, id), out).empty()) keep_pictures(measurement, id, out);
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "app/workbench.h"
#include "compare/store/records.h"

namespace noonmark {

// Ids, by the experiment's `pictures`. For `worst` and `extremes` all points must be there: by their error, and one
// that is not finite is worse than any.
std::vector<int64_t> points_with_pictures(const std::string& pictures, const std::vector<PointRecord>& points);

// Writes them below out/images. The record must be stored.
PointPictures keep_pictures(const Measurement& m, int64_t id, const std::string& out);

// "out/images/p0003-map.png is not the file that was written" of the first file that is lost or another; else empty.
std::string why_not_as_written(const PointRecord& point, const std::string& out);

// For the report: the bytes of the picture with this path, which must be a PNG with the digest that one of the points
// has for it. Throws Error(scene).
std::string read_picture(const std::string& out, const std::string& path, const std::vector<PointRecord>& points);

}  // namespace noonmark
