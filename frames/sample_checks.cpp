// The check that each value is its own pixel's. A lookup knows nothing of the picture: not where one surface hides another, not
// where blocks of 8 x 8 pixels begin, and not which pixels have an even number. What follows these was done to the picture.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "frames/alignment.h"
#include "frames/check_outcome.h"

namespace noonmark {
namespace {

// Whether the pixel is a corner of a region of one value: a neighbour in its row has another one, and so has one in its column. Along
// a straight edge a lookup may repeat one value over hundreds of pixels, which are one finding and have few corners.
bool is_corner(const Image<float>& v, int x, int y) {
  constexpr float same = 0.004f;
  const auto differs = [&](int a, int b) {
    return a < 0 || b < 0 || a >= v.width || b >= v.height || !(std::abs(v.at(a, b) - v.at(x, y)) <= same);
  };
  return (differs(x - 1, y) || differs(x + 1, y)) && (differs(x, y - 1) || differs(x, y + 1));
}

// ---- JPEG

// Blocks of 8 x 8 pixels in which a value is a little off the truth, by where the blocks begin. A JPEG file spreads its errors
// over whole blocks, so fewest are touched where its own begin.
struct Blocks {
  size_t own = 0;               // blocks that begin in the picture's corner
  size_t elsewhere = 0;         // the fewest of blocks that begin two pixels or more away from there along both axes
  size_t right = 0, below = 0;  // the fewest of those that begin so far away along one axis
  // Good frames: 0.94 times as many and more; files of quality 75: 0.5 to 0.9 times. A long edge along a row of blocks touches more
  // of those that begin elsewhere along one axis alone.
  bool are_of_jpeg() const {
    return own * 5 <= elsewhere * 4 && elsewhere >= own + 10 && own * 20 <= right * 19 && own * 20 <= below * 19;
  }
};
Blocks blocks_of(const CheckEvidence& e) {
  constexpr int side = 8, apart = 2;
  constexpr double least = 0.002,
                   most = 0.15;  // half a step of 8 bits, and what quality 75 adds at most beside an edge
  const Image<float>& v = e.frame.visibility;
  std::vector<std::array<int, 2>> off;
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) {
      const size_t i = v.index(x, y);
      const double error = std::abs(v[i] - static_cast<double>(e.truth.soft[i]));
      if (e.counted[i] && error > least && error < most && is_corner(v, x, y)) off.push_back({x, y});
    }
  const auto touched = [&](int left, int top) {
    const int across = v.width / side + 2;
    std::vector<uint8_t> hit(static_cast<size_t>(across) * static_cast<size_t>(v.height / side + 2), 0);
    for (const auto& [x, y] : off)
      hit[static_cast<size_t>((y + side - top) / side * across + (x + side - left) / side)] = 1;
    return static_cast<size_t>(std::count(hit.begin(), hit.end(), uint8_t{1}));
  };
  Blocks found{.own = touched(0, 0), .elsewhere = v.size(), .right = v.size(), .below = v.size()};
  for (int by = apart; by <= side - apart; ++by) {
    found.right = std::min(found.right, touched(by, 0));
    found.below = std::min(found.below, touched(0, by));
  }
  for (int top = apart; top <= side - apart; ++top)
    for (int left = apart; left <= side - apart; ++left)
      found.elsewhere = std::min(found.elsewhere, touched(left, top));
  return found;
}

// ---- resizing

// Half of the size and back, linearly, makes every second step from a pixel to the next the mean of the steps before and after
// it, and the steps between are as they were.
struct Steps {
  std::array<size_t, 2> count{}, mean{};  // by whether the pixel's number is even; mean: those that are
  bool are_of_resizing() const {
    for (const int even : {0, 1}) {
      const int odd = 1 - even;
      if (count[even] >= enough && count[odd] >= enough && mean[even] * 10 >= count[even] * 9 &&
          mean[odd] * 2 <= count[odd])
        return true;
    }
    return false;
  }
};

Steps steps_of(const Image<float>& v, bool along_rows) {
  constexpr double least_step = 0.02, rounding = 0.003;  // of two values of 8 bits each
  Steps found;
  const int length = along_rows ? v.width : v.height, lines = along_rows ? v.height : v.width;
  for (int line = 0; line < lines; ++line)
    for (int k = 1; k + 2 < length; ++k) {
      const auto at = [&](int where) { return along_rows ? v.at(where, line) : v.at(line, where); };
      const double before = at(k) - at(k - 1), here = at(k + 1) - at(k), after = at(k + 2) - at(k + 1);
      if (!(std::abs(here) > least_step) || std::isnan(before + after)) continue;
      const auto even = static_cast<size_t>(k % 2 == 0);
      ++found.count[even];
      found.mean[even] += std::abs(here - (before + after) / 2) <= rounding;
    }
  return found;
}

// A smaller size whose pixels are repeated changes its values at every second (third, fourth) boundary of pixels alone. A right
// picture has changes at all of them.
struct Repeats {
  size_t changes = 0;
  size_t times = 1;  // how many pixels beside each other have one value; 1: no repetition was found
};

Repeats repeats_of(const CheckEvidence& e, bool along_rows) {
  // By chance 20 changes lie at one kind of boundary along rows, and 20 along columns, in one picture of 2^38. Long edges that lie
  // along the pixels do along one of both.
  constexpr size_t told = 20, most_times = 4;
  const Image<float>& v = e.frame.visibility;
  const int length = along_rows ? v.width : v.height, lines = along_rows ? v.height : v.width;
  std::array<size_t, 12> at_boundary{};  // by its number modulo 12, which 2, 3 and 4 divide
  Repeats found;
  for (int k = 0; k + 1 < length; ++k) {
    // An edge along the boundary is one change, however long it is.
    bool is_edge = false;
    for (int line = 0; line < lines; ++line) {
      const size_t i = along_rows ? v.index(k, line) : v.index(line, k);
      const size_t j = along_rows ? v.index(k + 1, line) : v.index(line, k + 1);
      // What has no light in the frame's own shader may be masked in the full size.
      const bool changes = e.counted[i] && e.counted[j] && v[i] != v[j];
      if (changes && !is_edge) ++found.changes, ++at_boundary[static_cast<size_t>(k) % at_boundary.size()];
      is_edge = changes;
    }
  }
  if (found.changes < told) return found;
  for (size_t times = 2; times <= most_times; ++times)
    for (size_t first = 0; first < times; ++first) {
      size_t there = 0;
      for (size_t k = first; k < at_boundary.size(); k += times) there += at_boundary[k];
      if (there == found.changes) found.times = times;
    }
  return found;
}

// ---- a picture of another time mixed in

// A part of one other picture that lies a few pixels away. Where both pictures show light or shadow alone, the value is off by
// that part, and it is off only there and on one side of every edge; a filter is off on both sides.
struct Ghost {
  size_t pixels = 0;  // corners of regions of one value, which is a little off 0 or 1
  double part = 0;    // by so much in the median
  double equal = 0;   // the share of them that is off by that
  // The share of them that is explained by light and shadow exchanged `shift` pixels away, and that of the opposite shift.
  int x = 0, y = 0;
  double explained = 0, opposite = 0;
  bool is_seen() const { return 2 * pixels >= enough && equal >= 0.5 && explained >= 0.8 && explained >= 3 * opposite; }
};
// most: the largest part that is asked for. A filter's values lie beside a small part.
Ghost ghost_of(const CheckEvidence& e, float most) {
  constexpr float least = 0.02f, same = 0.004f;
  constexpr int reach = 8;
  const Image<float>& v = e.frame.visibility;
  Ghost found;
  std::vector<std::array<int, 2>> places;
  std::vector<double> off;
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) {
      const float value = v.at(x, y), by = std::min(value, 1 - value);
      if (!e.counted.at(x, y) || !(by > least && by < most) || !is_corner(v, x, y)) continue;
      places.push_back({x, y});
      off.push_back(by);
    }
  found.pixels = places.size();
  if (2 * found.pixels < enough) return found;
  found.part = quantile(off, 0.5);
  const auto count = static_cast<double>(found.pixels);
  found.equal = static_cast<double>(std::count_if(off.begin(), off.end(),
                                                  [&](double by) { return std::abs(by - found.part) < same; })) /
                count;
  if (found.equal < 0.5) return found;  // nothing more is asked
  const auto explained = [&](int dx, int dy) {
    size_t exchanged = 0;
    for (const auto& [x, y] : places)
      if (x + dx >= 0 && y + dy >= 0 && x + dx < v.width && y + dy < v.height)
        exchanged += v.at(x, y) > 0.5f ? v.at(x + dx, y + dy) < 0.5f : v.at(x + dx, y + dy) > 0.5f;
    return static_cast<double>(exchanged) / count;
  };
  double best = 0;
  const auto each_shift = [&](const auto& visit) {
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx)
        if (dx != 0 || dy != 0) visit(dx, dy, explained(dx, dy));
  };
  each_shift([&](int, int, double share) { best = std::max(best, share); });
  // The shortest of those that explain nearly as much: behind an edge all is dark, however far.
  int shortest = 4 * reach * reach;
  each_shift([&](int dx, int dy, double share) {
    if (share < 0.95 * best || dx * dx + dy * dy >= shortest) return;
    shortest = dx * dx + dy * dy;
    found.x = dx, found.y = dy, found.explained = share;
  });
  found.opposite = explained(-found.x, -found.y);
  return found;
}

// ---- a scene's grid on the pixels

// Whether the pixels where values change are of one width, so that a grid of the scene or of the map keeps its place among the
// pixels over the whole picture, as under an orthographic camera, or on a wall that faces the camera. Then a right lookup, too,
// changes at every second pixel alone, or in blocks of 8, or by one value on one side.
bool grid_may_lie_on_pixels(const CheckEvidence& e) {
  constexpr double least_drift_px = 2;
  const Image<float>& v = e.frame.visibility;
  std::vector<double> widths;
  for (int y = 0; y + 1 < v.height; ++y)
    for (int x = 0; x + 1 < v.width; ++x) {
      const size_t i = v.index(x, y);
      if (e.counted[i] && (v[i] != v.at(x + 1, y) || v[i] != v.at(x, y + 1))) widths.push_back(e.pixel_m[i]);
    }
  const double narrow = quantile(widths, 0.05), wide = quantile(std::move(widths), 0.95);
  return (wide / narrow - 1) * std::max(v.width, v.height) < least_drift_px;
}

// Whether the taps of the frame's filter make this part: several levels, that and others, are k / n.
bool is_of_filter(const CurveEvidence& curve, double part) {
  constexpr size_t several = 4;
  const int taps = curve.fits[0].taps;
  return curve.by_levels() == value_curves.data() && curve.levels.size() >= several &&
         std::abs(part * taps - std::round(part * taps)) < 0.02;
}

// What was done to the picture by the places of its pixels, if anything: what was found, and what the picture was.
struct DoneByPlaces {
  std::string found, cause;
};
std::optional<DoneByPlaces> done_by_places(const CheckEvidence& e, const CurveEvidence& curve) {
  if (const Blocks blocks = blocks_of(e); blocks.are_of_jpeg())
    return DoneByPlaces{fmt::format("values that are a little off lie in {} blocks of 8 x 8 pixels that begin in the "
                                    "picture's corner, and in {} of any that begin elsewhere",
                                    blocks.own, blocks.elsewhere),
                        "was a JPEG"};
  for (const bool along_rows : {true, false})
    if (const Steps steps = steps_of(e.frame.visibility, along_rows); steps.are_of_resizing())
      return DoneByPlaces{
          fmt::format(
              "along {} every second step from pixel to pixel is the mean of its neighbours ({} of {}, and {} of {})",
              along_rows ? "rows" : "columns", steps.mean[0], steps.count[0], steps.mean[1], steps.count[1]),
          "had half the size and was enlarged"};
  const Repeats along_rows = repeats_of(e, true), along_columns = repeats_of(e, false);
  if (const size_t times = std::min(along_rows.times, along_columns.times); times > 1)
    return DoneByPlaces{
        fmt::format("along rows and columns all {} and {} changes of a value lie at every {} boundary of pixels, and "
                    "none between",
                    along_rows.changes, along_columns.changes, std::array{"second", "third", "fourth"}[times - 2]),
        fmt::format("had {} the size, and its pixels are repeated",
                    std::array{"half", "a third of", "a quarter of"}[times - 2])};
  for (const float most : {0.25f, 0.5f})
    if (const Ghost ghost = ghost_of(e, most); ghost.is_seen() && !is_of_filter(curve, ghost.part))
      return DoneByPlaces{
          fmt::format("{} values are off 0 and 1 by {:.3f}, and {:.0f}% of them lie where the picture moved by ({:+d}, "
                      "{:+d}) pixels (x to the right, y down) has light and shadow exchanged, {:.0f}% the other way",
                      ghost.pixels, ghost.part, 100 * ghost.explained, -ghost.x, -ghost.y, 100 * ghost.opposite),
          "has another frame mixed in, as by temporal antialiasing"};
  return std::nullopt;
}

}  // namespace

Outcome check_samples(const CheckEvidence& e, const FrameStatistics& s) {
  constexpr const char* instead = "write each pixel's own sample, in a format without loss";
  const std::optional<DoneByPlaces> done = done_by_places(e, s.curve);
  if (done && !grid_may_lie_on_pixels(e))
    return failed(fmt::format("{}: the picture {}; {}", done->found, done->cause, instead));
  if (const OutlineAlignment::Ramps found = s.outlines.ramps(); found.of_blur())
    return failed(
        fmt::format("at {} of {} outlines between a lit and a shadowed surface the values pass over from one to the "
                    "other by less than half of their difference: the picture was blurred, as by motion; {}",
                    found.ramps, found.steps, instead));
  // Resolved multisampling mixes a quarter in at a mean pixel of an outline; right frames of wide filters have up to 0.08.
  constexpr double mixed = 0.1;
  const OutlineAlignment::Side outlines = s.outlines.all();
  const bool told = outlines.lit_inside >= OutlineAlignment::enough && outlines.dark_inside >= OutlineAlignment::enough;
  const std::string at_outlines = fmt::format(
      "at the outlines of surfaces, lit pixels are {:.3f} darker and shadowed ones {:.3f} lighter than their own "
      "surface {} pixels further",
      outlines.lit_pull, outlines.dark_pull, OutlineAlignment::inside_px);
  if (told && outlines.mixed(mixed))
    return failed(
        fmt::format("{}: values of several pixels were mixed, by multisampling or resizing, or the picture lies a "
                    "pixel beside its receivers; {}",
                    at_outlines, instead));
  if (done)
    return not_checked(fmt::format(
        "{}: the picture {}, or a grid of the scene or of the map lies on the pixels, which have one width here",
        done->found, done->cause));
  size_t deep = 0, between = 0;
  for (size_t i = 0; i < s.deep.size(); ++i) {
    deep += s.deep[i] != 0;
    between += s.deep[i] != 0 && e.frame.visibility[i] > 0.02f && e.frame.visibility[i] < 0.98f;
  }
  std::string says = "no trace of a JPEG, of half the size, or of another frame";
  if (100 * between > deep)
    says += fmt::format(
        "; {:.1f}% of the values far from true edges lie between 0 and 1: acne, a filtered map that leaks, "
        "or a blur",
        100 * static_cast<double>(between) / static_cast<double>(deep));
  if (told) return passed(fmt::format("{}; {}", says, at_outlines));
  return not_checked(
      fmt::format("{}; a blur or multisampling cannot be seen: {} lit and {} shadowed pixels lie at "
                  "outlines that tell it, and {} are needed",
                  says, outlines.lit_inside, outlines.dark_inside, OutlineAlignment::enough));
}

}  // namespace noonmark
