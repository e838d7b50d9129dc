#include <algorithm>
#include <bodeflow/base_proxy.hpp>
#include <bodeflow/units.hpp>
#include <bodeflow/words.hpp>
#include <cmath>
#include <limits>
#include <memory>

#include "part_checks.hpp"
#include "test_host.hpp"

namespace bodeflow::testing {
namespace {

using Complex = std::complex<double>;
using limits = std::numeric_limits<double>;
constexpr double kPi = 3.14159265358979323846;

/// How far response and state space may lie apart, of the largest entry: what rounding leaves of plants of many states.
constexpr double kSame = 1e-6;

/// A base model with a host of its own. Skips where it refuses to be made with these values alone.
struct MadeBase {
  MadeBase(const bf_factory& factory, const std::vector<StoredValue>& values) {
    bf_base_model c{};
    if (factory.create(&factory, host.c(), &c) != BF_OK) fail("create fails: " + host.take_error());
    try {
      model = std::make_unique<detail::BaseProxy>(c, values, nullptr);
    } catch (const Failure& refused) {
      throw Skip{refused.what()};
    }
    known.assign(model->known().size(), 0.0);
  }
  const BaseModel* operator->() const { return model.get(); }

  TestHost host;
  std::unique_ptr<detail::BaseProxy> model;
  std::vector<double> known;
};

/// Solves M X = R in place by elimination with pivots; M n x n, R n x columns, both row-major. False: singular.
bool solve(std::vector<Complex>& m, std::vector<Complex>& r, std::size_t n, std::size_t columns) {
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(m[i * n + k]) > std::abs(m[pivot * n + k])) pivot = i;
    }
    if (m[pivot * n + k] == 0.0) return false;
    for (std::size_t j = 0; j < n; ++j) std::swap(m[k * n + j], m[pivot * n + j]);
    for (std::size_t j = 0; j < columns; ++j) std::swap(r[k * columns + j], r[pivot * columns + j]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const Complex factor = m[i * n + k] / m[k * n + k];
      for (std::size_t j = k; j < n; ++j) m[i * n + j] -= factor * m[k * n + j];
      for (std::size_t j = 0; j < columns; ++j) r[i * columns + j] -= factor * r[k * columns + j];
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = 0; j < columns; ++j) r[k * columns + j] /= m[k * n + k];
  }
  return true;
}

/// Output and flows by inputs and reactions at s: C (sI - A)^-1 B + D of the whole plant. Empty where s is a pole.
std::vector<Complex> response_of(const LinearPlant& p, Complex s) {
  const auto n = static_cast<std::size_t>(p.states), q = static_cast<std::size_t>(p.inputs),
             m = static_cast<std::size_t>(p.places);
  const std::size_t columns = q + m;
  std::vector<Complex> a(n * n), x(n * columns);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) a[i * n + j] = (i == j ? s : 0.0) - p.A[i * n + j];
    for (std::size_t j = 0; j < columns; ++j) x[i * columns + j] = j < q ? p.B[i * q + j] : p.E[i * m + j - q];
  }
  if (!solve(a, x, n, columns)) return {};
  std::vector<Complex> g((1 + m) * columns);
  for (std::size_t row = 0; row < 1 + m; ++row) {
    const double* c = row == 0 ? p.C.data() : p.Cf.data() + (row - 1) * n;
    const double* d = row == 0 ? p.D.data() : p.Df.data() + (row - 1) * q;
    const double* f = row == 0 ? p.F.data() : p.Ff.data() + (row - 1) * m;
    for (std::size_t j = 0; j < columns; ++j) {
      Complex sum = j < q ? d[j] : f[j - q];
      for (std::size_t i = 0; i < n; ++i) sum += c[i] * x[i * columns + j];
      g[row * columns + j] = sum;
    }
  }
  return g;
}

bool finite(const std::vector<Complex>& values) {
  return std::all_of(values.begin(), values.end(), [](Complex z) { return std::isfinite(z.real()) && std::isfinite(z.imag()); });
}

bool finite(const LinearPlant& p) {
  for (const auto* matrix : {&p.A, &p.B, &p.E, &p.Cf, &p.Df, &p.Ff, &p.Cs, &p.Ds, &p.Fs, &p.C, &p.D, &p.F}) {
    if (!std::all_of(matrix->begin(), matrix->end(), [](double x) { return std::isfinite(x); })) return false;
  }
  return true;
}

bool equal(const LinearPlant& a, const LinearPlant& b) {
  return a.A == b.A && a.B == b.B && a.E == b.E && a.C == b.C && a.D == b.D && a.F == b.F && a.Cf == b.Cf && a.Df == b.Df &&
         a.Ff == b.Ff && a.Cs == b.Cs && a.Ds == b.Ds && a.Fs == b.Fs;
}

std::string told(const MadeBase& made) { return made.host.log().empty() ? "" : ": " + made.host.log(); }

class BaseChecks {
 public:
  BaseChecks(const bf_factory& factory, std::vector<StoredValue> values) : factory_(&factory), values_(std::move(values)) {}

  void statements(const Step&) const {
    const MadeBase m(*factory_, values_);
    for (const auto& list : {m->parameters(), m->known()}) {
      if (const std::string why = problem_of(list); !why.empty()) fail(why);
    }
    if (m->inputs().empty()) fail("has no input");
    for (const PlantInput& input : m->inputs()) {
      if (input.channel < 0 || input.derivative < 0) fail("an input has a negative channel or derivative");
    }
    std::vector<std::string> names;
    for (const Place& place : m->places()) {
      const std::string what = "place '" + place.name + "': ";
      if (!detail::is_word(place.name) || !detail::is_word(place.kind))
        fail(what + "name or kind is not a word of lower-case letters, digits and _");
      if (std::find(names.begin(), names.end(), place.name) != names.end()) fail(what + "stands twice");
      names.push_back(place.name);
      for (const auto& unit : {place.flow_unit, place.stored_unit, place.reaction_unit}) {
        if (!is_known_unit(unit)) fail(what + "unit '" + unit + "' is unknown");
      }
    }
    if (!std::isfinite(m->timing().delay_s) || !(m->filter_hz() >= 0.0))
      fail("delay or filter is not a finite number of at least 0");
    if (!is_known_unit(m->response_unit())) fail("the unit '" + m->response_unit() + "' of its response is unknown");
  }

  void starts(const Step&) const {
    const MadeBase m(*factory_, values_);
    const std::vector<double> v = inside(m);
    std::vector<MeasuredResponse> measured(m->inputs().size());
    for (int k = 1; k <= 40; ++k) {
      const double f = 0.5 * std::pow(1.2, k);
      const auto g = response(m, v, {0.0, 2.0 * kPi * f});
      for (std::size_t j = 0; j < measured.size() && !g.empty(); ++j) {
        measured[j].frequency_hz.push_back(f);
        measured[j].response.push_back(g[j]);
        measured[j].weight.push_back(1e3 / std::max(std::abs(g[j]), limits::min()));
      }
    }
    for (auto& one : measured) one.known = m.known;
    std::vector<std::vector<double>> found;
    try {
      found = m->starts(measured);
    } catch (const Failure& refused) {
      throw Skip{refused.what()};
    }
    if (const std::string why = problem_of(found, m->parameters()); !why.empty()) fail(why);
    if (found != m->starts(measured)) fail("gives other starts when asked again");
    if (!finite(response(m, found.front(), {0.0, 10.0}))) fail("has no finite response at its first start");
  }

  void plant(const Step&) const {
    const MadeBase m(*factory_, values_);
    if (!m->has_state_space()) throw Skip{};
    const std::vector<double> v = inside(m);
    LinearPlant first, second;
    second.resize(3, 2, 1);
    if (!m->state_space(v.data(), m.known.data(), first)) fail("gives no plant" + told(m));
    if (first.inputs != static_cast<int>(m->inputs().size()) || first.places != static_cast<int>(m->places().size()))
      fail("the plant has not as many inputs and places as the model states");
    if (!finite(first)) fail("a matrix is not finite");
    if (!m->state_space(v.data(), m.known.data(), second) || !equal(first, second)) fail("gives another plant when asked again");
  }

  void consistent(const Step&) const {
    const MadeBase m(*factory_, values_);
    const std::vector<double> v = inside(m);
    const auto size = (1 + m->places().size()) * (m->inputs().size() + m->places().size());
    LinearPlant plant;
    const bool has_plant = m->has_state_space() && m->state_space(v.data(), m.known.data(), plant);
    for (const Complex s : {Complex(0.0, 0.3), Complex(0.0, 20.0), Complex(0.0, 3000.0), Complex(-0.7, 5.0)}) {
      std::vector<Complex> own(size), again(size);
      if (!m->response(v.data(), m.known.data(), s, own.data())) {
        if (has_plant) throw Skip{};
        fail("has neither a state space nor a response" + told(m));
      }
      if (!finite(own)) fail("the response is not finite");
      m->response(v.data(), m.known.data(), s, again.data());
      if (own != again) fail("gives another response when asked again");
      const auto from_plant = has_plant ? response_of(plant, s) : std::vector<Complex>();
      double largest = 0.0, apart = 0.0;
      for (std::size_t i = 0; i < from_plant.size(); ++i) {
        largest = std::max(largest, std::abs(own[i]));
        apart = std::max(apart, std::abs(own[i] - from_plant[i]));
      }
      if (!(apart <= kSame * largest)) fail("the response is not that of its state space");
    }
  }

  void laws(const Step&) const {
    const MadeBase m(*factory_, values_);
    if (!m->has_laws()) throw Skip{};
    const std::vector<double> v = inside(m);
    for (std::size_t place = 0; place < m->places().size(); ++place) {
      for (const double flow : {0.0, 1e-9, 1.0, -1.0, 1e6, -1e6}) {
        const Signals s{flow, 0.5 * flow, 0.1, 1e-3, 0.1};
        const Reaction r = m->react(v.data(), m.known.data(), place, s);
        if (!std::isfinite(r.value) || !std::isfinite(r.by_flow) || !std::isfinite(r.by_stored))
          fail("a reaction is not finite" + told(m));
      }
    }
  }

  void outside(const Step& step) const {
    const MadeBase m(*factory_, values_);
    const auto size = (1 + m->places().size()) * (m->inputs().size() + m->places().size());
    for (const double x : {0.0, -1.0, 1e-300, 1e300, limits::quiet_NaN(), limits::infinity()}) {
      step("parameters of " + std::to_string(x));
      const std::vector<double> v(m->parameters().size(), x);
      LinearPlant plant;
      std::vector<Complex> matrix(size);
      (void)m->state_space(v.data(), m.known.data(), plant);
      (void)m->response(v.data(), m.known.data(), {0.0, 1.0}, matrix.data());
    }
    step("no measured response");
    try {
      (void)m->starts({});
      (void)m->starts(std::vector<MeasuredResponse>(m->inputs().size()));
    } catch (const Failure&) {  // refused with a reason
    }
  }

 private:
  /// The first line of the response: the output by the inputs and reactions. Empty: none there.
  static std::vector<Complex> response(const MadeBase& m, const std::vector<double>& v, Complex s) {
    std::vector<Complex> g((1 + m->places().size()) * (m->inputs().size() + m->places().size()));
    if (m->response(v.data(), m.known.data(), s, g.data())) return g;
    LinearPlant plant;
    return m->has_state_space() && m->state_space(v.data(), m.known.data(), plant) ? response_of(plant, s)
                                                                                   : std::vector<Complex>();
  }

  /// Values of the parameters at which the model has a response.
  static std::vector<double> inside(const MadeBase& m) {
    const auto parameters = m->parameters();
    for (const double size : {1.0, 0.1, 10.0, 1e-3, 1e3}) {
      std::vector<double> v;
      for (std::size_t i = 0; i < parameters.size(); ++i) {
        const FitParameter& p = parameters[i];
        const double wanted = (p.logarithmic ? size : size * p.scale) / static_cast<double>(i + 1);
        v.push_back(std::clamp(wanted, p.low, p.high));
      }
      if (const auto g = response(m, v, {0.0, 1.0}); !g.empty() && finite(g)) return v;
    }
    throw Skip{"the suite found no parameters at which it has a response" + told(m)};
  }

  const bf_factory* factory_;
  std::vector<StoredValue> values_;
};

}  // namespace

std::vector<PartCheck> base_checks(const bf_factory& factory, const std::vector<StoredValue>& values) {
  const BaseChecks checks(factory, values);
  std::vector<PartCheck> list;
  const auto add = [&](const char* name, void (BaseChecks::*run)(const Step&) const) {
    list.push_back({name, [checks, run](const Step& step) { (checks.*run)(step); }});
  };
  add("states sound parameters, places and inputs", &BaseChecks::statements);
  add("gives starts from a measured response", &BaseChecks::starts);
  add("gives a finite plant of the sizes that it states", &BaseChecks::plant);
  add("has the response of its state space", &BaseChecks::consistent);
  add("reacts finitely by its own laws", &BaseChecks::laws);
  add("survives parameters outside of its domain", &BaseChecks::outside);
  return list;
}

}  // namespace bodeflow::testing
