// Vectors of the numbers with which the host compiles the formulas a further time: with error bounds (bounded.h) and
// with counters (counted.h). They have the operations that the formulas use.
#pragma once

namespace noonmark {

template <class Number>
struct Vector2 {
  Number x, y;
};

template <class Number>
struct Vector3 {
  Number x, y, z;

  friend Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector3 operator*(Number s, const Vector3& v) { return {s * v.x, s * v.y, s * v.z}; }
};

}  // namespace noonmark
