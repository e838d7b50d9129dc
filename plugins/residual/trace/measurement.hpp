#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "model/joint_model.hpp"
#include "trace/residual_views.hpp"

namespace bodeflow::residual {

/// What is left in one class, beside the noise.
struct ClassTest {
  std::string name;       ///< excited, odd, even, dc, skirts, peak; whiteness, input, input_square for given records
  double multiple = 0.0;  ///< root mean square of the residual over that of the noise
  double p = 1.0;         ///< probability of so much, or more, from noise alone
};

/// The error of a model on a record beside what the noise alone would leave, in MeasurementFacts::unit_of_error.
struct HeldOutError {
  double error = 0.0;                                        ///< root mean square of measured minus predicted
  double floor = std::numeric_limits<double>::quiet_NaN();   ///< expected from the noise alone; nan: unknown
  double highest = std::numeric_limits<double>::infinity();  ///< the noise alone stays below it with a probability of 99.9 %
  double lowest = 0.0;  ///< the noise alone falls below it with a probability of 1e-4: less is a leak of the measured output
  bool floor_known() const { return std::isfinite(floor); }
  bool at_floor() const { return error <= highest; }
  bool leak() const { return error < lowest; }
  /// What is not noise: sqrt(error^2 - floor^2), 0 below the floor; the error itself where the floor is unknown.
  double excess() const { return floor_known() ? std::sqrt(std::max(error * error - floor * floor, 0.0)) : error; }
};

/// How much better a model is than another on the same record.
struct Gain {
  /// Fall of minus twice the log likelihood: of chi2 where the floor is known; else n ln(s0^2 / s1^2) of the innovations of a
  /// noise model.
  double likelihood = 0.0;
  /// The same by blocks of the record, mean over deviation: guards against residuals that are more correlated than the noise
  /// model says. Infinite where the floor is known.
  double block_z = std::numeric_limits<double>::infinity();
  double excess_before = 0.0,
         excess_after = 0.0;  ///< of the squares over what noise leaves; the squares where the floor is unknown
};

/// What a measurement is, in words and numbers for the report.
struct MeasurementFacts {
  std::string name;  ///< "fit 1", "select" ...
  std::string input_name, output_name, input_unit, output_unit;
  std::string error_unit;  ///< of HeldOutError; "": that of the output
  std::string checksum;
  double sample_rate_hz = 0.0;  ///< 0 for a measured response
  Eigen::Index samples = 0;
  Eigen::Index periods = 0;  ///< averaged; 0 where not periodic
  double level = 0.0;        ///< root mean square of the input
  std::vector<double> known;

  const std::string& unit_of_error() const { return error_unit.empty() ? output_unit : error_unit; }
};

/// What a report draws of a residual: a spectrum, or a course in time.
struct ResidualPicture {
  std::string axis;                           ///< "frequency" or "time"
  Eigen::VectorXd at;                         ///< Hz or s
  Eigen::VectorXd measured, residual, noise;  ///< root mean square a line, or values; noise empty where unknown
  std::vector<std::int64_t> kind;             ///< a line each (Kind), empty for a course
};

/// What an effect changes in the residual of a record where it acts on the motion that was measured and does not change that
/// motion: a first look at laws that spares the simulation, exact for small effects and near it for greater ones.
class OpenLoop {
 public:
  virtual ~OpenLoop() = default;
  /// Rows of the residual, for the effect that `model` has beside those that the look was made for; the values of the others do
  /// not matter. Not finite outside of the domain.
  virtual Eigen::VectorXd change(const JointModel& model, const Eigen::VectorXd& values) const = 0;
};

/// One record of measurements, ready to be compared with models. Its length is fixed: residuals of different models can be
/// subtracted row by row.
class Measurement {
 public:
  virtual ~Measurement() = default;

  virtual const MeasurementFacts& facts() const = 0;
  virtual bool floor_known() const = 0;
  virtual Eigen::Index rows() const = 0;
  /// Measured minus predicted, in units of the noise's standard deviation (of the base residual where the floor is unknown), for
  /// `values` of the model's parameters as this record has them. Not finite outside of the domain. Amplitudes and phases of tones
  /// are eliminated inside: 2 of them a frequency.
  virtual Eigen::VectorXd residual(const JointModel& model, const Eigen::VectorXd& values) const = 0;
  /// Step of the coordinates of a fit (logarithms, or values over their scale) for differences that stand for derivatives of
  /// `residual` with that model: where it is only good to a part of that, greater than usual.
  virtual double difference_step(const JointModel& /*model*/) const { return 1e-5; }
  /// Parameters of its own that residual eliminates for that model.
  virtual Eigen::Index eliminated(const JointModel& model, const Eigen::VectorXd& values) const = 0;

  /// A part of the record that is enough for a quick search, in the same units; nullptr where the whole is hardly longer.
  virtual std::shared_ptr<const Measurement> excerpt() const { return nullptr; }

  /// The look at an effect beside that model, which leaves `residual` at those values; nullptr where the residual itself is as
  /// quick, or no such look is known. It refers to this measurement and to `model`.
  virtual std::unique_ptr<const OpenLoop> open_loop(const JointModel& /*model*/, const Eigen::VectorXd& /*values*/,
                                                    const Eigen::VectorXd& /*residual*/, const Addition& /*effect*/) const {
    return nullptr;
  }

  /// The same record with what its inputs most probably were, by what was measured of them and of the output together, for a
  /// model at these values; residuals keep their meaning. nullptr where the inputs are known, or the model can't be computed.
  virtual std::shared_ptr<const Measurement> with_likely_input(const JointModel& /*model*/,
                                                               const Eigen::VectorXd& /*values*/) const {
    return nullptr;
  }
  /// The same record with noise added to its inputs, as large as theirs is: of that draw, `sign` times. What a linear plant
  /// makes of it is added to the output. nullptr where the inputs are known.
  virtual std::shared_ptr<const Measurement> with_input_noise(std::uint64_t /*draw*/, double /*sign*/) const { return nullptr; }

  /// Tests by class. `jacobian` of the residual by the fit's coordinates and their `covariance`; `fitted`: the record was fitted.
  virtual std::vector<ClassTest> tests(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                                       const Eigen::MatrixXd& covariance, bool fitted) const = 0;
  virtual Gain gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after) const = 0;
  virtual HeldOutError error(const Eigen::VectorXd& residual) const = 0;
  virtual ResidualPicture picture(const Eigen::VectorXd& residual) const = 0;

  /// Over what `views` look at residuals, with a model that leaves `residual` at these values; empty where there is no course in
  /// time.
  virtual std::vector<SeenOver> signals(const JointModel& /*model*/, const Eigen::VectorXd& /*values*/,
                                        const Eigen::VectorXd& /*residual*/) const {
    return {};
  }
  /// What a report draws beside the picture, over signals of this record; empty where there is no course in time.
  virtual ResidualViews views(const Eigen::VectorXd& /*residual*/, const std::vector<SeenOver>& /*over*/) const { return {}; }
  /// The classes of `tests` in the unit of the error, those that are amounts; empty where the floor is unknown.
  virtual std::vector<ClassSize> class_sizes(const Eigen::VectorXd& /*residual*/) const { return {}; }

  /// What the record itself shows, in sentences: clipping, coarse steps of a converter, a trend.
  virtual std::vector<std::string> observations() const { return {}; }
  /// What a residual shows beside the tests, in sentences: where it goes with the input, feedback, a drift.
  virtual std::vector<std::string> remarks(const Eigen::VectorXd& /*residual*/) const { return {}; }

  /// For starts of base models: a response of each input, the declared hold and delay taken off.
  virtual std::vector<MeasuredResponse> response() const = 0;
  /// Adds to `s` what this record says with that base model and what it leaves: signal sizes, flows and deflections at the place
  /// (its name, kind and units are set), missing response, peaks, jumps. Larger sizes win; `missing` of the last record of the
  /// greatest level.
  virtual void say(const JointModel& base, const Eigen::VectorXd& values, std::size_t place, Situation& s) const = 0;
};
using Measurements = std::vector<std::shared_ptr<const Measurement>>;

}  // namespace bodeflow::residual
