#include "examples.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "acquisition/response.hpp"

namespace bench {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// A transformer ladder of the reference files, with .1 % noise.
Example ladder(Eigen::Index order) {
  std::ifstream file(fmt::format("{}/ladder{}_frf.csv", BENCH_REFERENCE, order));
  std::string text;
  std::getline(file, text);
  std::vector<std::array<double, 5>> rows;
  while (std::getline(file, text)) {
    std::istringstream cells(text);
    std::array<double, 5> row{};
    for (double& value : row) {
      cells >> value;
      cells.ignore(1);
    }
    rows.push_back(row);
  }
  const auto lines = static_cast<Eigen::Index>(rows.size());
  Example e{fmt::format("transformer ladder of order {}, .1 % noise", order),
            {Eigen::VectorXd(lines), Eigen::MatrixXcd(lines, 1), Eigen::MatrixXd::Ones(lines, 1)},
            1,
            {order}};
  for (Eigen::Index k = 0; k < lines; ++k) {
    const auto& row = rows[static_cast<std::size_t>(k)];
    e.data.omega_rad_s[k] = row[0];
    e.data.response(k, 0) = {row[3], row[4]};
  }
  return e;
}

}  // namespace

Example measured(const std::string& name, const std::string& path, const std::vector<std::string>& quantities,
                 std::optional<std::pair<double, double>> band_hz, std::vector<Eigen::Index> orders) {
  auto table = bodeflow::acquisition::read_response(path, quantities);
  if (!table) throw std::runtime_error(table.error().text);
  const auto response = bodeflow::acquisition::assemble(std::move(*table), {quantities, band_hz});
  if (!response) throw std::runtime_error(response.error().text);
  const auto lines = static_cast<Eigen::Index>(response->frequency_hz.size());
  const auto outputs = static_cast<Eigen::Index>(response->output_names.size());
  const auto inputs = static_cast<Eigen::Index>(response->input_names.size());
  Example e{name,
            {Eigen::VectorXd(lines), Eigen::MatrixXcd(lines, outputs * inputs), Eigen::MatrixXd::Ones(lines, 1)},
            inputs,
            std::move(orders)};
  for (Eigen::Index k = 0; k < lines; ++k) {
    e.data.omega_rad_s[k] = kTurn * response->frequency_hz[static_cast<std::size_t>(k)];
    for (Eigen::Index i = 0; i < outputs; ++i)
      for (Eigen::Index j = 0; j < inputs; ++j)
        e.data.response(k, j * outputs + i) = response->value[static_cast<std::size_t>((k * outputs + i) * inputs + j)];
  }
  return e;
}

std::vector<Example> examples() {
  std::vector<Example> list = {ladder(6), ladder(17), ladder(31)};
  const char* folder = std::getenv("BODEFLOW_DATA");
  if (folder == nullptr) {
    fmt::print("BODEFLOW_DATA is not set: no measured data\n");
    return list;
  }
  const std::string data = folder;
  list.push_back(measured("ring slot, 75 to 110 GHz", data + "/touchstone/ringslot_measured.s1p", {}, {}, {6, 12}));
  list.push_back(measured("transformer admittance, 25 kHz to 4 MHz", data + "/transformer_admittance/03PK10.csv", {},
                          std::pair{1e4, 4.0001e6}, {6, 14}));
  list.push_back(measured("loudspeaker impedance", data + "/loudspeaker_impedance/L16RNX_0g.csv", {}, {}, {6, 12}));
  list.push_back(measured("network analyser, entry S21", data + "/touchstone/Agilent_E5071B.s4p", {"S21"}, {}, {40}));
  list.push_back(measured("network analyser, four ports", data + "/touchstone/Agilent_E5071B.s4p", {}, {}, {40, 80}));
  return list;
}

}  // namespace bench
