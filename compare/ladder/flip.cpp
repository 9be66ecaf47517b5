#include "compare/ladder/flip.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "base/srgb.h"

namespace noonmark {
namespace {

constexpr double pi = std::numbers::pi;

// Names of constants and their values are the paper's.
constexpr double q_color = 0.7, q_feature = 0.5, p_color = 0.4, p_target = 0.95;
constexpr double feature_width_deg = 0.082;  // of the detector of edges and points

// sRGB's primaries and its white, D65.
const glm::dmat3& xyz_of_rgb() {
  static const glm::dmat3 m = glm::transpose(glm::dmat3(
      10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794, 2613072.0 / 12288897, 8788810.0 / 12288897,
      887015.0 / 12288897, 1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382));
  return m;
}
const glm::dvec3& white_xyz() {
  static const glm::dvec3 white = xyz_of_rgb() * glm::dvec3(1);
  return white;
}

// YCxCz, a linear form of CIELAB in which the eye's blur is applied (section 4.1.1).
glm::dvec3 ycxcz_of_rgb(glm::dvec3 linear) {
  const glm::dvec3 relative = xyz_of_rgb() * linear / white_xyz();
  return {116 * relative.y - 16, 500 * (relative.x - relative.y), 200 * (relative.y - relative.z)};
}
glm::dvec3 rgb_of_ycxcz(glm::dvec3 c) {
  static const glm::dmat3 rgb_of_xyz = glm::inverse(xyz_of_rgb());
  const double y = (c.x + 16) / 116;
  return rgb_of_xyz * (glm::dvec3(y + c.y / 500, y, y - c.z / 200) * white_xyz());
}

// CIELAB whose chroma is less in the dark (Hunt 1952).
glm::dvec3 hunt_lab(glm::dvec3 linear) {
  const auto f = [](double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const glm::dvec3 relative = xyz_of_rgb() * linear / white_xyz();
  const double fx = f(relative.x), fy = f(relative.y), fz = f(relative.z);
  const double lightness = 116 * fy - 16;
  return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

// HyAB (Abasi, Amani Tehran, Fairchild 2020), compressed.
double color_distance(glm::dvec3 a, glm::dvec3 b) {
  return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), q_color);
}

// Section 4.1.3: distances up to p_color of the largest one get the range up to p_target. The largest is that of green
// and blue.
double redistributed(double distance) {
  static const double largest = color_distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1}));
  const double middle = p_color * largest;
  return distance < middle ? distance * p_target / middle
                           : p_target + (distance - middle) / (largest - middle) * (1 - p_target);
}

// One factor of a separable filter: weight(i), i from -radius to radius.
struct Taps {
  std::vector<double> weights;
  int radius() const { return static_cast<int>(weights.size() / 2); }
};

template <class Weight>
Taps taps_of(int radius, const Weight& weight) {
  Taps taps;
  for (int i = -radius; i <= radius; ++i) taps.weights.push_back(weight(i));
  return taps;
}

// The eye's contrast sensitivity (table 1): of each channel a sum of Gaussians a sqrt(pi/b) exp(-pi^2 r^2 / b), r in
// degrees. Y and Cx have one, Cz two. The weights of a channel sum to 1.
struct Blur {
  int radius;
  Taps y, cx, cz_narrow, cz_wide;

  explicit Blur(double pixels_per_degree) {
    constexpr double widest = 0.04;
    radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
    const auto gaussian = [&](double b) {
      return [=](int i) {
        const double r = i / pixels_per_degree;
        return std::exp(-pi * pi * r * r / b);
      };
    };
    const auto sum = [&](double b) {
      double total = 0;
      for (int i = -radius; i <= radius; ++i) total += gaussian(b)(i);
      return total;
    };
    const auto normal = [&](double b, double weight) {
      const double scale = std::sqrt(weight) / sum(b);
      return taps_of(radius, [&](int i) { return scale * gaussian(b)(i); });
    };
    y = normal(0.0047, 1);
    cx = normal(0.0053, 1);
    constexpr double b1 = widest, b2 = 0.025;
    const double narrow = 13.5 * std::sqrt(pi / b2) * sum(b2) * sum(b2);
    const double wide = 34.1 * std::sqrt(pi / b1) * sum(b1) * sum(b1);
    cz_narrow = normal(b2, narrow / (narrow + wide));
    cz_wide = normal(b1, wide / (narrow + wide));
  }
};

// Detectors of edges and points (section 4.2): the first and second derivative of a Gaussian one way, the Gaussian the
// other way. Positive weights sum to 1 and negative ones to -1.
struct Features {
  Taps smooth, edge, point;

  explicit Features(double pixels_per_degree) {
    const double deviation = 0.5 * feature_width_deg * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto gaussian = [=](int i) { return std::exp(-i * i / (2 * deviation * deviation)); };
    const auto normal = [&](const auto& weight) {
      double positive = 0, negative = 0;
      for (int i = -radius; i <= radius; ++i) (weight(i) > 0 ? positive : negative) += std::abs(weight(i));
      return taps_of(radius, [&](int i) { return weight(i) / (weight(i) > 0 ? positive : negative); });
    };
    smooth = normal(gaussian);
    edge = normal([&](int i) { return -i * gaussian(i); });
    point = normal([&](int i) { return (i * i / (deviation * deviation) - 1) * gaussian(i); });
  }
};

// The picture is filtered in tiles, and a tile in strips of `lanes` columns. A filter also reads a margin around its tile. A margin
// outside the picture has the values of the picture's nearest pixels.
constexpr int tile_side = 64, lanes = 8, most_strips = tile_side / lanes;
using Lanes = std::array<double, lanes>;
// Two numbers of a vector register: compilers leave sums in registers so, and find no order of their own.
using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;
constexpr size_t pairs = lanes / 2;

// to[n] = the sum of weight[n][t] * from[n][t * step + lane] over all t in their order, of each lane. Several filters at a time,
// so that one addition need not wait for the last.
template <size_t filters>
void weighted_sums(const std::array<const Taps*, filters>& taps, const std::array<const double*, filters>& from,
                   size_t step, const std::array<Lanes*, filters>& to) {
  Pair sum[filters][pairs] = {};
  const size_t count = taps[0]->weights.size();
  for (size_t t = 0; t < count; ++t)
    for (size_t n = 0; n < filters; ++n) {
      const double weight = taps[n]->weights[t];
      for (size_t pair = 0; pair < pairs; ++pair) {
        Pair values;
        std::memcpy(&values, from[n] + t * step + 2 * pair, sizeof values);
        sum[n][pair] += weight * values;
      }
    }
  for (size_t n = 0; n < filters; ++n) std::memcpy(to[n]->data(), sum[n], sizeof *to[n]);
}

// What the eye gets of one pixel of a picture.
struct Seen {
  glm::dvec3 color;    // YCxCz
  double edge, point;  // strengths
};

// Which strips of a tile are to be computed, a byte for each row with a bit for each strip.
struct Wanted {
  std::array<uint8_t, tile_side>
      pixels{};                 // rows of the tile: the filters of a pixel read a difference of the pictures
  std::vector<uint8_t> differ;  // rows of the tile and its margin: the filters read a difference in this row
  std::vector<uint8_t> sums;    // the same rows: a pixel needs the sums along this row
};
static_assert(most_strips <= 8, "a strip is a bit of a byte");

class Evaluator {
 public:
  explicit Evaluator(double pixels_per_degree)
      : blur_(pixels_per_degree),
        features_(pixels_per_degree),
        margin_(std::max(blur_.radius, features_.edge.radius())),
        columns_(tile_side + 2 * margin_) {
    for (int v = 0; v < 256; ++v) linear_[static_cast<size_t>(v)] = srgb_decoded(static_cast<uint8_t>(v));
  }
  int margin() const { return margin_; }

  static std::unique_ptr<double[]> place_for(int count) {
    return std::make_unique_for_overwrite<double[]>(static_cast<size_t>(count));
  }
  // A tile of a picture with its margin, row by row.
  struct Planes {
    std::unique_ptr<double[]> y, cx, cz, brightness;  // brightness: Y from 0 to 1
    explicit Planes(int pixels)
        : y(place_for(pixels)), cx(place_for(pixels)), cz(place_for(pixels)), brightness(place_for(pixels)) {}
  };
  // The sums along the rows of one strip: the horizontal factor of each separable filter, for all rows of the tile and its margin.
  struct Rows {
    enum Sum { y, cx, cz_narrow, cz_wide, smooth, edge, point, count };
    std::array<std::vector<Lanes>, count> sums;
    explicit Rows(int rows) {
      for (auto& sum : sums) sum.resize(static_cast<size_t>(rows));
    }
    void copy(size_t row, const Rows& from) {
      for (size_t k = 0; k < count; ++k) sums[k][row] = from.sums[k][row];
    }
  };
  // What a thread computes with, for one tile after the other.
  struct Scratch {
    Wanted wanted;
    Planes a, b;
    Rows rows_a, rows_b;
  };
  Scratch scratch() const {
    const int pixels = columns_ * columns_;
    return {{}, Planes(pixels), Planes(pixels), Rows(columns_), Rows(columns_)};
  }

  // Sets the errors of the tile's pixels, where they are not 0.
  void evaluate(const Image<glm::u8vec3>& reference, const Image<glm::u8vec3>& test, glm::ivec2 corner,
                Scratch& scratch, Image<float>& error) const {
    const int height = std::min(tile_side, test.height - corner.y), width = std::min(tile_side, test.width - corner.x);
    auto& [wanted, a, b, rows_a, rows_b] = scratch;
    if (!list_wanted(reference, test, corner, width, height, wanted)) return;
    fill(a, reference, corner, wanted.sums);
    fill(b, test, corner, wanted.differ);
    const size_t rows = wanted.sums.size();
    for (int strip = 0; strip * lanes < width; ++strip) {
      const auto has = [&](uint8_t strips) { return (strips >> strip & 1) != 0; };
      for (size_t row = 0; row < rows; ++row) {
        if (!has(wanted.sums[row])) continue;
        sum_row(a, row, strip, rows_a);
        if (has(wanted.differ[row]))
          sum_row(b, row, strip, rows_b);
        else
          rows_b.copy(row, rows_a);
      }
      for (int y = 0; y < height; ++y) {
        if (!has(wanted.pixels[static_cast<size_t>(y)])) continue;
        const auto seen_a = see(rows_a, y), seen_b = see(rows_b, y);
        for (int lane = 0; lane < std::min(lanes, width - strip * lanes); ++lane) {
          if (seen_a.same_at(seen_b, lane)) continue;  // no error: the filters read nothing that differs
          error.at(corner.x + strip * lanes + lane, corner.y + y) = error_of(seen_a(lane), seen_b(lane));
        }
      }
    }
  }

 private:
  struct SeenLanes {
    enum Sum { y, cx, cz_narrow, cz_wide, edge_across, edge_down, point_across, point_down, count };
    std::array<Lanes, count> sums;
    bool same_at(const SeenLanes& other, int at) const {
      const auto lane = static_cast<size_t>(at);
      for (size_t k = 0; k < count; ++k)
        if (sums[k][lane] != other.sums[k][lane]) return false;
      return true;
    }
    Seen operator()(int at) const {
      const auto lane = static_cast<size_t>(at);
      return {{sums[y][lane], sums[cx][lane], sums[cz_wide][lane] + sums[cz_narrow][lane]},
              std::hypot(sums[edge_across][lane], sums[edge_down][lane]),
              std::hypot(sums[point_across][lane], sums[point_down][lane])};
    }
  };

  // False where the filters of no pixel read a difference.
  bool list_wanted(const Image<glm::u8vec3>& reference, const Image<glm::u8vec3>& test, glm::ivec2 corner, int width,
                   int height, Wanted& wanted) const {
    const int strips = (width + lanes - 1) / lanes, rows = height + 2 * margin_;
    wanted.differ.assign(static_cast<size_t>(rows), 0);
    wanted.sums.assign(static_cast<size_t>(rows), 0);
    wanted.pixels.fill(0);
    const int left = std::max(0, corner.x - margin_), right = std::min(corner.x + width + margin_, test.width);
    const int top = corner.y - margin_;
    bool any = false;
    for (int y = std::max(0, top); y < std::min(top + rows, test.height); ++y) {
      uint8_t& differ = wanted.differ[static_cast<size_t>(y - top)];
      const glm::u8vec3 *one = &reference.at(0, y), *other = &test.at(0, y);
      if (std::equal(one + left, one + right, other + left)) continue;
      for (int x = left; x < right; ++x) {
        if (one[x] == other[x]) continue;
        // A strip reads the columns from its first, less the margin, to its last and the margin.
        const int column = x - corner.x;
        for (int strip = 0; strip < strips; ++strip)
          if (strip * lanes - margin_ <= column && column < (strip + 1) * lanes + margin_)
            differ = static_cast<uint8_t>(differ | 1 << strip);
      }
      any |= differ != 0;
    }
    if (!any) return false;
    // The rows outside the picture are those of its border.
    for (int row = 0; row < rows; ++row)
      wanted.differ[static_cast<size_t>(row)] =
          wanted.differ[static_cast<size_t>(std::clamp(top + row, 0, test.height - 1) - top)];
    for (int y = 0; y < height; ++y) {
      uint8_t& pixels = wanted.pixels[static_cast<size_t>(y)];
      for (int row = y; row <= y + 2 * margin_; ++row)
        pixels = static_cast<uint8_t>(pixels | wanted.differ[static_cast<size_t>(row)]);
      for (int row = y; pixels != 0 && row <= y + 2 * margin_; ++row) {
        uint8_t& sums = wanted.sums[static_cast<size_t>(row)];
        sums = static_cast<uint8_t>(sums | pixels);
      }
    }
    return true;
  }

  // strips: by row, those whose columns and margins are read.
  void fill(Planes& planes, const Image<glm::u8vec3>& picture, glm::ivec2 corner,
            const std::vector<uint8_t>& strips) const {
    for (size_t row = 0; row < strips.size(); ++row) {
      const int y = std::clamp(corner.y - margin_ + static_cast<int>(row), 0, picture.height - 1);
      int column = 0;
      for (int strip = 0; strip < most_strips; ++strip) {
        if (!(strips[row] >> strip & 1)) continue;
        for (column = std::max(column, strip * lanes); column < (strip + 1) * lanes + 2 * margin_; ++column) {
          const glm::u8vec3 here = picture.at(std::clamp(corner.x - margin_ + column, 0, picture.width - 1), y);
          const glm::dvec3 color = ycxcz_of_rgb({linear_[here.x], linear_[here.y], linear_[here.z]});
          const size_t i = row * static_cast<size_t>(columns_) + static_cast<size_t>(column);
          planes.y[i] = color.x, planes.cx[i] = color.y, planes.cz[i] = color.z;
          planes.brightness[i] = (color.x + 16) / 116;
        }
      }
    }
  }

  void sum_row(const Planes& planes, size_t row, int strip, Rows& rows) const {
    const size_t start = row * static_cast<size_t>(columns_) + static_cast<size_t>(strip * lanes + margin_);
    const auto sum = [&](auto... parts) {
      weighted_sums<sizeof...(parts)>({std::get<0>(parts)...},
                                      {std::get<1>(parts) + start - std::get<0>(parts)->radius()...}, 1,
                                      {&rows.sums[std::get<2>(parts)][row]...});
    };
    sum(std::tuple(&blur_.y, planes.y.get(), Rows::y), std::tuple(&blur_.cx, planes.cx.get(), Rows::cx));
    sum(std::tuple(&blur_.cz_narrow, planes.cz.get(), Rows::cz_narrow),
        std::tuple(&blur_.cz_wide, planes.cz.get(), Rows::cz_wide));
    sum(std::tuple(&features_.smooth, planes.brightness.get(), Rows::smooth),
        std::tuple(&features_.edge, planes.brightness.get(), Rows::edge));
    sum(std::tuple(&features_.point, planes.brightness.get(), Rows::point));
  }

  // y: a row of the tile.
  SeenLanes see(const Rows& rows, int y) const {
    SeenLanes seen;
    const auto sum = [&](auto... parts) {
      weighted_sums<sizeof...(parts)>(
          {std::get<0>(parts)...},
          {rows.sums[std::get<1>(parts)][static_cast<size_t>(y + margin_ - std::get<0>(parts)->radius())].data()...},
          lanes, {&seen.sums[std::get<2>(parts)]...});
    };
    sum(std::tuple(&blur_.y, Rows::y, SeenLanes::y), std::tuple(&blur_.cx, Rows::cx, SeenLanes::cx));
    sum(std::tuple(&blur_.cz_narrow, Rows::cz_narrow, SeenLanes::cz_narrow),
        std::tuple(&blur_.cz_wide, Rows::cz_wide, SeenLanes::cz_wide));
    sum(std::tuple(&features_.smooth, Rows::edge, SeenLanes::edge_across),
        std::tuple(&features_.edge, Rows::smooth, SeenLanes::edge_down));
    sum(std::tuple(&features_.smooth, Rows::point, SeenLanes::point_across),
        std::tuple(&features_.point, Rows::smooth, SeenLanes::point_down));
    return seen;
  }

  static float error_of(const Seen& a, const Seen& b) {
    const auto lab = [](const Seen& seen) { return hunt_lab(glm::clamp(rgb_of_ycxcz(seen.color), 0.0, 1.0)); };
    const double color = redistributed(color_distance(lab(a), lab(b)));
    const double feature =
        std::pow(std::max(std::abs(a.edge - b.edge), std::abs(a.point - b.point)) / std::numbers::sqrt2, q_feature);
    return static_cast<float>(std::pow(color, 1 - feature));
  }

  Blur blur_;
  Features features_;
  int margin_, columns_;
  std::array<double, 256> linear_;
};

}  // namespace

int flip_reach(double pixels_per_degree) { return Evaluator(pixels_per_degree).margin(); }

Flip flip(const Image<glm::u8vec3>& reference, const Image<glm::u8vec3>& test, double pixels_per_degree) {
  if (reference.width != test.width || reference.height != test.height)
    throw std::logic_error("FLIP compares pictures of one size");
  Flip result{.mean = std::numeric_limits<double>::quiet_NaN(), .error = Image<float>(test.width, test.height, 0)};
  if (test.size() == 0) return result;
  const Evaluator evaluator(pixels_per_degree);
  const int across = (test.width + tile_side - 1) / tile_side, down = (test.height + tile_side - 1) / tile_side;
  tbb::enumerable_thread_specific<Evaluator::Scratch> scratch([&] { return evaluator.scratch(); });
  tbb::parallel_for(tbb::blocked_range<int>(0, across * down, 1), [&](const tbb::blocked_range<int>& range) {
    Evaluator::Scratch& mine = scratch.local();
    for (int tile = range.begin(); tile != range.end(); ++tile) {
      evaluator.evaluate(reference, test, glm::ivec2(tile % across, tile / across) * tile_side, mine, result.error);
    }
  });
  double sum = 0;  // in the pixels' order, so that it is the same on every machine
  for (const float error : result.error.pixels) sum += error;
  result.mean = sum / static_cast<double>(test.size());
  return result;
}

}  // namespace noonmark
