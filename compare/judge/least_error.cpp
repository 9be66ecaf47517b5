#include "compare/judge/least_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace noonmark {
namespace {

struct Place {
  double x = 0, y = 0;
};
using Line = std::vector<Place>;  // ascending in x, y never rises

// From costs and errors to the places of the axes, and back.
class Axes {
 public:
  explicit Axes(std::span<const std::vector<CostAndError>> curves) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& curve : curves)
      for (const CostAndError& one : curve) {
        if (one.cost <= 0) log_cost_ = false;
        if (one.error > 0) least = std::min(least, one.error);
      }
    floor_ = std::isfinite(least) ? least / below_the_least : 1;
  }
  Place place(const CostAndError& one) const {
    return {log_cost_ ? std::log(one.cost) : one.cost, std::log(std::max(one.error, floor_))};
  }
  double cost(double x) const { return log_cost_ ? std::exp(x) : x; }

 private:
  bool log_cost_ = true;
  double floor_ = 1;
};

// The curve without what lies above a cheaper part of it.
Line falling(const std::vector<CostAndError>& curve, const Axes& axes) {
  Line places;
  for (const CostAndError& one : curve)
    if (std::isfinite(one.cost) && std::isfinite(one.error)) places.push_back(axes.place(one));
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  Line line;
  for (size_t i = 0; i < places.size(); ++i) {
    const Place to = places[i];
    if (line.empty()) {
      line.push_back(to);
      continue;
    }
    const double least = line.back().y;
    if (to.y >= least) {
      if (to.x > line.back().x) line.push_back({to.x, least});
      continue;
    }
    const Place from = places[i - 1];
    if (from.y > least) line.push_back({from.x + (to.x - from.x) * (from.y - least) / (from.y - to.y), least});
    line.push_back(to);
  }
  return line;
}

constexpr double nowhere = std::numeric_limits<double>::infinity();

double height(const Line& line, double x) {
  if (line.empty() || x < line.front().x) return nowhere;
  const auto after = std::upper_bound(line.begin(), line.end(), x, [](double v, const Place& p) { return v < p.x; });
  if (after == line.end()) return line.back().y;
  const Place& a = *(after - 1);
  return a.y + (after->y - a.y) * (x - a.x) / (after->x - a.x);
}

// The height just before x, for the end of an interval in which the line has no corner. Lines have no jumps but at their
// begin.
double height_before(const Line& line, double begin, double x) {
  return !line.empty() && line.front().x <= begin ? height(line, x) : nowhere;
}

class Envelope {
 public:
  explicit Envelope(std::vector<Line> lines) : lines_(std::move(lines)) {
    for (const Line& line : lines_)
      for (const Place& place : line) corners_.push_back(place.x);
    std::sort(corners_.begin(), corners_.end());
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  }

  std::vector<CheapestStretch> stretches() {
    for (size_t i = 0; i < corners_.size(); ++i) {
      take_lowest_at(corners_[i]);
      if (i + 1 < corners_.size()) follow(corners_[i], corners_[i + 1]);
    }
    return without_equals();
  }

 private:
  void begin(size_t curve, double x) { found_.push_back({curve, x}); }

  void take_lowest_at(double x) {
    size_t lowest = found_.empty() ? 0 : found_.back().curve;
    for (size_t i = 0; i < lines_.size(); ++i)
      if (height(lines_[i], x) < height(lines_[lowest], x) - rounding) lowest = i;
    if (found_.empty() || lowest != found_.back().curve) begin(lowest, x);
  }

  // Between two corners all lines are straight: from crossing to crossing.
  void follow(double x, const double end) {
    const double start = x;
    while (true) {
      const size_t now = found_.back().curve;
      const double y = height(lines_[now], x), y_end = height_before(lines_[now], start, end);
      std::optional<std::pair<double, double>> first;  // where it crosses, and how high it ends
      size_t next = now;
      for (size_t i = 0; i < lines_.size(); ++i) {
        const double from = height(lines_[i], x), to = height_before(lines_[i], start, end);
        if (i == now || !(to < y_end - rounding)) continue;
        const double above = std::max(0.0, from - y);
        const std::pair key(x + (end - x) * above / (above + (y_end - to)), to);
        if (!first || key < *first) first = key, next = i;
      }
      if (!first) return;
      x = first->first;
      begin(next, x);
      if (x >= end) return;
    }
  }

  // How much lower the curve is than another one at the most, between two places.
  double advantage(size_t curve, size_t over, double from, double to) const {
    double most = 0;
    const auto at = [&](double x) { most = std::max(most, height(lines_[over], x) - height(lines_[curve], x)); };
    at(from);
    if (std::isfinite(to)) at(to);
    for (double x : corners_)
      if (x > from && x < to) at(x);
    return most;
  }

  std::vector<CheapestStretch> without_equals() const {
    std::vector<CheapestStretch> kept;
    for (size_t i = 0; i < found_.size(); ++i) {
      const double to = i + 1 < found_.size() ? found_[i + 1].from : nowhere;
      const auto is_ahead = [&](size_t of) {
        return found_[i].curve != of &&
               advantage(found_[i].curve, of, found_[i].from, to) >= std::log(error_that_differs);
      };
      if (!kept.empty() && !is_ahead(kept.back().curve)) continue;
      // Curves that begin equal, or cross at a corner: a stretch without a length says nothing.
      if (!kept.empty() && kept.back().from == found_[i].from) kept.pop_back();
      if (kept.empty() || kept.back().curve != found_[i].curve) kept.push_back(found_[i]);
    }
    return kept;
  }

  static constexpr double rounding = 1e-12;  // of logarithms, which are below 100
  std::vector<Line> lines_;
  std::vector<double> corners_;
  std::vector<CheapestStretch> found_;
};

}  // namespace

std::vector<CheapestStretch> least_errors(std::span<const std::vector<CostAndError>> curves) {
  const Axes axes(curves);
  std::vector<Line> lines;
  for (const auto& curve : curves) lines.push_back(falling(curve, axes));
  std::vector<CheapestStretch> stretches = Envelope(std::move(lines)).stretches();
  for (CheapestStretch& one : stretches) one.from = axes.cost(one.from);
  return stretches;
}

}  // namespace noonmark
