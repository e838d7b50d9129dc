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
  // Samples, coefficients and states in memory.
  typedef double stored __attribute__((vector_size(8 * W), aligned(8 * W), may_alias));
  typedef double loose __attribute__((vector_size(8 * W), aligned(8), may_alias));
};

template <>
struct Wide<1> {
  typedef double type;
};

template <int... I>
struct Indices {};
template <int W>
struct UpTo;
template <>
struct UpTo<2> {
  using type = Indices<0, 1>;
};
template <>
struct UpTo<4> {
  using type = Indices<0, 1, 2, 3>;
};
template <>
struct UpTo<8> {
  using type = Indices<0, 1, 2, 3, 4, 5, 6, 7>;
};

// Where element i of `pick` comes from: below W from a, from W on from b.
constexpr int source(int W, bool whole, bool odd, int i) {
  const int unit = i / 2, place = i % 2;
  if (!whole) return 2 * unit + (odd ? 1 : 0) + place * W;
  const int half = W < 4 ? 1 : W / 4;  // units that come from a
  return (unit < half ? 0 : W) + 2 * (2 * (unit % half) + (odd ? 1 : 0)) + place;
}

template <int W, bool whole, bool odd, int... I>
[[gnu::always_inline]] inline void pick(const typename Wide<W>::type& a, const typename Wide<W>::type& b,
                                        typename Wide<W>::type& to, Indices<I...>) {
  to = __builtin_shufflevector(a, b, source(W, whole, odd, I)...);
}

// to <- halves of a and b. Pairs of elements stand in units of 128 bits: with `whole` the even (odd) units of a, then those of b;
// otherwise the even (odd) elements of a and b by turns. Instructions that stay within units are the quick ones.
template <int W, bool whole, bool odd>
[[gnu::always_inline]] inline void pick(const typename Wide<W>::type& a, const typename Wide<W>::type& b,
                                        typename Wide<W>::type& to) {
  pick<W, whole, odd>(a, b, to, typename UpTo<W>::type{});
}

// W x W values: column j of `row` becomes row j of `to`. First pairs of rows, then units at distances 2, 4, ...
template <int W>
[[gnu::always_inline]] inline void transpose_rows(typename Wide<W>::type* row, double* const* to) {
  using Loose = typename Wide<W>::loose;
  typename Wide<W>::type next[W];
  for (int i = 0; i < W; i += 2) {
    pick<W, false, false>(row[i], row[i + 1], next[i]);
    pick<W, false, true>(row[i], row[i + 1], next[i + 1]);
  }
  for (int distance = 2; distance < W; distance *= 2) {
    for (int i = 0; i < W; ++i) row[i] = next[i];
    for (int i = 0; i < W; ++i) {
      if ((i & distance) != 0) continue;
      pick<W, true, false>(row[i], row[i + distance], next[i]);
      pick<W, true, true>(row[i], row[i + distance], next[i + distance]);
    }
  }
  for (int i = 0; i < W; ++i) *reinterpret_cast<Loose*>(to[i]) = next[i];
}

template <int W>
[[gnu::always_inline]] inline void transpose_square(const double* const* from, double* const* to) {
  typename Wide<W>::type row[W];
  for (int i = 0; i < W; ++i) row[i] = *reinterpret_cast<const typename Wide<W>::loose*>(from[i]);
  transpose_rows<W>(row, to);
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

// A group of lanes during a tile.
struct Group {
  const double* coefficients;  // of the first section
  double* states;
  double* tile;       // [sample][lane]
  double* y[kLanes];  // where the outputs of the tile go
};

// y[lane][n] = tile[n][lane] for the samples begin .. end - 1, at most W of them.
template <int W>
[[gnu::always_inline]] inline void scatter(const Group& group, size begin, size end) {
  const double* from[W];
  double* to[W];
  for (size l = 0; l < kLanes; l += W) {
    if (end - begin < W) {
      for (size n = begin; n < end; ++n) {
        for (size i = l; i < l + W; ++i) group.y[i][n] = group.tile[n * kLanes + i];
      }
      continue;
    }
    for (int i = 0; i < W; ++i) {
      from[i] = group.tile + (begin + static_cast<size>(i)) * kLanes + l;
      to[i] = group.y[l + static_cast<size>(i)] + begin;
    }
    transpose_square<W>(from, to);
  }
}

enum Place { kInside = 0, kFirst = 1, kLast = 2 };

// W samples of the last section of groups of W lanes: the outputs go from the registers to their channels.
template <template <int> class Form, int W, int G, int P, class Coefficients, class States>
[[gnu::always_inline]] inline void run_square(const Group* groups, const Coefficients& c, States& s, size n,
                                              const double* shared) {
  using V = typename Wide<W>::type;
  using Stored = typename Wide<W>::stored;
  V out[G][W];
  for (int i = 0; i < W; ++i) {
    for (int g = 0; g < G; ++g) {
      V x = reinterpret_cast<const Stored*>(groups[g].tile)[n + static_cast<size>(i)];
      if (P & kFirst) x = shared[n + static_cast<size>(i)] - V{};
      Form<W>::step(c[g][0], s[g][0][0], s[g][0][1], x);
      out[g][i] = x;
    }
  }
  for (int g = 0; g < G; ++g) {
    double* to[W];
    for (int i = 0; i < W; ++i) to[i] = groups[g].y[i] + n;
    transpose_rows<W>(out[g], to);
  }
}

// One section of `G` groups over a tile, in place. Several groups at once hide the latency of the recursion. With kFirst all
// lanes take their input from `shared`, with kLast the outputs go to their channels, W samples at a time.
template <template <int> class Form, int W, int G, int P>
[[gnu::always_inline]] inline void run_section(const Group* groups, size section, size count, const double* shared) {
  using V = typename Wide<W>::type;
  using Stored = typename Wide<W>::stored;
  constexpr int kParts = static_cast<int>(kLanes) / W, kCoefficients = Form<W>::kCoefficients;
  V c[G][kParts][kCoefficients], s[G][kParts][2];
  for (int g = 0; g < G; ++g) {
    const Stored* from =
        reinterpret_cast<const Stored*>(groups[g].coefficients) + section * static_cast<size>(kCoefficients * kParts);
    const Stored* state = reinterpret_cast<const Stored*>(groups[g].states) + section * static_cast<size>(2 * kParts);
    for (int p = 0; p < kParts; ++p) {
      for (int i = 0; i < kCoefficients; ++i) c[g][p][i] = from[i * kParts + p];
      for (int i = 0; i < 2; ++i) s[g][p][i] = state[i * kParts + p];
    }
  }
  for (size n = 0; n < count; n += W) {
    const size end = n + W < count ? n + W : count;
    if (kParts == 1 && (P & kLast) && n + W <= count) {
      run_square<Form, W, G, P>(groups, c, s, n, shared);
      continue;
    }
    for (size m = n; m < end; ++m) {
      for (int g = 0; g < G; ++g) {
        Stored* tile = reinterpret_cast<Stored*>(groups[g].tile) + m * static_cast<size>(kParts);
        for (int p = 0; p < kParts; ++p) {
          V x = tile[p];
          if (P & kFirst) x = shared[m] - V{};
          Form<W>::step(c[g][p], s[g][p][0], s[g][p][1], x);
          tile[p] = x;
        }
      }
    }
    if (P & kLast) {
      for (int g = 0; g < G; ++g) scatter<W>(groups[g], n, end);
    }
  }
  for (int g = 0; g < G; ++g) {
    Stored* state = reinterpret_cast<Stored*>(groups[g].states) + section * static_cast<size>(2 * kParts);
    for (int p = 0; p < kParts; ++p) {
      for (int i = 0; i < 2; ++i) state[i * kParts + p] = s[g][p][i];
    }
  }
}

// Sets states that decayed to nothing to zero; false where one is not finite.
template <int W>
[[gnu::always_inline]] inline bool settle(double* states, size count) {
  using V = typename Wide<W>::type;
  using Stored = typename Wide<W>::stored;
  V wrong{};
  for (size i = 0; i < count; i += W) {
    Stored& state = *reinterpret_cast<Stored*>(states + i);
    const V s = state;
    wrong += s - s;
    state = ((s < kSilent) & (s > -kSilent)) ? V{} : s;
  }
  for (int i = 0; i < W; ++i) {
    if (!(wrong[i] == 0)) return false;
  }
  return true;
}

// `G` groups from group `first` on: a tile at a time, cut at the same samples of the stream whatever the calls are.
template <template <int> class Form, int W, int G>
[[gnu::always_inline]] inline bool run_groups(const Cascade& k, size first, size count, size position) {
  constexpr size kCoefficients = static_cast<size>(Form<W>::kCoefficients) * kLanes;
  alignas(64) double tile[G][kTile * kLanes];
  double unused[kTile];
  Group groups[G];
  const double* x[kLanes];
  const size last = k.sections - 1;
  bool finite = true;
  for (size n = 0; n < count;) {
    const size left = kTile - (position + n) % kTile;
    const size part = left < count - n ? left : count - n;
    for (int g = 0; g < G; ++g) {
      const size group = first + static_cast<size>(g), lane = group * kLanes;
      const size lanes = k.lanes - lane < kLanes ? k.lanes - lane : kLanes;
      groups[g].coefficients = k.coefficients + group * k.sections * kCoefficients;
      groups[g].states = k.states + group * k.sections * 2 * kLanes;
      groups[g].tile = tile[g];
      for (size l = 0; l < kLanes; ++l) groups[g].y[l] = l < lanes ? k.y[lane + l] + n : unused;
      if (k.shared_input) continue;
      for (size l = 0; l < lanes; ++l) x[l] = k.x[lane + l] + n;
      gather<W>(x, lanes, part, tile[g]);
    }
    const double* shared = k.x[0] + n;
    size section = 0;
    if (k.shared_input && last > 0) run_section<Form, W, G, kFirst>(groups, section++, part, shared);
    for (; section < last; ++section) run_section<Form, W, G, kInside>(groups, section, part, shared);
    if (k.shared_input && last == 0) {
      run_section<Form, W, G, kFirst | kLast>(groups, last, part, shared);
    } else {
      run_section<Form, W, G, kLast>(groups, last, part, shared);
    }
    if (part == left) finite = settle<W>(groups[0].states, G * k.sections * 2 * kLanes) && finite;
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
    if ((position + n + 1) % kTile == 0) finite = settle<2>(k.states, k.sections * 2 * kLanes) && finite;
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
