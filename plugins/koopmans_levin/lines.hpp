#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/error.hpp>
#include <optional>

namespace bodeflow::koopmans_levin {

using numerics::Expected;
using numerics::refused;

/// A set of lines k = first .. last of the DFT of N samples, both within 0 .. N-1: frequencies w_k = 2 pi k / N [rad/sample].
struct Band {
  Eigen::Index first = 0;
  Eigen::Index last = 0;
};

/// Spectra of an input and an output at the lines of a band, folded to the half spectrum of real data.
///
/// Transforms are unitary: X(k) = 1/sqrt(N) sum_t x(t) exp(-2 pi i k t / N), so white noise of variance v has E|X|^2 = v.
/// A line above N/2 is the conjugate of line N-k and counts as a further weight of that one: the full range has the weights
/// 1, 2, .., 2, 1, a band below N/2 has weights 1.
struct Lines {
  Eigen::Index samples = 0;  ///< N
  Eigen::VectorXi k;         ///< line numbers, ascending, 0 .. floor(N/2)
  Eigen::VectorXcd input;    ///< U
  Eigen::VectorXcd output;   ///< Y
  Eigen::VectorXd weight;    ///< 1 or 2

  Eigen::Index size() const { return k.size(); }
  double total_weight() const { return weight.sum(); }
  double omega(Eigen::Index line) const;                                    ///< rad/sample
  bool is_real(Eigen::Index line) const;                                    ///< line 0 or N/2, where a spectrum is real
  bool is_full_range() const { return total_weight() == double(samples); }  ///< all lines 0 .. N-1, each once
  Eigen::Index equations() const;                                           ///< real ones: 2 a line, 1 a real line
};

/// The lines of two records of equal length; the full range where no band is given.
/// Errors: lengths that differ, no samples, more than 2^30, a sample that is not finite (named), a band outside 0 .. N-1.
/// Cost: two real transforms.
Expected<Lines> lines_of(const Eigen::Ref<const Eigen::VectorXd>& input, const Eigen::Ref<const Eigen::VectorXd>& output,
                         std::optional<Band> band = std::nullopt);

/// The band of lines from the one nearest to low to the one nearest to high [rad/sample]: an end that was rounded, as 0.625 for
/// line 199 of 2000 samples, still means its line. Errors: not 0 <= low <= high <= pi; both ends between the same two lines.
Expected<Band> band_of(double low_rad, double high_rad, Eigen::Index samples);

/// Nothing, or the error that names the first sample that is not finite, or lengths that do not fit.
Expected<void> check_records(const Eigen::Ref<const Eigen::VectorXd>& input, const Eigen::Ref<const Eigen::VectorXd>& output);

}  // namespace bodeflow::koopmans_levin
