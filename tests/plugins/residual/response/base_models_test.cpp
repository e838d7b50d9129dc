#include <Eigen/Dense>
#include <bodeflow/numerics/random.hpp>
#include <bodeflow/record_builder.hpp>
#include <cmath>
#include <numbers>

#include "../declared_base.hpp"
#include "bases/frequency_response.hpp"
#include "bases/impedance.hpp"
#include "bases/state_space.hpp"
#include "bases/transfer_function.hpp"
#include "catch.hpp"
#include "records/model.hpp"
#include "records/response.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

using Complex = std::complex<double>;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

Complex axis(double frequency_hz) { return {0.0, kTwoPi * frequency_hz}; }

Eigen::MatrixXcd by_response(const BaseModel& base, const std::vector<double>& v, const std::vector<double>& known, Complex s) {
  const auto m = static_cast<Eigen::Index>(base.places().size()), q = static_cast<Eigen::Index>(base.inputs().size());
  Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> r(1 + m, q + m);
  REQUIRE(base.response(v.data(), known.data(), s, r.data()));
  return r;
}

/// C (sI - A)^-1 B + D of the plant as it is written in <bodeflow/plant.hpp>.
Eigen::MatrixXcd by_state_space(const BaseModel& base, const std::vector<double>& v, const std::vector<double>& known,
                                Complex s) {
  LinearPlant p;
  REQUIRE(base.state_space(v.data(), known.data(), p));
  const auto matrix = [](const std::vector<double>& x, int rows, int columns) {
    return Eigen::MatrixXd(Eigen::Map<const RowMajor>(x.data(), rows, columns));
  };
  const int n = p.states, q = p.inputs, m = p.places;
  Eigen::MatrixXd b(n, q + m), c(1 + m, n), d(1 + m, q + m);
  b << matrix(p.B, n, q), matrix(p.E, n, m);
  c << matrix(p.C, 1, n), matrix(p.Cf, m, n);
  d << matrix(p.D, 1, q), matrix(p.F, 1, m), matrix(p.Df, m, q), matrix(p.Ff, m, m);
  const Eigen::MatrixXcd a = s * Eigen::MatrixXcd::Identity(n, n) - matrix(p.A, n, n);
  return c.cast<Complex>() * a.partialPivLu().solve(b.cast<Complex>()) + d.cast<Complex>();
}

double error(const Eigen::MatrixXcd& found, const Eigen::MatrixXcd& expected) {
  return (found - expected).norm() / expected.norm();
}

MeasuredResponse response_of(const BaseModel& base, const std::vector<double>& v, const std::vector<double>& known, double low,
                             double high, int lines = 120) {
  MeasuredResponse m;
  m.known = known;
  for (int k = 0; k < lines; ++k) {
    const double f = low * std::pow(high / low, k / (lines - 1.0));
    m.frequency_hz.push_back(f);
    m.response.push_back(by_response(base, v, known, axis(f))(0, 0));
    m.weight.push_back(1.0 / std::abs(m.response.back()));
  }
  return m;
}

const std::vector<double> kDriver = {5.6, 0.3e-3, 7.1, 0.0145, 2.0, 1000.0};

template <class Base, class Builder>
std::string refused_by(Base base, const Builder& record) {
  struct alignas(64) Line {
    std::uint8_t bytes[64];
  };
  std::vector<Line> memory(static_cast<std::size_t>(record.size()) / sizeof(Line));
  record.write(memory.data());
  try {
    base.use_model(RecordView(memory.front().bytes));
  } catch (const Failure& f) {
    return f.what();
  }
  return "taken";
}

template <class Base>
std::shared_ptr<const Base> with_model(const std::vector<Declared>& declared, const RecordBuilder& record) {
  struct alignas(64) Line {
    std::uint8_t bytes[64];
  };
  std::vector<Line> memory(static_cast<std::size_t>(record.size()) / sizeof(Line));
  record.write(memory.data());
  Base base = *declared_base<Base>(declared);
  base.use_model(RecordView(memory.front().bytes));
  return std::make_shared<const Base>(base);
}

}  // namespace

TEST_CASE("impedance: response and state space of the admittance are the same, the impedance is its inverse") {
  const auto y = declared_base<Impedance>({{"quantity", std::string("admittance")}});
  const auto z = declared_base<Impedance>();
  CHECK(y->has_state_space());
  CHECK_FALSE(z->has_state_space());
  CHECK(z->response_unit() == "ohm");
  CHECK(y->response_unit() == "S");
  for (const double f : {1.0, 40.0, 55.0, 3000.0}) {
    const std::vector<double> known = {0.008};
    CHECK(error(by_response(*y, kDriver, known, axis(f)), by_state_space(*y, kDriver, known, axis(f))) < 1e-10);
    const Complex s = axis(f), mechanic = s * (kDriver[3] + 0.008) + kDriver[4] + kDriver[5] / s;
    const Complex expected = kDriver[0] + s * kDriver[1] + kDriver[2] * kDriver[2] / mechanic;
    CHECK(std::abs(by_response(*z, kDriver, known, s)(0, 0) - expected) < 1e-12 * std::abs(expected));
    CHECK(std::abs(by_response(*y, kDriver, known, s)(0, 0) * expected - 1.0) < 1e-12);
  }
  CHECK(by_response(*z, kDriver, {0.0}, 0.0)(0, 0) == Complex(5.6));
}

TEST_CASE("impedance: reactions at coil and spring act as resistance and stiffness do") {
  // A reaction Z v at a place, closed over the matrix, is the base model with that much more resistance or stiffness.
  for (const char* quantity : {"impedance", "admittance"}) {
    const auto base = declared_base<Impedance>({{"quantity", std::string(quantity)}});
    const Complex s = axis(48.0);
    const Eigen::MatrixXcd m = by_response(*base, kDriver, {0.0}, s);
    const Complex more[] = {1.5, 200.0 / s};
    std::vector<double> changed[] = {kDriver, kDriver};
    changed[0][0] += 1.5;
    changed[1][5] += 200.0;
    for (Eigen::Index place = 0; place < 2; ++place) {
      const Complex flow = m(1 + place, 0) / (1.0 - m(1 + place, 1 + place) * more[place]);
      const Complex output = m(0, 0) + m(0, 1 + place) * more[place] * flow;
      INFO(quantity << " place " << place);
      CHECK(std::abs(output - by_response(*base, changed[place], {0.0}, s)(0, 0)) < 1e-12 * std::abs(output));
    }
  }
}

TEST_CASE("impedance: starts are near the truth from two added masses or a declared force factor") {
  for (const char* quantity : {"impedance", "admittance"}) {
    const auto base = declared_base<Impedance>({{"quantity", std::string(quantity)}});
    const MeasuredResponse records[] = {response_of(*base, kDriver, {0.0}, 10, 5000),
                                        response_of(*base, kDriver, {0.016}, 10, 5000)};
    const auto starts = base->starts(records);
    REQUIRE_FALSE(starts.empty());
    const double tolerance[] = {0.05, 0.1, 0.1, 0.15, 0.15, 0.15};
    for (std::size_t i = 0; i < kDriver.size(); ++i) {
      INFO(quantity << " " << base->parameters()[i].name);
      CHECK(starts.front()[i] == Approx(kDriver[i]).epsilon(tolerance[i]));
    }
  }
  const auto declared = declared_base<Impedance>({{"force_factor", 7.1}});
  const std::vector<double> v = {5.6, 0.3e-3, 0.0145, 2.0, 1000.0};
  const MeasuredResponse one[] = {response_of(*declared, v, {0.0}, 10, 5000)};
  const auto start = declared->starts(one).front();
  for (std::size_t i = 0; i < v.size(); ++i) CHECK(start[i] == Approx(v[i]).epsilon(0.15));
}

TEST_CASE("impedance: what can't be told from the records is refused with what would help") {
  const auto base = declared_base<Impedance>();
  const MeasuredResponse one[] = {response_of(*base, kDriver, {0.0}, 10, 5000)};
  CHECK_THROWS_WITH(base->starts(one), Catch::Contains("state the added_mass of a second record, or declare force_factor"));
  MeasuredResponse swapped[] = {response_of(*base, kDriver, {0.016}, 10, 5000), response_of(*base, kDriver, {0.0}, 10, 5000)};
  std::swap(swapped[0].known, swapped[1].known);
  CHECK_THROWS_WITH(base->starts(swapped), Catch::Contains("the added mass does not lower the resonance as a mass does"));
  const MeasuredResponse above[] = {response_of(*base, kDriver, {0.0}, 500, 5000)};
  CHECK_THROWS_WITH(base->starts(above), Catch::Contains("no record shows a resonance"));
  MeasuredResponse negative = one[0];
  for (Complex& g : negative.response) g = -g;
  CHECK_THROWS_WITH(base->starts({&negative, 1}), Catch::Contains("negative resistance"));
  CHECK_THROWS_WITH(declared_base<Impedance>({{"motion", std::string("none")}, {"force_factor", 7.0}}),
                    Catch::Contains("force_factor belongs to a driver"));
}

TEST_CASE("transfer_function: state space and response agree, starts from exact data are exact") {
  for (const int order : {1, 2, 5}) {
    const int above = order == 5 ? 3 : order - 1;
    const auto base = declared_base<TransferFunctionModel>({{"order", std::int64_t{order}},
                                                            {"numerator_order", std::int64_t{order == 1 ? 1 : above}},
                                                            {"reference_frequency", 40.0}});
    std::vector<double> v = order == 1   ? std::vector<double>{0.7, 0.2, 0.4}
                            : order == 2 ? std::vector<double>{1.0, -0.3, 0.1, 1.7}
                                         : std::vector<double>{2.0, 0.1, 0.5, 0.02, 0.05, 0.3, 0.2, 4.0, 1.3};
    REQUIRE(v.size() == base->parameters().size());
    for (const double f : {0.0, 3.0, 41.0, 800.0})
      CHECK(error(by_state_space(*base, v, {}, axis(f)), by_response(*base, v, {}, axis(f))) < 1e-11);
    const MeasuredResponse data[] = {response_of(*base, v, {}, 2, 400)};
    const std::vector<double> start = base->starts(data).front();
    for (const double f : {3.0, 22.0, 41.0, 300.0})
      CHECK(error(by_response(*base, start, {}, axis(f)), by_response(*base, v, {}, axis(f))) < 1e-6);
  }
  CHECK_THROWS_WITH(declared_base<TransferFunctionModel>(
                        {{"order", std::int64_t{2}}, {"numerator_order", std::int64_t{3}}, {"reference_frequency", 1.0}}),
                    "numerator_order = 3; allowed: at most the order, 2");
}

TEST_CASE("transfer_function: starts from noisy data are stable and near, and it says that it is a black box") {
  const auto base = declared_base<TransferFunctionModel>(
      {{"order", std::int64_t{4}}, {"numerator_order", std::int64_t{2}}, {"reference_frequency", 30.0}});
  const std::vector<double> v = {1.0, 0.1, 0.3, 0.06, 0.5, 0.1, 3.0};
  MeasuredResponse data = response_of(*base, v, {}, 3, 300);
  numerics::Random random(11);
  for (Complex& g : data.response) g *= 1.0 + 0.02 * Complex(random.normal(), random.normal());
  const std::vector<double> start = base->starts({&data, 1}).front();
  for (std::size_t i = 3; i < start.size(); ++i) CHECK(start[i] > 0.0);
  for (const double f : {5.0, 21.0, 52.0})
    CHECK(error(by_response(*base, start, {}, axis(f)), by_response(*base, v, {}, axis(f))) < 0.1);
  CHECK(base->places().empty());
  CHECK(base->conventions().front().find("a black box of order 4") == 0);
}

TEST_CASE("state_space: an identified transfer function as it is, up to a gain") {
  records::ModelData model;
  model.method = "koopmans_levin.identify";
  model.form = "transfer_function";
  model.order = 2;
  model.delay_s = 2e-3;
  model.numerator = Eigen::Vector2d(3.0, 50.0);
  model.denominator = Eigen::Vector3d(1.0, 4.0, 900.0);
  const auto base = with_model<StateSpaceModel>({{"delay", 1e-3}}, records::write_model(model));
  CHECK(base->timing().delay_s == Approx(3e-3));
  REQUIRE(base->parameters().size() == 1);
  for (const double f : {0.5, 4.8, 60.0}) {
    const Complex s = axis(f), expected = 0.9 * (3.0 * s + 50.0) / (s * s + 4.0 * s + 900.0);
    CHECK(std::abs(by_state_space(*base, {0.9}, {}, s)(0, 0) - expected) < 1e-12 * std::abs(expected));
  }
  MeasuredResponse m;
  for (const double f : {1.0, 5.0, 9.0}) {
    m.frequency_hz.push_back(f);
    m.response.push_back(by_state_space(*base, {1.3}, {}, axis(f))(0, 0));
  }
  CHECK(base->starts({&m, 1}).front()[0] == Approx(1.3));
  CHECK_THROWS_WITH(declared_base<StateSpaceModel>()->starts({&m, 1}), Catch::Contains("needs a record 'model'"));
  model.sample_time_s = 1e-3;
  CHECK(refused_by(*declared_base<StateSpaceModel>(), records::write_model(model)) ==
        "the model is in discrete time, with a sample time of 0.001 s; needed: one in continuous time");
}

TEST_CASE("state_space: matrices of several inputs, each with its gain") {
  RecordBuilder record("model");
  record.set("form", "state_space");
  const auto put = [&record](const char* name, std::initializer_list<std::uint64_t> shape, std::initializer_list<double> values) {
    const auto data = record.array<double>(name, "", std::vector<std::uint64_t>(shape));
    std::copy(values.begin(), values.end(), data.begin());
  };
  put("A", {2, 2}, {0.0, 1.0, -900.0, -4.0});
  put("B", {2, 3}, {0.0, 0.0, 1.0, 5.0, 2.0, 0.0});
  put("C", {1, 2}, {1.0, 0.0});
  put("D", {1, 3}, {0.0, 0.1, 0.0});
  const auto base = with_model<StateSpaceModel>({}, record);
  CHECK(base->inputs().size() == 3);
  CHECK(base->inputs()[2].channel == 2);
  const Complex s = axis(3.0), below = s * s + 4.0 * s + 900.0;
  const Eigen::MatrixXcd g = by_state_space(*base, {1.0, 2.0, -1.0}, {}, s);
  CHECK(std::abs(g(0, 0) - 5.0 / below) < 1e-12);
  CHECK(std::abs(g(0, 1) - 2.0 * (2.0 / below + 0.1)) < 1e-12);
  CHECK(std::abs(g(0, 2) + (s + 4.0) / below) < 1e-12);
}

TEST_CASE("frequency_response: exact at its lines, straight between them, refused beyond them") {
  records::ResponseData data;
  data.form = "known_input";
  data.input_names = {"u1", "u2"};
  data.output_names = {"x", "y"};
  data.response_units = {"um/V", "um/V", "um/V", "um/V"};
  data.frequency_hz = Eigen::Vector3d(10.0, 20.0, 40.0);
  data.response.resize(3, 4);
  data.response << 1.0, 2.0, Complex(3.0, 1.0), 4.0, 1.5, 2.5, Complex(5.0, -1.0), 4.5, 1.0, 2.0, 3.0, 4.0;
  const RecordBuilder record = records::write_response(data);
  const auto base = with_model<FrequencyResponseModel>({{"output", std::string("y")}}, record);
  REQUIRE(base->inputs().size() == 2);
  const std::vector<double> gains = {1.0, 2.0};
  CHECK(by_response(*base, gains, {}, axis(20.0))(0, 0) == Complex(5.0, -1.0));
  CHECK(std::abs(by_response(*base, gains, {}, axis(15.0))(0, 0) - Complex(4.0, 0.0)) < 1e-12);
  CHECK(std::abs(by_response(*base, gains, {}, axis(30.0))(0, 1) - 8.5) < 1e-12);
  CHECK(by_response(*base, gains, {}, axis(5.0))(0, 0) == Complex(3.0, 1.0));
  CHECK(by_response(*base, gains, {}, 0.0)(0, 0) == Complex(3.0, 0.0));
  CHECK(by_response(*base, gains, {}, axis(49.0))(0, 1) == Complex(8.0, 0.0));
  Complex none[2];
  CHECK_FALSE(base->response(gains.data(), nullptr, axis(51.0), none));
  CHECK(refused_by(*declared_base<FrequencyResponseModel>(), record) == "the response has several outputs, x, y: declare output");
  CHECK(refused_by(*declared_base<FrequencyResponseModel>({{"output", std::string("z")}}), record) ==
        "the response has no output 'z'; there are: x, y");
  MeasuredResponse far;
  far.frequency_hz = {30.0, 60.0};
  far.response = {1.0, 1.0};
  CHECK_THROWS_WITH(base->starts({&far, 1}), "the response of the model ends at 40 Hz, the records at 60 Hz");
}

TEST_CASE("state_space and frequency_response: without their record they have an input and no plant") {
  const std::vector<double> one = {1.0};
  const auto identified = declared_base<StateSpaceModel>();
  const auto measured = declared_base<FrequencyResponseModel>();
  LinearPlant plant;
  Complex response = 0.0;
  CHECK_FALSE(identified->state_space(one.data(), nullptr, plant));
  CHECK_FALSE(measured->response(one.data(), nullptr, axis(1.0), &response));
  for (const BaseModel* base : {static_cast<const BaseModel*>(identified.get()), static_cast<const BaseModel*>(measured.get())}) {
    CHECK(base->inputs().size() == 1);
    CHECK(base->parameters().size() == 1);
    CHECK_THROWS_AS(base->starts({}), Failure);
  }
}
