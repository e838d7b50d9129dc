#include "modes.hpp"

#include <cmath>
#include <sstream>
#include <vector>

namespace bodeflow::plants {
namespace {

std::vector<std::string> fields_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> fields;
  std::istringstream parts(line);
  for (std::string part; std::getline(parts, part, ',');) fields.push_back(part);
  return fields;
}

/// How many headings begin with that letter, from `at` on.
Eigen::Index run_of(const std::vector<std::string>& heading, std::size_t at, char letter) {
  Eigen::Index count = 0;
  while (at < heading.size() && !heading[at].empty() && heading[at].front() == letter) ++at, ++count;
  return count;
}

bool number_of(const std::string& field, double& value) {
  std::istringstream in(field);
  in.imbue(std::locale::classic());
  in >> value;
  return !in.fail() && (in >> std::ws).eof() && std::isfinite(value);
}

}  // namespace

numerics::Expected<Modes> read_modes(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const auto heading = fields_of(line);
  const Eigen::Index inputs = run_of(heading, 2, 'b'), outputs = run_of(heading, static_cast<std::size_t>(2 + inputs), 'c');
  const auto columns = static_cast<Eigen::Index>(heading.size());
  if (columns < 4 || heading[0] != "wn" || heading[1] != "zeta" || inputs == 0 || outputs == 0 || columns != 2 + inputs + outputs)
    return numerics::refused("line 1: '" + line.substr(0, 80) +
                             "'; needed: wn,zeta, then a column b of each input, then c of each output");
  std::vector<double> values;
  Eigen::Index rows = 0;
  for (int number = 2; std::getline(lines, line); ++number) {
    const auto fields = fields_of(line);
    if (fields.empty()) continue;
    if (static_cast<Eigen::Index>(fields.size()) != columns)
      return numerics::refused("line " + std::to_string(number) + ": " + std::to_string(fields.size()) +
                               " values; needed: " + std::to_string(columns));
    for (const auto& field : fields) {
      double value = 0.0;
      if (!number_of(field, value))
        return numerics::refused("line " + std::to_string(number) + ": '" + field.substr(0, 40) + "' is no number");
      values.push_back(value);
    }
    ++rows;
  }
  if (rows == 0) return numerics::refused("no modes below the heading");
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::MatrixXd table = Eigen::Map<const RowMajor>(values.data(), rows, columns);
  return Modes{table.col(0), table.col(1), table.middleCols(2, inputs), table.rightCols(outputs)};
}

numerics::Expected<numerics::StateSpace> modal_system(const Modes& m) {
  const Eigen::Index n = m.omega_rad_s.size();
  if (m.damping.size() != n || m.inputs.rows() != n || m.outputs.rows() != n)
    return numerics::refused("frequencies, damping ratios and gains of modes differ in number");
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n), B = Eigen::MatrixXd::Zero(2 * n, m.inputs.cols()),
                  C = Eigen::MatrixXd::Zero(m.outputs.cols(), 2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double w = m.omega_rad_s[i];
    if (!(w > 0.0) || !(m.damping[i] > 0.0))
      return numerics::refused("mode " + std::to_string(i + 1) + ": frequency and damping ratio must be above 0");
    A(2 * i, 2 * i + 1) = w;
    A(2 * i + 1, 2 * i) = -w;
    A(2 * i + 1, 2 * i + 1) = -2.0 * m.damping[i] * w;
    B.row(2 * i + 1) = w * m.inputs.row(i);
    C.col(2 * i) = m.outputs.row(i).transpose();
  }
  return numerics::make_state_space(A, B, C, Eigen::MatrixXd::Zero(C.rows(), B.cols()));
}

}  // namespace bodeflow::plants
