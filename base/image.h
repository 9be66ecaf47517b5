// A plain two-dimensional array. Row 0 is the top row of a picture. Of a shadow map it is the row of the lowest v
// (OpenGL's order); the code that uses such an image says so.
#pragma once
#include <cassert>
#include <cstddef>
#include <vector>

namespace noonmark {

template <class T>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<T> pixels;  // width * height, row by row

  Image() = default;
  Image(int w, int h, T fill = T{})
      : width(w), height(h), pixels(static_cast<size_t>(w) * static_cast<size_t>(h), fill) {}

  size_t size() const { return pixels.size(); }
  size_t index(int x, int y) const {
    assert(x >= 0 && x < width && y >= 0 && y < height);
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  T& at(int x, int y) { return pixels[index(x, y)]; }
  const T& at(int x, int y) const { return pixels[index(x, y)]; }
  T& operator[](size_t i) { return pixels[i]; }
  const T& operator[](size_t i) const { return pixels[i]; }
};

}  // namespace noonmark
