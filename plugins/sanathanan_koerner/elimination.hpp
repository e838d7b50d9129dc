#pragma once

#include <Eigen/Core>
#include <vector>

#include "data.hpp"

namespace bodeflow::sanathanan_koerner {

/// The columns that the numerators of all channels are made of, and what is left of a channel when they have taken their part.
class Elimination {
 public:
  /// columns: weighted basis functions at the lines, stacked (2 lines x n), for the weights `shared`; orthonormal: they are. A
  /// channel with other weights has its own copy, made orthonormal by QR.
  Elimination(const Data& data, const Eigen::VectorXd& shared, const Eigen::MatrixXd& columns, bool orthonormal);

  /// What is left of some stacked columns, which must have the weights of the channel.
  void reduce(Eigen::Index channel, Eigen::MatrixXd& stacked) const;
  /// The coefficients of the columns that come nearest to a stacked column.
  Eigen::VectorXd coefficients(Eigen::Index channel, const Eigen::VectorXd& stacked) const;
  /// Weight of the channel over the shared one, at each line.
  Eigen::VectorXd ratio(Eigen::Index channel) const;

 private:
  std::size_t at(Eigen::Index channel) const { return spans_.size() == 1 ? 0 : static_cast<std::size_t>(channel); }

  Eigen::MatrixXd ratios_;                  // lines x 1 or channels
  std::vector<Eigen::MatrixXd> spans_;      // orthonormal
  std::vector<Eigen::MatrixXd> triangles_;  // span * triangle = the channel's columns; empty: the identity
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
