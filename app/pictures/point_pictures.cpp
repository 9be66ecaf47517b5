#include "app/pictures/point_pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>

#include "app/pictures/picture_files.h"
#include "app/pictures/pictures.h"
#include "app/pictures/point_files.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/file.h"
#include "compare/judge/bounds.h"
#include "compare/judge/recommendation.h"
#include "compare/judge/tradeoff.h"
#include "compare/ladder/flicker.h"
#include "compare/report/lights_section.h"
#include "compare/report/section_picture.h"
#include "compare/report/speed_reading.h"

namespace noonmark {
namespace {

// The limit for one picture in the report. It is far above the PNG size of the largest view.
constexpr uint64_t max_picture_bytes = uint64_t{1} << 28;

// PNG specification, section 5.2.
constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

// All settings but the frame and its time.
std::map<std::string, std::string> choice_of(const PointRecord& point) {
  std::map<std::string, std::string> settings = point.settings;
  std::erase_if(settings, [](const auto& setting) { return names_a_frame(setting.first); });
  return settings;
}

}  // namespace

Instant worst_instant(const std::vector<PointRecord>& points) {
  const PointRecord* worst = nullptr;
  double most = 0;
  for (const PointRecord& point : points)
    if (const auto found = point.metrics.find("flicker"); found != point.metrics.end() && !(found->second <= most)) {
      worst = &point;
      most = found->second;
    }
  if (!worst) return {};
  Instant instant{worst->id, {}};
  const std::map<std::string, std::string> choice = choice_of(*worst);
  std::vector<const PointRecord*> frames;
  for (const PointRecord& point : points)
    if (point.part == worst->part && choice_of(point) == choice) frames.push_back(&point);
  const auto time = [](const PointRecord* point) {
    const auto number = [&](const char* name) {
      const auto found = point->settings.find(name);
      return found == point->settings.end() ? 0 : std::strtod(found->second.c_str(), nullptr);  // "auto" reads as 0
    };
    return std::pair(number("motion.frame"), number("scene.time_s"));
  };
  std::stable_sort(frames.begin(), frames.end(),
                   [&](const PointRecord* a, const PointRecord* b) { return time(a) < time(b); });
  const auto at = static_cast<size_t>(std::find(frames.begin(), frames.end(), worst) - frames.begin());
  const size_t count = std::min(frames.size(), most_motion_frames);
  const size_t first = std::min(at - std::min(at, most_motion_frames / 2), frames.size() - count);
  for (size_t i = first; i < first + count; ++i) instant.frames.push_back(frames[i]->id);
  return instant;
}

PictureRecord keep_motion(const std::vector<Image<Color>>& frames, int64_t id, const std::string& out) {
  constexpr int frame_ms = 200;  // slow enough to see what changes where
  const std::string path = fmt::format("images/p{:04}-{}.png", id, motion_picture);
  make_folder_in(out, "images");
  const std::string digest = write_animated_png(out + "/" + path, frames, frame_ms);
  return {motion_picture, path,
          fmt::format("{} frames about this one, animated: what the shadow map shows (left) and what changes until the "
                      "next frame although the truth does not (right; colours as in the picture flicker).",
                      frames.size()),
          digest};
}

std::vector<int64_t> points_with_pictures(const std::string& pictures, const Results& results) {
  const std::vector<PointRecord>& points = results.points;
  std::vector<int64_t> ids;
  if (points.empty() || pictures == "none") return ids;
  const auto add = [&](int64_t id) {
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  };
  // A failure is seen at its own point, and several lights by the one that makes most of the error.
  const auto add_spoken_of = [&] {
    size_t more = most_broken_shown;
    for (const BoundResult& bound : results.bounds)
      if (breaks(bound) && find_point(points, bound.point) && more > 0) add(bound.point), --more;
    // The report opens with this light.
    if (const PointRecord* light = report::largest_light(results)) add(light->id);
  };
  if (pictures == "broken" && std::none_of(results.bounds.begin(), results.bounds.end(), breaks)) return ids;
  if (pictures == "first" || pictures == "broken") {
    if (pictures == "first") ids = {points.front().id};
    add_spoken_of();
    return ids;
  }
  if (pictures == "all") {
    for (const PointRecord& point : points) ids.push_back(point.id);
    return ids;
  }
  if (pictures == "answers") {
    ids = report::answer_points(compared_groups(results), results);
    add_spoken_of();
    return ids;
  }
  const auto badness = [](const PointRecord& p) {
    const double error = p.metrics.at("error");
    return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
  };
  const auto [best, worst] =
      std::minmax_element(points.begin(), points.end(),
                          [&](const PointRecord& a, const PointRecord& b) { return badness(a) < badness(b); });
  if (pictures == "extremes" && best != worst) ids.push_back(best->id);
  ids.push_back(worst->id);
  if (const int64_t id = worst_instant(points).id; id >= 0) add(id);
  add_spoken_of();
  // Points of different parts have no common answer.
  if (!points.front().part.empty()) return ids;
  const Recommendation found = recommend(results);
  if (found.outcome != Recommendation::Outcome::found) return ids;
  add(found.choice.first().id);
  return ids;
}

bool has_exr(const PointPictures& point) {
  return std::any_of(point.images.begin(), point.images.end(),
                     [](const ImageRecord& image) { return image.path.ends_with(".exr"); });
}

PointPictures keep_pictures(const Measurement& m, int64_t id, const std::string& out, PictureFormats formats) {
  const std::string folder = out + "/images";
  make_folder_in(out, "images");
  const std::string stem = fmt::format("p{:04}", id);
  PointPictures kept;
  kept.pictures = write_pictures(m, folder, "images", stem);
  if (formats == PictureFormats::png_and_exr) kept.images = write_images(m, folder, "images", stem + "-");
  return kept;
}

PointPictures keep_pictures_and_sections(Workbench& bench, const Measurement& m, int64_t id, const std::string& out,
                                         PictureFormats formats) {
  PointPictures kept = keep_pictures(m, id, out, formats);
  if (!m.ladder.of_comparisons()) return kept;  // a section shows the verdicts of taps
  const std::vector<glm::ivec2> pixels =
      section_pixels(m.record, m.ladder, [&](size_t i) -> const LookupProbe& { return m.map_of(i).probe; });
  if (pixels.empty()) return kept;  // no taps are traced again for nothing
  for (const ReceiverSection& section : bench.sections(m, pixels)) {
    const std::string path = report::section_path(id, section.pixel),
                      file = report::section_svg(section, report::SectionTheme::automatic);
    write_file_atomically(out + "/" + path, file);
    kept.images.push_back({path, digest_of(file)});
  }
  return kept;
}

ImageRecord keep_live_picture(Workbench& bench, const Settings& settings, const std::vector<double>& marks, int64_t id,
                              const std::string& out) {
  const std::optional<LivePicture> at_every_bias = bench.live_picture(settings);
  const std::string path = fmt::format("images/p{:04}-live.bin", id),
                    file = at_every_bias ? live_file(*at_every_bias) : stack_file(bench.picture_stack(settings, marks));
  make_folder_in(out, "images");
  write_file_atomically(out + "/" + path, file);
  return {path, digest_of(file)};
}

void move_pictures(const std::vector<std::pair<int64_t, PointRecord*>>& moved, const std::string& out) {
  namespace fs = std::filesystem;
  std::vector<std::pair<fs::path, fs::path>> from_temporary;
  std::error_code none;
  for (const auto& [before, point] : moved) {
    const std::string old_stem = fmt::format("images/p{:04}-", before);
    const std::string new_stem = fmt::format("images/p{:04}-", point->id);
    const auto move = [&, id = before](std::string& path) {
      if (!path.starts_with(old_stem)) return;
      const std::string rest = path.substr(old_stem.size());
      // Two points may change places, so every file first gets a name that no point has.
      const fs::path temporary = fs::path(out) / fmt::format("images/moved-{}-{}", id, rest);
      fs::rename(fs::path(out) / path, temporary, none);
      path = new_stem + rest;
      from_temporary.emplace_back(temporary, fs::path(out) / path);
    };
    for (PictureRecord& picture : point->pictures) move(picture.path);
    for (ImageRecord& image : point->images) move(image.path);
  }
  for (const auto& [from, to] : from_temporary) fs::rename(from, to, none);
}

void remove_pictures(const PointPictures& pictures, const std::string& out) {
  std::error_code none;
  const auto remove = [&](const std::string& path) {
    if (path.starts_with("images/p") && path.find("..") == std::string::npos)
      std::filesystem::remove(std::filesystem::path(out) / path, none);
  };
  for (const PictureRecord& picture : pictures.pictures) remove(picture.path);
  for (const ImageRecord& image : pictures.images) remove(image.path);
}

bool remove_those(PointPictures& point, const std::function<bool(const PictureRecord&)>& which,
                  const std::string& out) {
  PointPictures old;
  std::copy_if(point.pictures.begin(), point.pictures.end(), std::back_inserter(old.pictures), which);
  remove_pictures(old, out);
  std::erase_if(point.pictures, which);
  return !old.pictures.empty();
}

std::string why_not_as_written(const PointRecord& point, const std::string& out) {
  std::string why;
  const auto check = [&](const std::string& path, const std::string& digest) {
    if (!why.empty()) return;
    std::error_code none;
    if (!std::filesystem::exists(out + "/" + path, none)) {
      why = fmt::format("{}/{} is lost", out, path);
      return;
    }
    try {
      if (digest_of_file_below(out, path) != digest)
        why = fmt::format("{}/{} is not the file that was written", out, path);
    } catch (const Error& error) {
      why = error.what();
    }
  };
  for (const PictureRecord& picture : point.pictures) check(picture.path, picture.digest);
  for (const ImageRecord& image : point.images) check(image.path, image.digest);
  return why;
}

std::string read_picture(const std::string& out, const std::string& path, const std::vector<PointRecord>& points) {
  const std::string bytes = read_file_below(out, path, max_picture_bytes);
  const std::string digest = digest_of(bytes);
  for (const PointRecord& point : points)
    for (const ImageRecord& image : point.images)
      if (image.path == path && image.digest == digest) return bytes;
  if (!bytes.starts_with(png_signature)) throw Error(ErrorKind::file, "it is no PNG file");
  for (const PointRecord& point : points)
    for (const PictureRecord& picture : point.pictures)
      if (picture.path == path && picture.digest == digest) return bytes;
  throw Error(ErrorKind::file, "it is not the file that was written; run the experiment into this folder again");
}

std::vector<PictureRecord> keep_lights(const LightsFrame& frame, const std::vector<std::string>& names, int64_t id,
                                       const std::string& out) {
  make_folder_in(out, "images");
  std::vector<std::string> colors;
  for (size_t l = 0; l < names.size(); ++l) colors.push_back(fmt::format("{}: {}", names[l], most_wrong_color(l).name));
  const struct {
    const char* name;
    const Image<Color>& picture;
    std::string caption;
  } pictures[] = {
      {"shown", frame.shown, "The frame of all lights, as the shadow maps show it."},
      {"truth", frame.truth, "The same frame with the true shadows."},
      {"most-wrong", frame.most_wrong,
       fmt::format("Which light makes the largest part of the frame's error at each pixel ({}); black: none.",
                   fmt::join(colors, ", "))}};
  PictureFiles files(out + "/images", "images", fmt::format("p{:04}", id));
  for (const auto& one : pictures)
    files.add(std::string(lights_prefix) + one.name, one.caption, [&one] { return one.picture; });
  return files.write();
}

}  // namespace noonmark
