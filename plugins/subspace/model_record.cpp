#include "model_record.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>

#include "records/model.hpp"
#include "records/record_arrays.hpp"
#include "records/signals.hpp"
#include "sanathanan_koerner/model_record.hpp"

namespace bodeflow::subspace {
namespace {

constexpr double kPoor = 0.3;  // relative error above which a model explains little

records::ModelData described(const Identification& id, const Measured& measured, const Expected<ModelUncertainty>& uncertainty,
                             const std::vector<std::string>& warnings) {
  records::ModelData m;
  const sanathanan_koerner::Data& data = measured.data;
  m.method = "subspace.model";
  m.form = "state_space";
  m.order = id.model.order();
  m.sample_time_s = id.model.system.sample_time;
  m.state_space = id.model.system;
  m.poles = uncertainty ? uncertainty->poles : id.model.poles;
  if (uncertainty) m.pole_covariance = uncertainty->of.poles;
  if (uncertainty && uncertainty->parameters)
    sanathanan_koerner::add_parameters(*uncertainty->parameters, uncertainty->of, measured, m);
  if (data.channels() == 1) {
    const auto tf = sanathanan_koerner::faithful_polynomials(id.model.system, m.poles, data.omega_rad_s, id.model.response);
    if (tf) {
      m.numerator = tf->numerator;
      m.denominator = tf->denominator;
      if (const auto zeros = numerics::roots(numerics::trimmed(tf->numerator))) m.zeros = *zeros;
    }
  }
  m.input_name = measured.inputs.names.front();
  m.output_name = measured.outputs.names.front();
  if (measured.inputs.names.size() > 1) m.inputs = measured.inputs;
  if (measured.outputs.names.size() > 1) m.outputs = measured.outputs;
  m.warnings = warnings;
  m.conventions = {m.sample_time_s > 0.0 ? "sampled signals: hold and delay of the sampling are part of the model"
                                         : "continuous in time; a hold of the input, where there is one, is part of the model"};
  if (measured.sample_time_s > 0.0) m.sample_rate_hz = 1.0 / measured.sample_time_s;
  m.samples = data.lines();
  m.band_hz = Eigen::Vector2d(data.omega_rad_s[0], data.omega_rad_s[data.lines() - 1]) / (2.0 * std::numbers::pi);
  if (measured.input_amplitude > 0.0) m.input_amplitude = measured.input_amplitude;
  m.data_checksum = measured.checksum;
  return m;
}

}  // namespace

RecordBuilder model_record(const Identification& id, const Measured& measured, const Expected<ModelUncertainty>& uncertainty,
                           bool known_variance, const std::vector<std::string>& warnings) {
  RecordBuilder r = records::write_model(described(id, measured, uncertainty, warnings));
  if (uncertainty) {
    std::string method = "inverse Fisher information";
    if (measured.data.channels() > 1) method += " of poles with any residues: an upper bound";
    r.set("covariance_method", known_variance ? method : method + ", noise from the residuals");
  }
  r.set("rms_error", id.quality.rms);
  r.set("max_error", id.quality.maximum);
  r.set("relative_error", id.quality.weighted);
  r.set("unpolished_relative_error", id.unpolished.weighted);
  r.set("polished", id.polished);
  r.set("states", static_cast<std::int64_t>(id.model.order()));
  r.set("functions", static_cast<std::int64_t>(id.functions));
  if (!id.plane.discrete()) r.set("prewarp", id.plane.prewarp_rad_s);
  r.set("projected_poles", static_cast<std::int64_t>(id.model.moved));
  r.set("unstable_poles", static_cast<std::int64_t>(id.model.unstable));
  records::put_list<double>(r, "singular_values", "", id.singular_values);
  return r;
}

RecordBuilder order_scan_record(const OrderScan& scan) {
  const auto size = static_cast<Eigen::Index>(scan.orders.size());
  Eigen::MatrixXd columns(size, 6);
  for (Eigen::Index i = 0; i < size; ++i) {
    const ScannedOrder& one = scan.orders[static_cast<std::size_t>(i)];
    columns.row(i) << static_cast<double>(one.order), one.singular_value, one.validation.weighted, one.validation.rms,
        one.validation.maximum, static_cast<double>(one.unstable);
  }
  RecordBuilder r("order_scan");
  r.set("chosen", static_cast<std::int64_t>(scan.chosen));
  r.set("rule", scan.rule);
  const char* names[] = {"order", "singular_value", "validation_error", "validation_rms", "validation_max", "unstable_poles"};
  for (Eigen::Index c = 0; c < columns.cols(); ++c) records::put_list<double>(r, names[c], "1", columns.col(c));
  return r;
}

std::vector<std::string> model_warnings(const Identification& id, const Expected<ModelUncertainty>& uncertainty,
                                        const Settings& settings) {
  std::vector<std::string> warnings;
  if (id.model.unstable > 0)
    warnings.push_back(records::counted(id.model.unstable, "pole") +
                       " of the model are unstable; stability: project moves them, a lower order may need none");
  if (id.model.moved > 0)
    warnings.push_back(records::counted(id.model.moved, "pole") +
                       " came out unstable and have been moved into the stable half; a lower order may need none");
  if (id.scan && id.model.order() == settings.highest_order)
    warnings.push_back("the order is the highest that was tried, " + std::to_string(settings.highest_order) +
                       ": raise highest_order");
  if (id.quality.weighted > kPoor)
    warnings.push_back("the model leaves " + records::short_number(100.0 * id.quality.weighted, 2) +
                       " % of the response unexplained: raise the order, or look for a delay");
  if (!uncertainty) warnings.push_back("the model has no covariance: " + uncertainty.error().text);
  return warnings;
}

}  // namespace bodeflow::subspace
