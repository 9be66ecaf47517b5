// Formulas over the numbers of a point, as laws use them: "(k + 0.5) * texel_m * tan_deg(scene.theta_deg)".
//
//   Formula f("2 * texel_m");
//   f.names();                                             // {"texel_m"}
//   f.value([&](const std::string& name) { return metric_of(point, name); });
//
// Names are those of settings and metrics, with their dots and @, and any others for which the caller gives values.
// - Operators: + - * / ^, comparisons (1 or 0), && || and a ? b : c.
// - The constant pi.
// - Functions of radians: sin cos tan asin acos atan atan2; of degrees: sin_deg cos_deg tan_deg.
// - The arc tangent in degrees: atan_deg.
// - Other functions: hypot sqrt exp ln log2 log10 abs min max floor.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace noonmark {

class Formula {
 public:
  // Throws Error(usage) that quotes the formula and says where it is wrong.
  explicit Formula(const std::string& text);
  ~Formula();
  Formula(Formula&&) noexcept;
  Formula& operator=(Formula&&) noexcept;

  // Every name that needs a value. Each occurs once, in alphabetical order.
  const std::vector<std::string>& names() const;
  // Computed in double. NaN if the value of any name is NaN, even if the formula does not use it, and for an undefined
  // result (0 / 0).
  double value(const std::function<double(const std::string&)>& value_of) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace noonmark
