#pragma once
// Pack<T, W>: W numbers in one vector register, over the compiler's vector extensions. Invisible to
// nvcc. Every operation is IEEE per lane, so the bits do not depend on W. Contraction is off: fma()
// is explicit.
#if !defined(__CUDACC__)
#include <immintrin.h>

#include <cstring>

#include "base/lane.h"

namespace fabrica {

template <class T>
struct IntOf;
template <>
struct IntOf<float> {
  using type = std::int32_t;
};
template <>
struct IntOf<double> {
  using type = std::int64_t;
};

template <class T, int W>
struct Mask {
  typedef typename IntOf<T>::type Vec __attribute__((vector_size(sizeof(T) * W)));
  Vec v;
};

template <class T, int W>
struct Pack {
  typedef T Vec __attribute__((vector_size(sizeof(T) * W)));
  typedef typename IntOf<T>::type IntVec __attribute__((vector_size(sizeof(T) * W)));
  Vec v;

  Pack() = default;
  FABRICA_FN Pack(Vec x) : v(x) {}
  FABRICA_FN Pack(float s) : v(T(s) - Vec{}) {}
  FABRICA_FN Pack(double s) : v(T(s) - Vec{}) {}
  FABRICA_FN Pack(int s) : v(T(s) - Vec{}) {}

  // p must be aligned to the vector size
  FABRICA_FN static Pack load(const T* p) { return Pack(*reinterpret_cast<const Vec*>(p)); }
  FABRICA_FN void store(T* p) const { *reinterpret_cast<Vec*>(p) = v; }

  FABRICA_FN Pack operator-() const { return Pack(-v); }
  FABRICA_FN Pack& operator+=(Pack b) { return v += b.v, *this; }
  FABRICA_FN Pack& operator-=(Pack b) { return v -= b.v, *this; }
  FABRICA_FN Pack& operator*=(Pack b) { return v *= b.v, *this; }
  FABRICA_FN Pack& operator/=(Pack b) { return v /= b.v, *this; }
  FABRICA_FN friend Pack operator+(Pack a, Pack b) { return Pack(a.v + b.v); }
  FABRICA_FN friend Pack operator-(Pack a, Pack b) { return Pack(a.v - b.v); }
  FABRICA_FN friend Pack operator*(Pack a, Pack b) { return Pack(a.v * b.v); }
  FABRICA_FN friend Pack operator/(Pack a, Pack b) { return Pack(a.v / b.v); }
  FABRICA_FN friend Mask<T, W> operator<(Pack a, Pack b) { return {a.v < b.v}; }
  FABRICA_FN friend Mask<T, W> operator>(Pack a, Pack b) { return {a.v > b.v}; }
  FABRICA_FN friend Mask<T, W> operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
  FABRICA_FN friend Mask<T, W> operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
  FABRICA_FN friend Mask<T, W> operator==(Pack a, Pack b) { return {a.v == b.v}; }
  FABRICA_FN friend Mask<T, W> operator!=(Pack a, Pack b) { return {a.v != b.v}; }
};

template <class T, int W>
struct LaneTraits<Pack<T, W>> {
  using Scalar = T;
  using Mask = fabrica::Mask<T, W>;
  using Int = typename Pack<T, W>::IntVec;
  static constexpr int width = W;
};

template <class T, int W>
FABRICA_FN Mask<T, W> operator&(Mask<T, W> a, Mask<T, W> b) {
  return {a.v & b.v};
}
template <class T, int W>
FABRICA_FN Mask<T, W> operator|(Mask<T, W> a, Mask<T, W> b) {
  return {a.v | b.v};
}
template <class T, int W>
FABRICA_FN Mask<T, W> operator!(Mask<T, W> a) {
  return {~a.v};
}
template <class T, int W>
FABRICA_FN bool any(Mask<T, W> m) {
  typename Mask<T, W>::Vec z{};
  return std::memcmp(&m.v, &z, sizeof z) != 0;
}
template <class T, int W>
FABRICA_FN bool all(Mask<T, W> m) {
  return !any(!m);
}

template <class T, int W>
FABRICA_FN Pack<T, W> select(Mask<T, W> m, Pack<T, W> a, Pack<T, W> b) {
  return Pack<T, W>(m.v ? a.v : b.v);
}
template <class T, int W>
FABRICA_FN Pack<T, W> min(Pack<T, W> a, Pack<T, W> b) {
  return Pack<T, W>(a.v < b.v ? a.v : b.v);
}
template <class T, int W>
FABRICA_FN Pack<T, W> max(Pack<T, W> a, Pack<T, W> b) {
  return Pack<T, W>(a.v > b.v ? a.v : b.v);
}
template <class T, int W>
FABRICA_FN Pack<T, W> abs(Pack<T, W> a) {
  using I = typename Pack<T, W>::IntVec;
  const I bits = (I)a.v;
  const auto sign = typename IntOf<T>::type(1) << (sizeof(T) * 8 - 1);
  return Pack<T, W>((typename Pack<T, W>::Vec)(bits & ~(I{} + sign)));
}
template <class T, int W>
FABRICA_FN T get(Pack<T, W> a, int i) {
  return a.v[i];
}
template <class T, int W>
FABRICA_FN void set(Pack<T, W>& a, int i, T x) {
  a.v[i] = x;
}

template <class T, int W>
FABRICA_FN Pack<T, W> fma(Pack<T, W> a, Pack<T, W> b, Pack<T, W> c) {
  using P = Pack<T, W>;
  if constexpr (sizeof(typename P::Vec) == 64) {
#ifdef __AVX512F__
    if constexpr (sizeof(T) == 4)
      return P((typename P::Vec)_mm512_fmadd_ps((__m512)a.v, (__m512)b.v, (__m512)c.v));
    else
      return P((typename P::Vec)_mm512_fmadd_pd((__m512d)a.v, (__m512d)b.v, (__m512d)c.v));
#endif
  } else if constexpr (sizeof(typename P::Vec) == 32) {
#ifdef __FMA__
    if constexpr (sizeof(T) == 4)
      return P((typename P::Vec)_mm256_fmadd_ps((__m256)a.v, (__m256)b.v, (__m256)c.v));
    else
      return P((typename P::Vec)_mm256_fmadd_pd((__m256d)a.v, (__m256d)b.v, (__m256d)c.v));
#endif
  }
  P r;
  for (int i = 0; i < W; ++i) r.v[i] = fma(a.v[i], b.v[i], c.v[i]);
  return r;
}

template <class T, int W>
FABRICA_FN Pack<T, W> sqrt(Pack<T, W> a) {
  using P = Pack<T, W>;
  if constexpr (sizeof(typename P::Vec) == 64) {
#ifdef __AVX512F__
    if constexpr (sizeof(T) == 4)
      return P((typename P::Vec)_mm512_sqrt_ps((__m512)a.v));
    else
      return P((typename P::Vec)_mm512_sqrt_pd((__m512d)a.v));
#endif
  } else if constexpr (sizeof(typename P::Vec) == 32) {
#ifdef __AVX__
    if constexpr (sizeof(T) == 4)
      return P((typename P::Vec)_mm256_sqrt_ps((__m256)a.v));
    else
      return P((typename P::Vec)_mm256_sqrt_pd((__m256d)a.v));
#endif
  }
  P r;
  for (int i = 0; i < W; ++i) r.v[i] = sqrt(a.v[i]);
  return r;
}

// Lanes of a native register of this machine.
#if defined(__AVX512F__)
inline constexpr int native_width = 64 / int(sizeof(Real));
#else
inline constexpr int native_width = 32 / int(sizeof(Real));
#endif
using RealPack = Pack<Real, native_width>;

}  // namespace fabrica
#endif
