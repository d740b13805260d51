#pragma once
// Three-component vectors and 3 x 3 matrices of any scalar, plain structs.

namespace alula {

// The scalar that a product of two scalars has: double * Dual is Dual.
template <class A, class B>
using Product = decltype(A{} * B{});

template <class T>
struct Vec3 {
  T x{}, y{}, z{};
};

template <class A, class B>
constexpr Vec3<Product<A, B>> operator+(const Vec3<A>& a, const Vec3<B>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class A, class B>
constexpr Vec3<Product<A, B>> operator-(const Vec3<A>& a, const Vec3<B>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class A, class B>
constexpr Vec3<Product<A, B>> operator*(const A& s, const Vec3<B>& v) {
  return {s * v.x, s * v.y, s * v.z};
}
template <class A, class B>
constexpr Product<A, B> dot(const Vec3<A>& a, const Vec3<B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class A, class B>
constexpr Vec3<Product<A, B>> cross(const Vec3<A>& a, const Vec3<B>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Rows of a 3 x 3 matrix.
template <class T>
struct Mat3 {
  Vec3<T> row[3];
};

template <class A, class B>
constexpr Vec3<Product<A, B>> operator*(const Mat3<A>& m, const Vec3<B>& v) {
  return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
}

template <class T>
constexpr T determinant(const Mat3<T>& m) {
  return dot(m.row[0], cross(m.row[1], m.row[2]));
}

// By cofactors. The caller has made sure that the determinant is not zero.
template <class T>
constexpr Mat3<T> inverse(const Mat3<T>& m) {
  const T k = T(1) / determinant(m);
  const Vec3<T> a = cross(m.row[1], m.row[2]);
  const Vec3<T> b = cross(m.row[2], m.row[0]);
  const Vec3<T> c = cross(m.row[0], m.row[1]);
  return {{{k * a.x, k * b.x, k * c.x}, {k * a.y, k * b.y, k * c.y}, {k * a.z, k * b.z, k * c.z}}};
}

}  // namespace alula
