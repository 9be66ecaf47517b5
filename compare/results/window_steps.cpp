#include "compare/results/window_steps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>

#include "compare/results/records.h"

namespace noonmark {
namespace {

struct WindowStep {
  float from, to;
};

// The first step that keeps the bound; the taps descend.
const WindowSteps::Step* first_within(const WindowSteps::Steps& steps, double taps, double bound) {
  const auto found =
      std::find_if(steps.begin(), steps.end(), [&](const auto& step) { return step.taps / taps <= bound; });
  return found == steps.end() ? nullptr : &*found;
}

// The last step that keeps the bound; the taps ascend.
const WindowSteps::Step* last_within(const WindowSteps::Steps& steps, double taps, double bound) {
  const auto beyond =
      std::find_if(steps.begin(), steps.end(), [&](const auto& step) { return !(step.taps / taps <= bound); });
  return beyond == steps.begin() ? nullptr : &*(beyond - 1);
}

// Seven bits a byte, the lowest first; the highest bit says that more follow.
void put(std::string& bytes, uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
  bytes += static_cast<char>(value);
}

class Bytes {
 public:
  explicit Bytes(const std::string& bytes) : bytes_(bytes) {}
  uint64_t take() {
    uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto byte = static_cast<unsigned char>(bytes_.at(at_++));
      value |= uint64_t{byte & 0x7fu} << shift;
      if (!(byte & 0x80)) return value;
    }
    throw std::runtime_error("a number of more than 64 bits");
  }
  double take_double() {
    if (bytes_.size() - at_ < sizeof(double)) throw std::runtime_error("a list of steps that is cut off");
    double value = 0;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  size_t left() const { return bytes_.size() - at_; }

 private:
  const std::string& bytes_;
  size_t at_ = 0;
};

bool whole(const WindowSteps::Step& step) {
  constexpr double exact = 9007199254740992.0;  // 2^53
  return step.taps >= 0 && step.taps < exact && step.taps == std::floor(step.taps);
}

// Signed differences as small numbers: 0, -1, 1, -2 ... become 0, 1, 2, 3 ...
uint64_t folded(int64_t value) { return (static_cast<uint64_t>(value) << 1) ^ static_cast<uint64_t>(value >> 63); }
int64_t unfolded(uint64_t value) { return static_cast<int64_t>(value >> 1) ^ -static_cast<int64_t>(value & 1); }

}  // namespace

void judge_window(BiasCurve& curve, const CauseBounds& bounds) {
  const WindowSteps& steps = curve.steps;
  if (steps.taps > 0 && !steps.can_judge(bounds))
    throw std::logic_error("bounds that the steps of a curve do not reach");
  static_cast<CauseBounds&>(curve) = bounds;
  curve.window_min_depth = curve.window_max_depth = std::nullopt;
  curve.window_min_worst_depth = curve.window_max_worst_depth = std::nullopt;
  if (!(steps.taps > 0)) return;
  // A bias of 1 in depth spans the whole map. A larger bias has no meaning.
  const auto most = static_cast<float>(1 / steps.unit_depth);
  const auto in_depth = [&](float amount) { return amount * steps.unit_depth; };
  const auto* least = first_within(steps.acne, steps.taps, bounds.acne_bound);
  const auto* end = last_within(steps.peter_panning, steps.taps, bounds.peter_panning_bound);
  if (least && end) {
    const float from = least->amount, to = end->amount == std::numeric_limits<float>::infinity()
                                               ? std::numeric_limits<float>::infinity()
                                               : std::nextafter(end->amount, -std::numeric_limits<float>::infinity());
    if (from <= to && from <= most) {
      curve.window_min_depth = in_depth(from);
      curve.window_max_depth = to >= most ? 1.0 : in_depth(to);
    }
  }
  const auto* least_worst = first_within(steps.acne_worst, steps.taps, bounds.acne_bound);
  const auto* end_worst = last_within(steps.peter_panning_worst, steps.taps, bounds.peter_panning_bound);
  if (least_worst && end_worst && least_worst->amount <= end_worst->amount) {
    curve.window_min_worst_depth = in_depth(least_worst->amount);
    curve.window_max_worst_depth = in_depth(end_worst->amount);
  }
}

std::string bytes_of_steps(const WindowSteps::Steps& steps) {
  const bool all_whole = std::all_of(steps.begin(), steps.end(), whole);
  std::string bytes;
  put(bytes, steps.size());
  put(bytes, all_whole);
  uint32_t before = 0;
  for (const WindowSteps::Step& step : steps) {
    const uint32_t bits =
        std::bit_cast<uint32_t>(step.amount);  // they ascend as the amounts do, which are not negative
    put(bytes, folded(int64_t{bits} - int64_t{before}));
    before = bits;
  }
  int64_t taps_before = 0;
  for (const WindowSteps::Step& step : steps) {
    if (all_whole) {
      const auto taps = static_cast<int64_t>(step.taps);
      put(bytes, folded(taps - taps_before));
      taps_before = taps;
    } else {
      char raw[sizeof step.taps];
      std::memcpy(raw, &step.taps, sizeof raw);
      bytes.append(raw, sizeof raw);
    }
  }
  return bytes;
}

WindowSteps::Steps steps_of_bytes(const std::string& bytes) {
  Bytes from(bytes);
  const uint64_t count = from.take();
  const bool all_whole = from.take() != 0;
  if (count > from.left()) throw std::runtime_error("a list of steps that is cut off");
  WindowSteps::Steps steps(count);
  int64_t before = 0;
  for (WindowSteps::Step& step : steps) {
    before = static_cast<int64_t>(static_cast<uint64_t>(before) + static_cast<uint64_t>(unfolded(from.take())));
    step.amount = std::bit_cast<float>(static_cast<uint32_t>(before));
  }
  uint64_t taps = 0;
  for (WindowSteps::Step& step : steps) {
    if (all_whole)
      step.taps = static_cast<double>(static_cast<int64_t>(taps += static_cast<uint64_t>(unfolded(from.take()))));
    else
      step.taps = from.take_double();
  }
  if (from.left() != 0) throw std::runtime_error("a list of steps with something behind it");
  return steps;
}

}  // namespace noonmark
