// The pixels that summary.md shows: of each broken bound the worst pixel of its own metric, of each broken law the pixel
// with the largest error.
//
//   for (const FailingPixel& one : failing_pixels(results))
//     pictures.push_back(draw(measure(one.point->id), one, "resolution 512", out));
#pragma once
#include <string>
#include <vector>

#include "compare/report/summary.h"
#include "compare/results/records.h"
#include "measure/workbench.h"

namespace noonmark {

struct FailingPixel {
  const PointRecord* point = nullptr;  // one of the results'
  PointRecord::WorstOf pixel;
  std::string broken;  // "acne <= 0.5%", or the law's name
  bool of_bound = true;
};

// Each pixel once and only the first few, because a summary is read in a minute. Points stand together. Bounds on what no
// pixel has (a time, a window) have none.
std::vector<FailingPixel> failing_pixels(const Results& results);

// Writes the picture of the pixel's surroundings beside summary.md. m: of the pixel's point. name: the point's.
SummaryPicture draw(const Measurement& m, const FailingPixel& failing, const std::string& name, const std::string& out);

// The same of a picture that is drawn already. middle: what it shows between the truth and the causes.
SummaryPicture write_pixel(const Image<Color>& picture, std::string_view middle, const FailingPixel& failing,
                           const std::string& name, const std::string& out);

}  // namespace noonmark
