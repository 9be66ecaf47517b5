// app/pictures/: images of a measured point, and the codecs that read and write them. May include measure and compare;
// knows no experiment.
//
// The pictures and images of a sweep's points: selects the points that have them, and checks that their files are the
// ones that were written.
//
//   for (int64_t id : points_with_pictures(experiment.pictures, results))
//     if (!why_not_as_written(*find_point(results.points, id), out).empty()) keep_pictures(measurement, id, out, formats);
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/pictures/image_file.h"
#include "compare/report/lights_section.h"
#include "compare/results/records.h"
#include "measure/lights_frame.h"
#include "measure/workbench.h"

namespace noonmark {

// Ids of the points, selected by the experiment's `pictures`. `worst` and `extremes` select by error, and of a motion the
// frame with the largest flicker too (worst_instant); `answers` selects the three answers of every group (compare/report/speed_reading.h).
// All three need all points; an error that is not finite is the worst. `worst` and `extremes`
// also select the first point of the recommended choice, because the report's first screen shows it. But for `none`, every
// value selects points with a broken bound too, at most most_broken_shown of them. results: with the
// verdicts of the bounds, which the recommendation reads.
inline constexpr size_t most_broken_shown = 3;
std::vector<int64_t> points_with_pictures(const std::string& pictures, const Results& results);

// The point with the largest flicker, and points of its part that differ in nothing but the frame and its time: those about
// it, in the order of time. Nothing if no point flickers.
inline constexpr size_t most_motion_frames = 24;
struct Instant {
  int64_t id = -1;
  std::vector<int64_t> frames;  // at most most_motion_frames, `id` among them
};
Instant worst_instant(const std::vector<PointRecord>& points);

// Writes the point's picture of this name, an animated PNG. frames: motion_frame() (app/pictures/pictures.h) of each frame.
inline constexpr const char* motion_picture = "motion";
PictureRecord keep_motion(const std::vector<Image<Color>>& frames, int64_t id, const std::string& out);

// Which files a point's pictures are: PNG for people, or also OpenEXR with every number behind them (write_images()), which is
// several times as large.
enum class PictureFormats { png, png_and_exr };

// Whether the point has the files with the numbers.
bool has_exr(const PointPictures& point);

// Writes the point's files below out/images. The record must be in the store.
PointPictures keep_pictures(const Measurement& m, int64_t id, const std::string& out, PictureFormats formats);

// The same, and sections through its worst pixels (section_pixels()) as out/images/p0003-section-312-175.svg. m: the
// bench's last measurement.
PointPictures keep_pictures_and_sections(Workbench& bench, const Measurement& m, int64_t id, const std::string& out,
                                         PictureFormats formats);

// Draws the point's live picture and writes it as out/images/p0003-live.bin: at every bias, or, if its settings have no such
// picture, a stack of pictures at a few values (compare/ladder/picture_stack.h). marks: of the stack. The images of the bench's last
// measurement are gone afterwards. Throws Error.
ImageRecord keep_live_picture(Workbench& bench, const Settings& settings, const std::vector<double>& marks, int64_t id,
                              const std::string& out);

// Gives picture files the names of their points' new ids, in the records and on the disk. Each pair: the id before, and the
// record with its id now and the paths before. A file that is lost stays lost (why_not_as_written finds it).
void move_pictures(const std::vector<std::pair<int64_t, PointRecord*>>& moved, const std::string& out);

// Removes the files of a point that has no pictures any more.
void remove_pictures(const PointPictures& pictures, const std::string& out);
// The same of those that `which` names, with their records. Whether there were any.
bool remove_those(PointPictures& point, const std::function<bool(const PictureRecord&)>& which, const std::string& out);

// "out/images/p0003-map.png is not the file that was written", for the first file that is lost or changed; otherwise
// empty.
std::string why_not_as_written(const PointRecord& point, const std::string& out);

// For the report: returns the bytes of the picture or the image with this path. It must have the digest that one of the
// points has for it, and a picture must be a PNG. Throws Error(file).
std::string read_picture(const std::string& out, const std::string& path, const std::vector<PointRecord>& points);

inline constexpr std::string_view lights_prefix = report::lights_pictures;  // of their names

inline bool is_lights_picture(const PictureRecord& picture) { return picture.name.starts_with(lights_prefix); }

// Writes them below out/images. id: of the point. names: of the lights, in order.
std::vector<PictureRecord> keep_lights(const LightsFrame& frame, const std::vector<std::string>& names, int64_t id,
                                       const std::string& out);

}  // namespace noonmark
