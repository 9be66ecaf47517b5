// Vectors of the numbers with error bounds (bounded.h), with which the host compiles the formulas a further time. They
// have the operations that the formulas use.
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

template <class Number>
struct Vector4 {
  Number x, y, z, w;
  constexpr Vector4() = default;
  // As GLSL writes it: vec4(x, y, z, w).
  constexpr Vector4(Number x0, Number y0, Number z0, Number w0) : x(x0), y(y0), z(z0), w(w0) {}

  friend Vector4 operator+(const Vector4& a, const Vector4& b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
  friend Vector4 operator*(Number s, const Vector4& v) { return {s * v.x, s * v.y, s * v.z, s * v.w}; }
};

}  // namespace noonmark
