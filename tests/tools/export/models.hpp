#pragma once

#include <unistd.h>

#include <Eigen/Dense>
#include <filesystem>
#include <fstream>
#include <string>

#include "bodeflow/numerics/random.hpp"
#include "catch.hpp"
#include "export/model_file.hpp"

namespace bodeflow::test {

using tools::exports::ModelFile;

/// A folder that is gone afterwards.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "bodeflow export XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) FAIL("no temporary folder");
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string write(const std::string& name, const std::string& content) const {
    const auto file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file.string();
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A stable system with numbers that have no short decimal form.
inline ModelFile random_model(Eigen::Index states, Eigen::Index inputs, Eigen::Index outputs, double sample_time) {
  numerics::Random random(31);
  const auto filled = [&](Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd m(rows, columns);
    for (double& x : m.reshaped()) x = random.normal();
    return m;
  };
  Eigen::MatrixXd A = filled(states, states);
  const double radius = states > 0 ? A.eigenvalues().cwiseAbs().maxCoeff() : 1.0;
  A = sample_time > 0.0 ? Eigen::MatrixXd(0.9 / radius * A)
                        : Eigen::MatrixXd(A - 1.3 * radius * Eigen::MatrixXd::Identity(states, states));
  const auto system =
      numerics::make_state_space(A, filled(states, inputs), filled(outputs, states), filled(outputs, inputs), sample_time);
  std::vector<std::string> in, out;
  for (Eigen::Index i = 0; i < inputs; ++i) in.push_back("it's u" + std::to_string(i));
  for (Eigen::Index i = 0; i < outputs; ++i) out.push_back("y <" + std::to_string(i) + ">");
  auto file = tools::exports::model_of("plant", *system, 0.0, {}, {}, in, out);
  REQUIRE(file);
  return std::move(*file);
}

}  // namespace bodeflow::test
