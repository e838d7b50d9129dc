// Includes nothing with inline functions: a copy of one compiled for a wide unit could end up being called on a processor without
// it.

#include "kernels.hpp"

namespace bodeflow::filters {
namespace {

using size = decltype(sizeof(0));

// A state below it, decayed from a signal, is on its way to the denormal numbers: 1e-308.
constexpr double kSilent = 1e-290;

template <int W>
struct Wide {
  typedef double type __attribute__((vector_size(8 * W), aligned(8 * W)));
  typedef double loose __attribute__((vector_size(8 * W), aligned(8)));
  typedef long long mask __attribute__((vector_size(8 * W)));
};

template <>
struct Wide<1> {
  typedef double type;
};

// to <- the elements of a and b by turns, of their first or of their second halves.
template <int W>
[[gnu::always_inline]] inline void interleave(const typename Wide<W>::type& a, const typename Wide<W>::type& b, bool second,
                                              typename Wide<W>::type& to) {
  typename Wide<W>::mask order;
  for (int i = 0; i < W / 2; ++i) {
    order[2 * i] = i + (second ? W / 2 : 0);
    order[2 * i + 1] = order[2 * i] + W;
  }
  to = __builtin_shuffle(a, b, order);
}

// W x W values: column j of `from` becomes row j of `to`. Interleaving the first half of the rows with the second half, log2 W
// times.
template <int W>
[[gnu::always_inline]] inline void transpose_square(const double* const* from, double* const* to) {
  typename Wide<W>::type row[W], next[W];
  for (int i = 0; i < W; ++i) row[i] = *reinterpret_cast<const typename Wide<W>::loose*>(from[i]);
  for (int stage = 1; stage < W; stage *= 2) {
    for (int i = 0; i < W / 2; ++i) {
      interleave<W>(row[i], row[i + W / 2], false, next[2 * i]);
      interleave<W>(row[i], row[i + W / 2], true, next[2 * i + 1]);
    }
    for (int i = 0; i < W; ++i) row[i] = next[i];
  }
  for (int i = 0; i < W; ++i) *reinterpret_cast<typename Wide<W>::loose*>(to[i]) = row[i];
}

// tile[n][lane] = x[lane][n].
template <int W>
[[gnu::always_inline]] inline void gather(const double* const* x, size lanes, size count, double* tile) {
  const double* from[W];
  double* to[W];
  for (size l = 0; l < kLanes; l += W) {
    size n = 0;
    for (; n + W <= count; n += W) {
      for (int i = 0; i < W; ++i) {
        const size lane = l + static_cast<size>(i);
        from[i] = x[lane < lanes ? lane : 0] + n;
        to[i] = tile + (n + static_cast<size>(i)) * kLanes + l;
      }
      transpose_square<W>(from, to);
    }
    for (; n < count; ++n) {
      for (size i = l; i < l + W; ++i) tile[n * kLanes + i] = x[i < lanes ? i : 0][n];
    }
  }
}

// y[lane][n] = tile[n][lane].
template <int W>
[[gnu::always_inline]] inline void scatter(const double* tile, size lanes, size count, double* const* y) {
  double unused[kTile];
  const double* from[W];
  double* to[W];
  for (size l = 0; l < lanes; l += W) {
    size n = 0;
    for (; n + W <= count; n += W) {
      for (int i = 0; i < W; ++i) {
        const size lane = l + static_cast<size>(i);
        from[i] = tile + (n + static_cast<size>(i)) * kLanes + l;
        to[i] = lane < lanes ? y[lane] + n : unused;
      }
      transpose_square<W>(from, to);
    }
    for (; n < count; ++n) {
      for (size i = l; i < l + W && i < lanes; ++i) y[i][n] = tile[n * kLanes + i];
    }
  }
}

// x <- y, one step of a section.
template <int W>
struct Direct {
  static constexpr int kCoefficients = 5;
  using V = typename Wide<W>::type;

  [[gnu::always_inline]] static void step(const V* c, V& s1, V& s2, V& x) {
    const V y = c[0] * x + s1;
    s1 = (c[1] * x + s2) - c[3] * y;
    s2 = c[2] * x - c[4] * y;
    x = y;
  }
};

template <int W>
struct Rotation {
  static constexpr int kCoefficients = 6;
  using V = typename Wide<W>::type;

  [[gnu::always_inline]] static void step(const V* c, V& x1, V& x2, V& u) {
    const V y = (c[3] * x1 + c[4] * x2) + c[5] * u;
    const V first = (c[0] * x1 - c[1] * x2) + c[2] * u;
    x2 = c[1] * x1 + c[0] * x2;
    x1 = first;
    u = y;
  }
};

// One section of `G` groups over a tile each, in place. Several groups at once hide the latency of the recursion.
template <template <int> class Form, int W, int G>
[[gnu::always_inline]] inline void run_section(const double* const* coefficients, double* const* states, double* const* tiles,
                                               size count) {
  using V = typename Wide<W>::type;
  constexpr int kParts = static_cast<int>(kLanes) / W, kCoefficients = Form<W>::kCoefficients;
  V c[G][kParts][kCoefficients], s[G][kParts][2];
  for (int g = 0; g < G; ++g) {
    for (int p = 0; p < kParts; ++p) {
      for (int i = 0; i < kCoefficients; ++i) c[g][p][i] = reinterpret_cast<const V*>(coefficients[g])[i * kParts + p];
      for (int i = 0; i < 2; ++i) s[g][p][i] = reinterpret_cast<const V*>(states[g])[i * kParts + p];
    }
  }
  for (size n = 0; n < count; ++n) {
    for (int g = 0; g < G; ++g) {
      V* tile = reinterpret_cast<V*>(tiles[g]) + n * static_cast<size>(kParts);
      for (int p = 0; p < kParts; ++p) Form<W>::step(c[g][p], s[g][p][0], s[g][p][1], tile[p]);
    }
  }
  for (int g = 0; g < G; ++g) {
    for (int p = 0; p < kParts; ++p) {
      for (int i = 0; i < 2; ++i) reinterpret_cast<V*>(states[g])[i * kParts + p] = s[g][p][i];
    }
  }
}

// Sets states that decayed to nothing to zero; false where one is not finite.
[[gnu::always_inline]] inline bool settle(double* states, size count) {
  double wrong = 0;
  for (size i = 0; i < count; ++i) {
    wrong += states[i] - states[i];
    states[i] = (states[i] < kSilent) & (states[i] > -kSilent) ? 0.0 : states[i];
  }
  return wrong == 0;
}

// `G` groups from group `first` on: a tile at a time, cut at the same samples of the stream whatever the calls are.
template <template <int> class Form, int W, int G>
[[gnu::always_inline]] inline bool run_groups(const Cascade& k, size first, size count, size position) {
  constexpr size kCoefficients = static_cast<size>(Form<W>::kCoefficients) * kLanes;
  alignas(64) double tile[G][kTile * kLanes];
  const double* c[G];
  double* s[G];
  double* t[G];
  const double* x[kLanes];
  double* y[kLanes];
  double* const states = k.states + first * k.sections * 2 * kLanes;
  bool finite = true;
  for (size n = 0; n < count;) {
    const size left = kTile - (position + n) % kTile;
    const size part = left < count - n ? left : count - n;
    for (int g = 0; g < G; ++g) {
      const size lane = (first + static_cast<size>(g)) * kLanes;
      const size lanes = k.lanes - lane < kLanes ? k.lanes - lane : kLanes;
      if (k.shared_input) {
        for (size m = 0; m < part; ++m) {
          for (size l = 0; l < kLanes; ++l) tile[g][m * kLanes + l] = k.x[0][n + m];
        }
      } else {
        for (size l = 0; l < lanes; ++l) x[l] = k.x[lane + l] + n;
        gather<W>(x, lanes, part, tile[g]);
      }
    }
    for (size section = 0; section < k.sections; ++section) {
      for (int g = 0; g < G; ++g) {
        const size place = (first + static_cast<size>(g)) * k.sections + section;
        c[g] = k.coefficients + place * kCoefficients;
        s[g] = k.states + place * 2 * kLanes;
        t[g] = tile[g];
      }
      run_section<Form, W, G>(c, s, t, part);
    }
    for (int g = 0; g < G; ++g) {
      const size lane = (first + static_cast<size>(g)) * kLanes;
      const size lanes = k.lanes - lane < kLanes ? k.lanes - lane : kLanes;
      for (size l = 0; l < lanes; ++l) y[l] = k.y[lane + l] + n;
      scatter<W>(tile[g], lanes, part, y);
    }
    if (part == left) finite = settle(states, G * k.sections * 2 * kLanes) && finite;
    n += part;
  }
  return finite;
}

// One lane alone: all sections of a sample, so that those of the next one overlap with them. `c` and `s` with the stride of a
// lane.
template <template <int> class Form>
[[gnu::always_inline]] inline bool run_single(const Cascade& k, size count, size position) {
  constexpr int kCoefficients = Form<1>::kCoefficients;
  bool finite = true;
  for (size n = 0; n < count; ++n) {
    double u = k.x[0][n];
    for (size section = 0; section < k.sections; ++section) {
      double c[kCoefficients];
      for (int i = 0; i < kCoefficients; ++i) {
        c[i] = k.coefficients[(section * static_cast<size>(kCoefficients) + static_cast<size>(i)) * kLanes];
      }
      double* const s = k.states + section * 2 * kLanes;
      Form<1>::step(c, s[0], s[kLanes], u);
    }
    k.y[0][n] = u;
    if ((position + n + 1) % kTile == 0) finite = settle(k.states, k.sections * 2 * kLanes) && finite;
  }
  return finite;
}

template <template <int> class Form, int W>
[[gnu::always_inline]] inline bool run_all(const Cascade& k, size count, size position) {
  if (k.lanes == 1) return run_single<Form>(k, count, position);
  const size groups = (k.lanes + kLanes - 1) / kLanes;
  bool finite = true;
  size g = 0;
  for (; g + 2 <= groups; g += 2) finite = run_groups<Form, W, 2>(k, g, count, position) && finite;
  if (g < groups) finite = run_groups<Form, W, 1>(k, g, count, position) && finite;
  return finite;
}

// Outputs n .. n + W U - 1.
template <int W, int U>
[[gnu::always_inline]] inline void fir_outputs(const double* h, size taps, const double* x, double* y) {
  using V = typename Wide<W>::type;
  V sum[U] = {};
  for (size j = 0; j < taps; ++j) {
    for (int u = 0; u < U; ++u) sum[u] += h[j] * *reinterpret_cast<const typename Wide<W>::loose*>(x - j + u * W);
  }
  for (int u = 0; u < U; ++u) *reinterpret_cast<typename Wide<W>::loose*>(y + u * W) = sum[u];
}

template <int W, int U>
[[gnu::always_inline]] inline void fir_all(const double* h, size taps, const double* x, double* y, size count) {
  size n = 0;
  for (; n + W * U <= count; n += W * U) fir_outputs<W, U>(h, taps, x + n, y + n);
  for (; n + W <= count; n += W) fir_outputs<W, 1>(h, taps, x + n, y + n);
  for (; n < count; ++n) {
    double sum = 0;
    for (size j = 0; j < taps; ++j) sum += h[j] * *(x + n - j);
    y[n] = sum;
  }
}

#if defined(__x86_64__)
#define BODEFLOW_V4 [[gnu::target("arch=x86-64-v4,prefer-vector-width=512")]]
#define BODEFLOW_V3 [[gnu::target("arch=x86-64-v3")]]

BODEFLOW_V4 bool run_direct_v4(const Cascade& k, size count, size position) { return run_all<Direct, 8>(k, count, position); }
BODEFLOW_V3 bool run_direct_v3(const Cascade& k, size count, size position) { return run_all<Direct, 4>(k, count, position); }
BODEFLOW_V4 bool run_rotations_v4(const Cascade& k, size count, size position) {
  return run_all<Rotation, 8>(k, count, position);
}
BODEFLOW_V3 bool run_rotations_v3(const Cascade& k, size count, size position) {
  return run_all<Rotation, 4>(k, count, position);
}
BODEFLOW_V4 void run_fir_v4(const double* h, size taps, const double* x, double* y, size count) {
  fir_all<8, 4>(h, taps, x, y, count);
}
BODEFLOW_V3 void run_fir_v3(const double* h, size taps, const double* x, double* y, size count) {
  fir_all<4, 8>(h, taps, x, y, count);
}
#endif

}  // namespace

bool run_direct(const Cascade& cascade, size count, size position, int vector_level) {
#if defined(__x86_64__)
  if (vector_level >= 4) return run_direct_v4(cascade, count, position);
  if (vector_level >= 3) return run_direct_v3(cascade, count, position);
#endif
  return run_all<Direct, 2>(cascade, count, position);
}

bool run_rotations(const Cascade& cascade, size count, size position, int vector_level) {
#if defined(__x86_64__)
  if (vector_level >= 4) return run_rotations_v4(cascade, count, position);
  if (vector_level >= 3) return run_rotations_v3(cascade, count, position);
#endif
  return run_all<Rotation, 2>(cascade, count, position);
}

void run_fir(const double* h, size taps, const double* x, double* y, size count, int vector_level) {
#if defined(__x86_64__)
  if (vector_level >= 4) return run_fir_v4(h, taps, x, y, count);
  if (vector_level >= 3) return run_fir_v3(h, taps, x, y, count);
#endif
  fir_all<2, 4>(h, taps, x, y, count);
}

}  // namespace bodeflow::filters
