#include "noise_record.hpp"

#include <algorithm>
#include <cmath>

#include "records/record_arrays.hpp"
#include "records/response_units.hpp"

namespace bodeflow::frisch {
namespace {

constexpr Eigen::Index kPoints = 33;  // of a curve

using Get = double (*)(const FrischNoise&);

void put_std(RecordBuilder& r, const char* name, const std::string& unit, const std::vector<FrischNoise>& found, Get get) {
  Eigen::VectorXd std(static_cast<Eigen::Index>(found.size()));
  for (std::size_t b = 0; b < found.size(); ++b) std[static_cast<Eigen::Index>(b)] = std::sqrt(std::max(0.0, get(found[b])));
  records::put_list<double>(r, name, unit, std);
}

void put_pooled(RecordBuilder& r, const std::vector<Band>& bands) {
  if (!std::all_of(bands.begin(), bands.end(), [](const Band& b) { return b.has_scatter(); })) return;
  Eigen::MatrixXd std(static_cast<Eigen::Index>(bands.size()), 2);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const PooledNoise noise = pooled_noise(bands[b]);
    std.row(static_cast<Eigen::Index>(b)) << std::sqrt(noise.input_variance), std::sqrt(noise.output_variance);
  }
  records::put_list<double>(r, "input_pooled", bands.front().input_unit, std.col(0).eval());
  records::put_list<double>(r, "output_pooled", bands.front().output_unit, std.col(1).eval());
}

/// The lines of all bands, one after the other.
struct Lines {
  Eigen::VectorXd frequency, uu, yy, most_input, most_output;
  std::vector<std::int64_t> band;
};

Lines lines_of(const std::vector<Band>& bands) {
  Lines all;
  const auto append = [](Eigen::VectorXd& to, const Eigen::VectorXd& values) {
    to.conservativeResize(to.size() + values.size());
    to.tail(values.size()) = values;
  };
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const PowerSpectra& p = bands[b].power;
    const Eigen::VectorXd c = p.yu.cwiseAbs2();
    append(all.frequency, bands[b].frequency_hz());
    append(all.uu, p.uu);
    append(all.yy, p.yy);
    append(all.most_input, (p.uu - c.cwiseQuotient(p.yy)).cwiseMax(0.0));
    append(all.most_output, (p.yy - c.cwiseQuotient(p.uu)).cwiseMax(0.0));
    all.band.insert(all.band.end(), static_cast<std::size_t>(p.lines()), static_cast<std::int64_t>(b));
  }
  return all;
}

/// (12), from input variance 0 to its largest: output = yy - |uy|^2 / (uu - input).
void put_curves(RecordBuilder& r, const Lines& all, const std::string& input_unit, const std::string& output_unit) {
  const Eigen::Index lines = all.uu.size();
  Eigen::MatrixXd input(lines, kPoints), output(lines, kPoints);
  for (Eigen::Index k = 0; k < lines; ++k) {
    input.row(k).setLinSpaced(kPoints, 0.0, all.most_input[k]);
    const double c = all.uu[k] * (all.yy[k] - all.most_output[k]);  // |uy|^2
    output.row(k) = (all.yy[k] - c / (all.uu[k] - input.row(k).array())).max(0.0);
  }
  records::put_matrix(r, "curve_input", input_unit, input);
  records::put_matrix(r, "curve_output", output_unit, output);
}

}  // namespace

RecordBuilder noise_record(const std::vector<Band>& bands, const std::vector<FrischNoise>& found) {
  const std::string &input = bands.front().input_unit, &output = bands.front().output_unit;
  RecordBuilder r("noise_variances");
  std::vector<std::string> names;
  Eigen::VectorXd windows(static_cast<Eigen::Index>(bands.size()));
  std::vector<double> removed;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    names.push_back(bands[b].range());
    windows[static_cast<Eigen::Index>(b)] = bands[b].windows;
    const Eigen::VectorXd frequency = bands[b].frequency_hz();
    for (const Eigen::Index k : found[b].removed) removed.push_back(frequency[k]);
  }
  r.set("bands", names);
  r.set("input_name", bands.front().input_name);
  r.set("output_name", bands.front().output_name);
  put_std(r, "input_first", input, found, [](const FrischNoise& n) { return n.first.input; });
  put_std(r, "input_second", input, found, [](const FrischNoise& n) { return n.second.input; });
  put_std(r, "output_first", output, found, [](const FrischNoise& n) { return n.first.output; });
  put_std(r, "output_second", output, found, [](const FrischNoise& n) { return n.second.output; });
  put_pooled(r, bands);
  records::put_list<double>(r, "windows", "", windows);
  records::put_list<double>(r, "removed_frequency", "Hz",
                            Eigen::Map<const Eigen::VectorXd>(removed.data(), static_cast<Eigen::Index>(removed.size())));
  const Lines all = lines_of(bands);
  records::put_list<double>(r, "frequency", "Hz", all.frequency);
  records::put_list<std::int64_t>(r, "band", "",
                                  Eigen::Map<const Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>>(
                                      all.band.data(), static_cast<Eigen::Index>(all.band.size())));
  const std::string input_squared = records::squared_unit(input), output_squared = records::squared_unit(output);
  records::put_list<double>(r, "largest_input", input_squared, all.most_input);
  records::put_list<double>(r, "largest_output", output_squared, all.most_output);
  put_curves(r, all, input_squared, output_squared);
  return r;
}

}  // namespace bodeflow::frisch
