// How the page opens: the point of its first picture, and the bias of all its figures. And the pictures of a point at another
// bias than its own, with which it opens where it recommends one.
//
//   const Opening first = opening(results);
//   if (first.bias) print(*first.point, *first.bias, name_at_bias("map", *first.bias));
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/judge/findings.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Whether the figures open with the bias as set, because the head of the page speaks of it: a bound or a law is broken, the
// measurement is not sound, the sweep is incomplete, it is a law's own sentence, or it speaks of a frame of several lights.
bool opens_as_set(const Findings& found);

// The file of a point's live picture; null if it has none.
const ImageRecord* live_image(const PointRecord& point);

// The point that the answer in the page's head names: that of the recommendation, or in a report of parts that of its cheapest
// good choice (answer_of_parts). Null without an answer.
const PointRecord* answer_point(const Findings& found);

struct Opening {
  // The point that the head of the page speaks of. It must have a live picture. The first of these that has one:
  // 1. the point of the first broken bound (not of a bound on a whole frame of lights);
  // 2. of the part that the headline's law speaks of, the one with the largest error;
  // 3. in a frame of lights, largest_light() (compare/report/lights_section.h);
  // 4. the point of the answer (answer_point);
  // 5. any point. Null if no point has a live picture.
  const PointRecord* point = nullptr;
  std::optional<double> bias;  // at which it opens, in bias.unit; empty: as set
};
Opening opening(const Findings& found);

// A picture at another bias than the point's own has the bias in its name, exactly: "map at 3.7". A page shows it only while
// that bias is the recommended one of the point. bias: in bias.unit, of the parameter that the point's curve varies.
struct NameAtBias {
  std::string picture;  // "map"
  double bias = 0;
};
std::string name_at_bias(std::string_view picture, double bias);
std::optional<NameAtBias> bias_in_name(const std::string& name);  // empty if it is a picture at the point's own bias

// The point's pictures for the page. biases: recommended_biases(). The picture "map at 3.7" has there the name "map at the
// recommended bias" if 3.7 is recommended, and is otherwise left out.
std::string at_recommended_bias(std::string_view picture);
std::vector<PictureRecord> pictures_for_page(const PointRecord& point, const std::map<int64_t, double>& biases);

}  // namespace noonmark::report
