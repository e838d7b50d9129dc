#pragma once

#include <Eigen/Core>
#include <bodeflow/plant.hpp>
#include <string>
#include <vector>

namespace bodeflow::residual {

/// What a fit moves: logarithms of positive parameters and the others over their scale; first those that all records share, then
/// those of the first record's own, of the second's ...
class Coordinates {
 public:
  Coordinates() = default;
  Coordinates(std::vector<FitParameter> parameters, std::size_t records);

  const std::vector<FitParameter>& parameters() const { return parameters_; }
  std::size_t records() const { return records_; }
  Eigen::Index size() const { return shared_ + own_ * static_cast<Eigen::Index>(records_); }
  Eigen::Index shared() const { return shared_; }
  Eigen::Index own() const { return own_; }  ///< parameters that each record has for itself
  /// Where parameter `p` of that record stands.
  Eigen::Index index(std::size_t p, std::size_t record) const;
  bool is_logarithmic(Eigen::Index coordinate) const { return logarithmic_[static_cast<std::size_t>(coordinate)]; }
  bool is_shared(Eigen::Index coordinate) const { return coordinate < shared_; }
  std::size_t record_of(Eigen::Index own_coordinate) const { return static_cast<std::size_t>((own_coordinate - shared_) / own_); }

  Eigen::VectorXd values(const Eigen::VectorXd& coordinates, std::size_t record) const;
  /// The coordinates of the same values in every record.
  Eigen::VectorXd of(const Eigen::VectorXd& values) const;
  /// Replaces what concerns that record, the shared ones included.
  void put(const Eigen::VectorXd& values, std::size_t record, Eigen::VectorXd& coordinates) const;
  /// d value / d coordinate of each parameter.
  Eigen::VectorXd slopes(const Eigen::VectorXd& values) const;

 private:
  std::vector<FitParameter> parameters_;
  std::vector<Eigen::Index> place_;  ///< among the shared, or among the own ones
  std::vector<bool> logarithmic_;    ///< a coordinate each
  std::size_t records_ = 0;
  Eigen::Index shared_ = 0, own_ = 0;
};

/// The bound that a value is beyond, as "below 0 V"; "" inside. What is beyond by no more than `tolerance` counts as inside.
std::string beyond(const FitParameter& p, double value, double tolerance = 0.0);

}  // namespace bodeflow::residual
