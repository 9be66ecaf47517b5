#include "app/sweep/failing_pixels.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/pictures/image_file.h"
#include "app/pictures/pictures.h"
#include "app/sweep/results_folder.h"
#include "compare/judge/findings.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {

std::vector<FailingPixel> failing_pixels(const Results& results) {
  constexpr size_t most = 3;
  std::vector<FailingPixel> found;
  const auto add = [&](FailingPixel one) {
    const auto same = [&](const FailingPixel& other) {
      return other.point == one.point && other.pixel.metric == one.pixel.metric;
    };
    if (found.size() < most && std::none_of(found.begin(), found.end(), same)) found.push_back(std::move(one));
  };
  for (const Promise& one : promises_of(results))
    if (one.pixel) add({one.point, *one.pixel, one.title, one.of == Promise::Of::bound});
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.point->id < b.point->id; });
  return found;
}

SummaryPicture draw(const Measurement& m, const FailingPixel& failing, const std::string& name,
                    const std::string& out) {
  return write_pixel(pixel_picture(m, failing.pixel.x, failing.pixel.y), "the shadow map", failing, name, out);
}

SummaryPicture write_pixel(const Image<Color>& picture, std::string_view middle, const FailingPixel& failing,
                           const std::string& name, const std::string& out) {
  const PointRecord& point = *failing.point;
  const PointRecord::WorstOf& pixel = failing.pixel;
  const bool error = pixel.metric == "error" || pixel.metric == "wrong" || pixel.metric == "frame_error";
  const std::string file = fmt::format("{}{:04}-{}.png", summary_picture, point.id, pixel.metric);
  write_png(out + "/" + file, picture);
  return {
      file,
      fmt::format("Point {} ({}), {} {}: the pixel with the largest {}, ({}, {}), is framed; {} {}{}. Left the truth, "
                  "in the middle {}, right the causes; {} x {} pixels, enlarged.",
                  point.id, name, failing.of_bound ? "broken bound" : "broken law", failing.broken,
                  error ? "error" : pixel.metric, pixel.x, pixel.y, error ? "error" : pixel.metric,
                  quantity_text(pixel.size, find_quantity(pixel.metric, {&point, 1}).unit),
                  error ? ", cause " + point.worst.cause : "", middle, crop_px, crop_px)};
}

}  // namespace noonmark
