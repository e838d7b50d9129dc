#include "emission.hpp"

#include "model_record.hpp"

namespace bodeflow::sanathanan_koerner {

Emission identified(const std::string& block, const Measured& measured, const std::optional<Measured>& repeated,
                    Settings settings) {
  settings.known_variance = measured.known_variance;
  std::optional<Data> repeat;
  if (repeated) {
    if (repeated->data.channels() != measured.data.channels())
      fail("the repeated response has " + std::to_string(repeated->data.channels()) + " entries, the response " +
           std::to_string(measured.data.channels()));
    repeat = repeated->data;
  }
  const auto found = identify(measured.data, settings, static_cast<Eigen::Index>(measured.inputs.names.size()), repeat);
  if (!found) fail(found.error().text);
  std::vector<std::string> warnings = model_warnings(*found, measured, settings);
  RecordBuilder model = model_record(*found, measured, block, warnings);
  std::optional<RecordBuilder> scan;
  if (found->scan) scan = order_scan_record(*found->scan);
  return {std::move(model), residual_record(measured, found->response, block), std::move(scan), std::move(warnings)};
}

}  // namespace bodeflow::sanathanan_koerner
