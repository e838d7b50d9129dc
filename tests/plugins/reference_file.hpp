#pragma once

#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace bodeflow::test {

using Json = nlohmann::json;

/// A file of tests/data.
inline Json reference_file(const std::string& path) { return Json::parse(std::ifstream(BODEFLOW_TEST_DATA "/" + path)); }

inline Eigen::VectorXd vector_of(const Json& list) {
  const auto values = list.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

inline Eigen::VectorXcd complex_vector_of(const Json& parts) {
  const Eigen::VectorXd re = vector_of(parts["re"]), im = vector_of(parts["im"]);
  Eigen::VectorXcd v(re.size());
  v.real() = re;
  v.imag() = im;
  return v;
}

/// max |found - expected| / max |expected|
template <class A, class B>
double relative_difference(const A& found, const B& expected) {
  return (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace bodeflow::test
