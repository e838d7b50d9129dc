// The unit loads as a simulator loads it, and plays the model.

#include "export/fmu.hpp"

#include <dlfcn.h>

#include <cstring>
#include <map>

#include "bodeflow/numerics/discretise.hpp"
#include "models.hpp"

using namespace bodeflow;
using namespace bodeflow::tools::exports;
using test::Folder;
using test::random_model;

namespace {

/// The files of an archive without compression, as its local headers list them.
std::map<std::string, std::string> files_in(const std::string& zip) {
  std::map<std::string, std::string> files;
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::uint32_t value = 0;
    std::memcpy(&value, zip.data() + at, bytes);
    return std::size_t{value};
  };
  for (std::size_t at = 0; number(at, 4) == 0x04034b50;) {
    const std::size_t size = number(at + 18, 4), name = number(at + 26, 2), extra = number(at + 28, 2);
    files[zip.substr(at + 30, name)] = zip.substr(at + 30 + name + extra, size);
    at += 30 + name + extra + size;
  }
  return files;
}

/// An unpacked unit, loaded.
class Unit {
 public:
  explicit Unit(const std::string& zip) {
    for (const auto& [name, content] : files_in(zip)) {
      const std::string file = folder_.write(name, content);
      if (name.rfind("binaries/", 0) == 0) library_ = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    }
    REQUIRE(library_ != nullptr);
    std::string uri = "file://" + (folder_.path() / "resources").string();
    for (std::size_t at = uri.find(' '); at != std::string::npos; at = uri.find(' ')) uri.replace(at, 1, "%20");
    const auto instantiate =
        function<void*(const char*, int, const char*, const char*, const void*, int, int)>("fmi2Instantiate");
    unit_ = instantiate("one", 1, "", uri.c_str(), nullptr, 0, 0);
    REQUIRE(unit_ != nullptr);
    function<int(void*, int, double, double, int, double)>("fmi2SetupExperiment")(unit_, 0, 0.0, 0.0, 0, 0.0);
    function<int(void*)>("fmi2EnterInitializationMode")(unit_);
    function<int(void*)>("fmi2ExitInitializationMode")(unit_);
  }
  ~Unit() {
    function<void(void*)>("fmi2FreeInstance")(unit_);
    dlclose(library_);
  }
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;

  void set(const Eigen::VectorXd& u) {
    for (unsigned i = 0; i < u.size(); ++i)
      REQUIRE(function<int(void*, const unsigned*, std::size_t, const double*)>("fmi2SetReal")(unit_, &i, 1, &u[i]) == 0);
  }
  Eigen::VectorXd get(unsigned inputs, unsigned outputs) {
    Eigen::VectorXd y(outputs);
    for (unsigned i = 0; i < outputs; ++i) {
      const unsigned reference = inputs + i;
      REQUIRE(function<int(void*, const unsigned*, std::size_t, double*)>("fmi2GetReal")(unit_, &reference, 1, &y[i]) == 0);
    }
    return y;
  }
  int step(double time, double h) { return function<int(void*, double, double, int)>("fmi2DoStep")(unit_, time, h, 1); }
  int keep(void** state) { return function<int(void*, void**)>("fmi2GetFMUstate")(unit_, state); }
  int back(void* state) { return function<int(void*, void*)>("fmi2SetFMUstate")(unit_, state); }
  int drop(void** state) { return function<int(void*, void**)>("fmi2FreeFMUstate")(unit_, state); }

  template <class F>
  F* function(const char* name) {
    F* found = nullptr;
    void* symbol = dlsym(library_, name);
    std::memcpy(&found, &symbol, sizeof found);
    REQUIRE(found != nullptr);
    return found;
  }

 private:
  Folder folder_;
  void* library_ = nullptr;
  void* unit_ = nullptr;
};

Eigen::VectorXd input_at(Eigen::Index n, Eigen::Index inputs) {
  Eigen::VectorXd u(inputs);
  for (Eigen::Index i = 0; i < inputs; ++i) u[i] = n < 5 ? 1.0 : std::sin(0.7 * static_cast<double>(n * (i + 1)));
  return u;
}

}  // namespace

TEST_CASE("an FMU of a continuous system plays its zero-order hold, whatever the step") {
  const ModelFile model = random_model(6, 2, 3, 0.0);
  const auto zip = fmu_of(model);
  REQUIRE(zip);
  for (const double h : {0.01, 0.3}) {
    const auto held = numerics::zero_order_hold(model.system(), h);
    REQUIRE(held);
    const auto& z = held->model;
    Unit unit(*zip);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(6);
    double worst = 0.0;
    for (Eigen::Index n = 0; n < 100; ++n) {
      const Eigen::VectorXd u = input_at(n, 2);
      unit.set(u);
      const Eigen::VectorXd expected = z.C * x + z.D * u;
      worst = std::max(worst, (unit.get(2, 3) - expected).cwiseAbs().maxCoeff());
      REQUIRE(unit.step(static_cast<double>(n) * h, h) == 0);
      x = z.A * x + z.B * u;
    }
    CHECK(worst < 1e-12);
  }
}

TEST_CASE("an FMU of a discrete system steps sample by sample, also several at once") {
  const ModelFile model = random_model(4, 1, 1, 0.1);
  const auto zip = fmu_of(model);
  REQUIRE(zip);
  const auto& s = model.system();
  for (const int samples : {1, 3}) {
    Unit unit(*zip);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(4);
    for (Eigen::Index n = 0; n < 60; ++n) {
      const Eigen::VectorXd u = input_at(n, 1);
      unit.set(u);
      CHECK(std::abs(unit.get(1, 1)[0] - (s.C * x + s.D * u)[0]) < 1e-12);
      REQUIRE(unit.step(static_cast<double>(n * samples) * 0.1, samples * 0.1) == 0);
      for (int k = 0; k < samples; ++k) x = s.A * x + s.B * u;
    }
  }
}

TEST_CASE("an FMU goes back to a state it has kept, and refuses what it does not know") {
  const auto zip = fmu_of(random_model(4, 1, 1, 0.0));
  REQUIRE(zip);
  Unit unit(*zip);
  unit.set(Eigen::VectorXd::Ones(1));
  REQUIRE(unit.step(0.0, 0.1) == 0);
  void* state = nullptr;
  REQUIRE(unit.keep(&state) == 0);
  REQUIRE(unit.step(0.1, 0.1) == 0);
  const double later = unit.get(1, 1)[0];
  REQUIRE(unit.back(state) == 0);
  REQUIRE(unit.step(0.1, 0.1) == 0);
  CHECK(unit.get(1, 1)[0] == later);
  CHECK(unit.drop(&state) == 0);
  CHECK(state == nullptr);
  CHECK(unit.step(0.2, -1.0) == 3);
  const unsigned unknown = 2;
  double value = 0.0;
  CHECK(unit.function<int(void*, const unsigned*, std::size_t, double*)>("fmi2GetReal") != nullptr);
  (void)unknown;
  (void)value;
}

TEST_CASE("an FMU has every function of FMI 2.0 for co-simulation, and a description of its variables") {
  const auto zip = fmu_of(random_model(2, 1, 2, 0.0));
  REQUIRE(zip);
  Unit unit(*zip);
  for (const char* name : {"fmi2GetTypesPlatform",
                           "fmi2GetVersion",
                           "fmi2SetDebugLogging",
                           "fmi2Terminate",
                           "fmi2Reset",
                           "fmi2GetInteger",
                           "fmi2GetBoolean",
                           "fmi2GetString",
                           "fmi2SetInteger",
                           "fmi2SetBoolean",
                           "fmi2SetString",
                           "fmi2SerializedFMUstateSize",
                           "fmi2SerializeFMUstate",
                           "fmi2DeSerializeFMUstate",
                           "fmi2GetDirectionalDerivative",
                           "fmi2SetRealInputDerivatives",
                           "fmi2GetRealOutputDerivatives",
                           "fmi2CancelStep",
                           "fmi2GetStatus",
                           "fmi2GetRealStatus",
                           "fmi2GetIntegerStatus",
                           "fmi2GetBooleanStatus",
                           "fmi2GetStringStatus"})
    CHECK(unit.function<void()>(name) != nullptr);
  const std::string xml = files_in(*zip).at("modelDescription.xml");
  CHECK(xml.find("modelIdentifier=\"plant\"") != std::string::npos);
  CHECK(xml.find("<ScalarVariable name=\"it's u0\" valueReference=\"0\" causality=\"input\"") != std::string::npos);
  CHECK(xml.find("<ScalarVariable name=\"y &lt;1&gt;\" valueReference=\"2\" causality=\"output\"") != std::string::npos);
  CHECK(*fmu_of(random_model(2, 1, 2, 0.0)) == *zip);
}

TEST_CASE("a model with a delay is not made an FMU that ignores it") {
  const ModelFile model = random_model(2, 1, 1, 0.0);
  auto late = model_of("plant", model.system(), 0.25, {}, {}, {}, {});
  REQUIRE(late);
  CHECK(fmu_of(*late).error() ==
        "the model has a delay of 0.25 s, which the unit does not play: delay its output in the simulation, or export another "
        "format");
}
