// Reads the bytes of an input as choices: numbers within limits, so that every input is valid.
#pragma once
#include <glm/glm.hpp>
#include <string>

namespace noonmark::fuzz {

// Takes numbers from the input, byte by byte. After the last byte all numbers are 0, so that every input is valid.
class Choices {
 public:
  explicit Choices(const std::string& bytes) : bytes_(bytes) {}
  unsigned byte() { return at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_++]) : 0; }
  int below(int n) { return static_cast<int>((n > 256 ? byte() << 8 | byte() : byte()) % static_cast<unsigned>(n)); }
  // A number in [0, 1], often one of the two ends.
  double fraction() {
    const unsigned value = byte() << 8 | byte();
    return value == 0xffff ? 1 : value / 65536.0;
  }
  double between(double a, double b) { return a + (b - a) * fraction(); }

 private:
  const std::string& bytes_;
  size_t at_ = 0;
};

inline glm::dvec3 any_point(Choices& choices, double reach) {
  const double x = choices.between(-reach, reach), y = choices.between(-reach, reach);
  return {x, y, choices.between(-reach, reach)};
}

}  // namespace noonmark::fuzz
