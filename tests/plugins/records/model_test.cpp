#include "records/model.hpp"

#include <cmath>

#include "catch.hpp"

using namespace bodeflow;
using records::ModelData;

namespace {

/// What a reader gets of the model.
Expected<ModelData> carried(const ModelData& m) {
  const auto bytes = records::write_model(m).bytes();
  return records::read_model(RecordView(bytes.data()));
}

ModelData example(double sample_time_s) {
  ModelData m;
  m.method = "test.model";
  m.form = "transfer_function";
  m.order = 2;
  m.sample_time_s = sample_time_s;
  m.delay_s = 1e-3;
  m.parameter_names = {"a1", "b0"};
  m.parameter_units = {"", "V"};
  m.parameters = Eigen::Vector2d(0.5, 2.0);
  m.covariance = Eigen::Vector2d(0.01, 0.04).asDiagonal();
  m.numerator = Eigen::Vector2d(2.0, 1.0);
  m.denominator = Eigen::Vector3d(1.0, -1.0, 0.89);
  m.poles = Eigen::Vector2cd(std::complex<double>(0.5, 0.8), std::complex<double>(0.5, -0.8));
  m.zeros = Eigen::VectorXcd::Constant(1, -0.5);
  m.pole_covariance = {Eigen::Vector2d(1e-4, 4e-4).asDiagonal(), Eigen::Vector2d(1e-4, 4e-4).asDiagonal()};
  m.input_unit = "V";
  m.conventions = {"amplitude-invariant Clarke"};
  m.warnings = {"few lines: measure longer"};
  m.cost = 10.0;
  m.band_hz = Eigen::Vector2d(1.0, 50.0);
  m.data_checksum = "0123456789abcdef";
  return m;
}

}  // namespace

TEST_CASE("model record: what is written is read") {
  for (const double sample_time_s : {0.0, 0.01}) {
    const ModelData m = example(sample_time_s);
    const auto read = carried(m);
    REQUIRE(read);
    CHECK(read->method == m.method);
    CHECK(read->order == 2);
    CHECK(read->sample_time_s == sample_time_s);
    CHECK(read->delay_s == 1e-3);
    CHECK(read->parameter_names == m.parameter_names);
    CHECK(read->parameters == m.parameters);
    CHECK(read->covariance == m.covariance);
    CHECK(read->numerator == m.numerator);
    CHECK(read->denominator == m.denominator);
    CHECK(read->poles == m.poles);
    CHECK(read->zeros == m.zeros);
    CHECK(read->conventions == m.conventions);
    CHECK(read->warnings == m.warnings);
    CHECK(read->cost == m.cost);
    CHECK_FALSE(read->aic);
    CHECK(*read->band_hz == *m.band_hz);
    CHECK(read->data_checksum == m.data_checksum);
  }
}

TEST_CASE("model record: poles of a discrete-time model stand in rad/s, with their covariance carried over") {
  const double T = 0.01;
  const ModelData m = example(T);
  const auto bytes = records::write_model(m).bytes();
  const RecordView record(bytes.data());
  const auto poles = record.array("poles")->as<std::complex<double>>();
  CHECK(record.array("poles")->unit == "rad/s");
  CHECK(std::abs(poles[0] - std::log(std::complex<double>(0.5, 0.8)) / T) < 1e-9);
  CHECK(record.array("z_poles")->as<std::complex<double>>()[0] == std::complex<double>(0.5, 0.8));
  // Against differences: s moves by ds = dz / (z T) for each of two independent errors of z.
  const auto covariance = record.array("pole_covariance");
  REQUIRE(covariance->shape.size() == 3);
  const auto c = covariance->as<double>();
  const std::complex<double> z(0.5, 0.8), dx = 0.01 / (z * T), dy = std::complex<double>(0.0, 0.02) / (z * T);
  CHECK(c[0] == Approx(dx.real() * dx.real() + dy.real() * dy.real()));
  CHECK(c[1] == Approx(dx.real() * dx.imag() + dy.real() * dy.imag()));
  CHECK(c[3] == Approx(dx.imag() * dx.imag() + dy.imag() * dy.imag()));
}

TEST_CASE("model record: what does not fit is refused by name") {
  const auto reason = [](auto change) {
    ModelData m = example(0.0);
    change(m);
    const auto read = carried(m);
    return read ? std::string("read") : read.error().text;
  };
  CHECK(reason([](ModelData& m) { m.parameter_names.pop_back(); }) == "attribute 'parameter_names' has 1 names for 2 parameters");
  CHECK(reason([](ModelData& m) { m.covariance = Eigen::Matrix3d::Identity(); }) ==
        "array 'covariance' is 3 x 3 for 2 parameters");
  CHECK(reason([](ModelData& m) { m.numerator[0] = NAN; }) ==
        "array 'numerator' is not finite at line 1 of 2; a model of form "
        "'transfer_function' can't be read without it");
  CHECK(reason([](ModelData& m) { m.denominator.setZero(); }) ==
        "numerator and denominator need coefficients, the denominator one that is not 0");
  CHECK(reason([](ModelData& m) { m.delay_s = INFINITY; }) ==
        "attributes 'sample_time' and 'delay' must be finite, the first not below 0");
  const auto other = RecordBuilder("trace").bytes();
  CHECK(records::read_model(RecordView(other.data())).error().text == "a record of type 'trace'; needed: model");
}

TEST_CASE("model record: a state space of several inputs and outputs is read as it was written") {
  ModelData m;
  m.method = "test.model";
  m.form = "state_space";
  m.order = 2;
  m.state_space = numerics::StateSpace{Eigen::Matrix2d{{-1.0, 2.0}, {-2.0, -1.0}}, Eigen::MatrixXd::Random(2, 3),
                                       Eigen::MatrixXd::Random(2, 2), Eigen::MatrixXd::Random(2, 3), 0.0};
  m.poles = Eigen::Vector2cd(std::complex<double>(-1.0, 2.0), std::complex<double>(-1.0, -2.0));
  m.inputs = {{"u1", "u2", "u3"}, {"A", "A", "V"}};
  m.outputs = {{"x", "phi"}, {"m", "rad"}};
  const auto bytes = records::write_model(m).bytes();
  const RecordView record(bytes.data());
  const auto read = records::read_linear_model(record);
  REQUIRE(read);
  REQUIRE(read->state_space);
  CHECK(read->state_space->A == m.state_space->A);
  CHECK(read->state_space->B == m.state_space->B);
  CHECK(read->state_space->C == m.state_space->C);
  CHECK(read->state_space->D == m.state_space->D);
  CHECK(read->poles == m.poles);
  CHECK(read->inputs.names == m.inputs.names);
  CHECK(read->outputs.units == m.outputs.units);
  CHECK(read->input_name == "u1");
  CHECK(records::read_model(record).error().text ==
        "the record has no array 'numerator'; a model of form 'state_space' can't be read without it");
  m.state_space->B.conservativeResize(1, 3);
  const auto broken = records::write_model(m).bytes();
  CHECK_FALSE(records::read_linear_model(RecordView(broken.data())));
}

TEST_CASE("model record: a gain without states is a state space too") {
  ModelData m;
  m.form = "state_space";
  m.state_space = numerics::StateSpace{Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 1), Eigen::MatrixXd(1, 0),
                                       Eigen::MatrixXd::Constant(1, 1, 3.0), 0.0};
  const auto bytes = records::write_model(m).bytes();
  const auto read = records::read_linear_model(RecordView(bytes.data()));
  REQUIRE(read);
  CHECK(read->state_space->states() == 0);
  CHECK(read->state_space->D(0, 0) == 3.0);
}

TEST_CASE("model record: numerator and denominator are realised where there is no state space") {
  const auto read = carried(example(0.0));
  const auto system = records::state_space_of(*read);
  REQUIRE(system);
  CHECK(system->states() == 2);
}
