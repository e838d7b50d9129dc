#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/stacked_qr.hpp>
#include <vector>

#include "data.hpp"

namespace bodeflow::sanathanan_koerner {

/// The columns that the numerators of all channels are made of, and what is left of a channel when they have taken their part.
class Elimination {
 public:
  /// columns: weighted basis functions at the lines, stacked (2 lines x n), for the weights `shared`; orthonormal: they are. They
  /// must outlive this. A channel with other weights, or columns that are not orthonormal, are factorised.
  Elimination(const Data& data, const Eigen::VectorXd& shared, const Eigen::MatrixXd& columns, bool orthonormal);

  /// What is left of some stacked columns, which must have the weights of the channel.
  void reduce(Eigen::Index channel, Eigen::MatrixXd& stacked) const;
  /// The coefficients of the columns that come nearest to a stacked column.
  Eigen::VectorXd coefficients(Eigen::Index channel, const Eigen::VectorXd& stacked) const;
  /// Weight of the channel over the shared one, at each line.
  Eigen::VectorXd ratio(Eigen::Index channel) const;

 private:
  const numerics::StackedQr& factor(Eigen::Index channel) const;

  Eigen::MatrixXd ratios_;                    // lines x 1 or channels
  Eigen::Map<const Eigen::MatrixXd> span_;    // the columns
  std::vector<numerics::StackedQr> factors_;  // of the channels' columns; empty: the span is orthonormal
};

/// The weights that all channels are given first: the root mean square over the channels.
Eigen::VectorXd shared_weights(const Data& data);

/// The triangle R with |R c|^2 = sum over the channels of |what is left of (factor_i columns c)|^2. factors: lines x channels,
/// with the ratios in them. extra: a further stacked column for each channel (2 lines x channels), or empty.
///
/// Cost: linear in the channels, O(channels * lines * n^2); each channel is reduced and folded into the triangle by a QR
/// factorisation. The numerators' own block is never factorised with it.
Eigen::MatrixXd condensed(const Elimination& elimination, const Eigen::MatrixXcd& factors, const Eigen::MatrixXd& columns,
                          const Eigen::MatrixXd& extra = {});

}  // namespace bodeflow::sanathanan_koerner
