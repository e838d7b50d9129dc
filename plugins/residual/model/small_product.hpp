#pragma once

#include <vector>

namespace bodeflow::residual {

/// A small matrix as columns one after the other, their length rounded up to an even number.
struct SmallMatrix {
  int rows = 0, padded = 0, columns = 0;
  std::vector<double> data;

  SmallMatrix() = default;
  SmallMatrix(int r, int c)
      : rows(r), padded(r + r % 2), columns(c), data(static_cast<std::size_t>(padded) * static_cast<std::size_t>(c), 0.0) {}
  double& at(int r, int c) { return data[static_cast<std::size_t>(c * padded + r)]; }
  const double* column(int c) const { return data.data() + static_cast<std::size_t>(c * padded); }
};

/// The most rows a SmallMatrix is multiplied with in registers.
constexpr int kRegisterRows = 16;

template <int Rows>
inline void product_of(const SmallMatrix& m, const double* v, double* out) {
  double sum[Rows] = {};
  const double* a = m.data.data();
  for (int c = 0; c < m.columns; ++c, a += Rows)
    for (int r = 0; r < Rows; ++r) sum[r] += a[r] * v[c];
  for (int r = 0; r < Rows; ++r) out[r] = sum[r];
}

/// out = m v; `out` has room for the padded rows.
inline void product(const SmallMatrix& m, const double* v, double* out) {
  switch (m.padded) {
    case 2:
      return product_of<2>(m, v, out);
    case 4:
      return product_of<4>(m, v, out);
    case 6:
      return product_of<6>(m, v, out);
    case 8:
      return product_of<8>(m, v, out);
    case 10:
      return product_of<10>(m, v, out);
    case 12:
      return product_of<12>(m, v, out);
    case 14:
      return product_of<14>(m, v, out);
    case kRegisterRows:
      return product_of<kRegisterRows>(m, v, out);
    default:
      break;
  }
  for (int r = 0; r < m.padded; ++r) out[r] = 0.0;
  for (int c = 0; c < m.columns; ++c) {
    const double* a = m.column(c);
    for (int r = 0; r < m.padded; ++r) out[r] += a[r] * v[c];
  }
}

/// out += factor times a column of m.
inline void add_column(const SmallMatrix& m, int column, double factor, double* out) {
  const double* a = m.column(column);
  for (int r = 0; r < m.padded; ++r) out[r] += factor * a[r];
}

}  // namespace bodeflow::residual
