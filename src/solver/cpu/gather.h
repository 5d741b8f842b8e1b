#pragma once
// Moves corner data between a tile's node records and packs: 128-bit loads and 4x4 transposes, no
// gather instructions. Lane i of a pack is element i of the (half) block.
#include "base/pack.h"
#include "solver/kernel.h"

namespace fabrica {

// x and v of one corner of W elements; index: W local node numbers
template <int W>
FABRICA_FN void gather(const NodeRecord* nodes, const std::uint16_t* index, Vec3<Pack<Real, W>>& x,
                       Vec3<Pack<Real, W>>& v) {
  using P = Pack<Real, W>;
#if defined(__AVX512F__)
  if constexpr (W == 16 && sizeof(Real) == 4) {
    auto row = [&](int k, int half) {
      auto at = [&](int lane) {
        return _mm_load_ps((const float*)nodes[index[lane]].value + 4 * half);
      };
      __m512 r = _mm512_castps128_ps512(at(k));
      r = _mm512_insertf32x4(r, at(k + 4), 1);
      r = _mm512_insertf32x4(r, at(k + 8), 2);
      return _mm512_insertf32x4(r, at(k + 12), 3);
    };
    const __m512 a0 = row(0, 0), a1 = row(1, 0), a2 = row(2, 0), a3 = row(3, 0);
    const __m512 b0 = row(0, 1), b1 = row(1, 1), b2 = row(2, 1), b3 = row(3, 1);
    const __m512d t0 = (__m512d)_mm512_unpacklo_ps(a0, a1),
                  t1 = (__m512d)_mm512_unpackhi_ps(a0, a1);
    const __m512d t2 = (__m512d)_mm512_unpacklo_ps(a2, a3),
                  t3 = (__m512d)_mm512_unpackhi_ps(a2, a3);
    const __m512d u0 = (__m512d)_mm512_unpacklo_ps(b0, b1),
                  u2 = (__m512d)_mm512_unpacklo_ps(b2, b3);
    using V = typename P::Vec;
    x.x = P((V)_mm512_unpacklo_pd(t0, t2)), x.y = P((V)_mm512_unpackhi_pd(t0, t2));
    x.z = P((V)_mm512_unpacklo_pd(t1, t3)), v.x = P((V)_mm512_unpackhi_pd(t1, t3));
    v.y = P((V)_mm512_unpacklo_pd(u0, u2)), v.z = P((V)_mm512_unpackhi_pd(u0, u2));
    return;
  }
#endif
  if constexpr (W == 8 && sizeof(Real) == 4) {
    auto row = [&](int k, int half) {
      auto at = [&](int lane) {
        return _mm_load_ps((const float*)nodes[index[lane]].value + 4 * half);
      };
      return _mm256_insertf128_ps(_mm256_castps128_ps256(at(k)), at(k + 4), 1);
    };
    const __m256 a0 = row(0, 0), a1 = row(1, 0), a2 = row(2, 0), a3 = row(3, 0);
    const __m256 b0 = row(0, 1), b1 = row(1, 1), b2 = row(2, 1), b3 = row(3, 1);
    const __m256d t0 = (__m256d)_mm256_unpacklo_ps(a0, a1),
                  t1 = (__m256d)_mm256_unpackhi_ps(a0, a1);
    const __m256d t2 = (__m256d)_mm256_unpacklo_ps(a2, a3),
                  t3 = (__m256d)_mm256_unpackhi_ps(a2, a3);
    const __m256d u0 = (__m256d)_mm256_unpacklo_ps(b0, b1),
                  u2 = (__m256d)_mm256_unpacklo_ps(b2, b3);
    using V = typename P::Vec;
    x.x = P((V)_mm256_unpacklo_pd(t0, t2)), x.y = P((V)_mm256_unpackhi_pd(t0, t2));
    x.z = P((V)_mm256_unpacklo_pd(t1, t3)), v.x = P((V)_mm256_unpackhi_pd(t1, t3));
    v.y = P((V)_mm256_unpacklo_pd(u0, u2)), v.z = P((V)_mm256_unpackhi_pd(u0, u2));
    return;
  }
  for (int i = 0; i < W; ++i) {
    const Real* r = nodes[index[i]].value;
    for (int k = 0; k < 3; ++k) x[k].v[i] = r[k], v[k].v[i] = r[3 + k];
  }
}

template <int W>
FABRICA_FN void gather_spin(const SpinRecord* spins, const std::uint16_t* index,
                            Vec3<Pack<Real, W>>& w) {
  using P = Pack<Real, W>;
#if defined(__AVX512F__)
  if constexpr (W == 16 && sizeof(Real) == 4) {
    auto row = [&](int k) {
      auto at = [&](int lane) { return _mm_load_ps((const float*)spins[index[lane]].value); };
      __m512 r = _mm512_castps128_ps512(at(k));
      r = _mm512_insertf32x4(r, at(k + 4), 1);
      r = _mm512_insertf32x4(r, at(k + 8), 2);
      return _mm512_insertf32x4(r, at(k + 12), 3);
    };
    const __m512 a0 = row(0), a1 = row(1), a2 = row(2), a3 = row(3);
    const __m512d t0 = (__m512d)_mm512_unpacklo_ps(a0, a1),
                  t1 = (__m512d)_mm512_unpackhi_ps(a0, a1);
    const __m512d t2 = (__m512d)_mm512_unpacklo_ps(a2, a3),
                  t3 = (__m512d)_mm512_unpackhi_ps(a2, a3);
    using V = typename P::Vec;
    w.x = P((V)_mm512_unpacklo_pd(t0, t2)), w.y = P((V)_mm512_unpackhi_pd(t0, t2));
    w.z = P((V)_mm512_unpacklo_pd(t1, t3));
    return;
  }
#endif
  for (int i = 0; i < W; ++i)
    for (int k = 0; k < 3; ++k) w[k].v[i] = spins[index[i]].value[k];
}

// W force vectors as rows of four Reals: out[lane][4]
template <int W>
FABRICA_FN void transpose_rows(const Vec3<Pack<Real, W>>& f, Real* out) {
#if defined(__AVX512F__)
  if constexpr (W == 16 && sizeof(Real) == 4) {
    const __m512 x = (__m512)f.x.v, y = (__m512)f.y.v, z = (__m512)f.z.v, o = _mm512_setzero_ps();
    const __m512d t0 = (__m512d)_mm512_unpacklo_ps(x, y), t1 = (__m512d)_mm512_unpackhi_ps(x, y);
    const __m512d t2 = (__m512d)_mm512_unpacklo_ps(z, o), t3 = (__m512d)_mm512_unpackhi_ps(z, o);
    const __m512d r[4] = {_mm512_unpacklo_pd(t0, t2), _mm512_unpackhi_pd(t0, t2),
                          _mm512_unpacklo_pd(t1, t3), _mm512_unpackhi_pd(t1, t3)};
    for (int k = 0; k < 4; ++k) {  // r[k]: lanes k, k + 4, k + 8, k + 12
      const __m512 q = (__m512)r[k];
      _mm_store_ps((float*)out + 4 * k, _mm512_castps512_ps128(q));
      _mm_store_ps((float*)out + 4 * (k + 4), _mm512_extractf32x4_ps(q, 1));
      _mm_store_ps((float*)out + 4 * (k + 8), _mm512_extractf32x4_ps(q, 2));
      _mm_store_ps((float*)out + 4 * (k + 12), _mm512_extractf32x4_ps(q, 3));
    }
    return;
  }
#endif
  for (int i = 0; i < W; ++i) {
    for (int k = 0; k < 3; ++k) out[4 * i + k] = f[k].v[i];
    out[4 * i + 3] = 0;
  }
}

FABRICA_FN void add_record(ForceRecord& sum, const Real* f) {
  if constexpr (sizeof(Real) == 4) {
    float* s = (float*)sum.value;
    _mm_store_ps(s, _mm_add_ps(_mm_load_ps(s), _mm_load_ps((const float*)f)));
  } else {
    for (int k = 0; k < 4; ++k) sum.value[k] += f[k];
  }
}

}  // namespace fabrica
