#include "change_record.hpp"

#include <cmath>
#include <limits>

#include "records/record_arrays.hpp"
#include "records/response_units.hpp"

namespace bodeflow::validation {
namespace {

using Complex = std::complex<double>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void put_lines(RecordBuilder& r, const ResponseChange& c) {
  const Eigen::Index lines = c.entries.front().lines.lines(), count = static_cast<Eigen::Index>(c.entries.size());
  std::vector<std::string> units;
  for (const EntryChange& e : c.entries) units.push_back(e.unit);
  const std::string unit = records::common_unit(units);
  Eigen::MatrixXcd before(lines, count), after(lines, count);
  Eigen::MatrixXd deviation(lines, count), significance(lines, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const EntryChange& e = c.entries[static_cast<std::size_t>(i)];
    before.col(i) = e.lines.before;
    after.col(i) = e.lines.after;
    for (Eigen::Index k = 0; k < lines; ++k) {
      const double v = e.lines.variance(k);
      deviation(k, i) = v > 0.0 ? std::sqrt(v) : kNaN;
      significance(k, i) = v > 0.0 ? e.spectrum.significance[k] : kNaN;
    }
  }
  records::put_list<double>(r, "frequency", "Hz", c.entries.front().lines.frequency_hz);
  const auto shape = {static_cast<std::uint64_t>(lines), static_cast<std::uint64_t>(count)};
  records::put<Complex>(r, "before", unit, shape, before);
  records::put<Complex>(r, "after", unit, shape, after);
  records::put_matrix(r, "change_deviation", unit, deviation);
  records::put_matrix(r, "significance", "", significance);
}

/// A value of each band of each entry.
template <class Value>
void put_bands(RecordBuilder& r, const ResponseChange& c, const char* name, const char* unit, Value value) {
  const std::size_t bands = c.entries.front().spectrum.bands.size();
  Eigen::MatrixXd m(static_cast<Eigen::Index>(c.entries.size()), static_cast<Eigen::Index>(bands));
  for (std::size_t i = 0; i < c.entries.size(); ++i)
    for (std::size_t b = 0; b < bands; ++b)
      m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(b)) = value(c.entries[i].spectrum.bands[b]);
  records::put_matrix(r, name, unit, m);
}

void put_all_bands(RecordBuilder& r, const ResponseChange& c) {
  std::vector<double> low, high;
  for (const BandChange& b : c.entries.front().spectrum.bands) {
    low.push_back(b.low_hz);
    high.push_back(b.high_hz);
  }
  const auto list = [&](const char* name, const std::vector<double>& v) {
    records::put_list<double>(r, name, "Hz", Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())));
  };
  list("band_low", low);
  list("band_high", high);
  put_bands(r, c, "band_change", "", [](const BandChange& b) { return b.relative; });
  put_bands(r, c, "band_probability", "", [](const BandChange& b) { return b.probability; });
  put_bands(r, c, "band_detectable", "", [](const BandChange& b) { return b.detectable; });
  put_bands(r, c, "band_correlation", "", [](const BandChange& b) { return b.correlation; });
  put_bands(r, c, "band_factor", "", [](const BandChange& b) { return b.factor; });
  put_bands(r, c, "band_strongest", "Hz", [](const BandChange& b) { return b.strongest_hz; });
}

/// A value of each entry, in so many columns.
template <class Value>
void put_entries(RecordBuilder& r, const ResponseChange& c, const char* name, Eigen::Index columns, Value value) {
  Eigen::MatrixXd m(static_cast<Eigen::Index>(c.entries.size()), columns);
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < columns; ++j)
      m(i, j) = value(c.entries[static_cast<std::size_t>(i)], static_cast<std::size_t>(j));
  if (columns == 1) {
    records::put_list<double>(r, name, "", m.col(0));
  } else {
    records::put_matrix(r, name, "", m);
  }
}

void put_modes(RecordBuilder& r, const ResponseChange& c) {
  std::vector<std::pair<double, const ModeChange*>> all;
  std::vector<std::string> status;
  for (std::size_t i = 0; i < c.entries.size(); ++i)
    for (const ModeChange& m : c.entries[i].modes) {
      all.emplace_back(static_cast<double>(i), &m);
      status.push_back(status_text(m.status));
    }
  r.set("mode_status", status);
  if (all.empty()) return;
  const auto put = [&](const std::string& name, const char* unit, auto value) {
    Eigen::VectorXd v(static_cast<Eigen::Index>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) v[static_cast<Eigen::Index>(i)] = value(*all[i].second);
    records::put_list<double>(r, name.c_str(), unit, v);
  };
  Eigen::VectorXd entry(static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) entry[static_cast<Eigen::Index>(i)] = all[i].first;
  records::put_list<double>(r, "mode_entry", "", entry);
  put("mode_probability", "", [](const ModeChange& m) { return m.probability; });
  for (const bool after : {false, true}) {
    const std::string when = after ? "after" : "before";
    const auto of = [after](auto value) {
      return [after, value](const ModeChange& m) {
        const auto& mode = after ? m.after : m.before;
        return mode ? value(*mode) : kNaN;
      };
    };
    put("mode_frequency_" + when, "Hz", of([](const Mode& m) { return m.frequency_hz(); }));
    put("mode_frequency_" + when + "_deviation", "Hz", of([](const Mode& m) { return std::sqrt(m.frequency_variance()); }));
    put("mode_damping_" + when, "", of([](const Mode& m) { return m.damping(); }));
    put("mode_damping_" + when + "_deviation", "", of([](const Mode& m) { return std::sqrt(m.damping_variance()); }));
  }
  put("mode_frequency_shift", "", [](const ModeChange& m) { return m.frequency_shift; });
  put("mode_frequency_shift_deviation", "", [](const ModeChange& m) { return m.frequency_shift_deviation; });
  put("mode_damping_shift", "", [](const ModeChange& m) { return m.damping_shift; });
  put("mode_damping_shift_deviation", "", [](const ModeChange& m) { return m.damping_shift_deviation; });
  put("mode_inertia_ratio", "", [](const ModeChange& m) { return std::pow(1.0 + m.frequency_shift, -2.0); });
  put("mode_inertia_ratio_deviation", "",
      [](const ModeChange& m) { return 2.0 * std::pow(1.0 + m.frequency_shift, -3.0) * m.frequency_shift_deviation; });
}

}  // namespace

RecordBuilder write_change(const ResponseChange& c, const ChangeSettings& settings) {
  RecordBuilder r("change");
  r.set("verdict", verdict_text(c.verdict));
  r.set("conclusion", c.conclusion);
  r.set("scatter", c.scatter);
  r.set("scatter_known", c.scatter_known);
  r.set("variance_known", c.variance_known);
  r.set("confidence", settings.spectrum.confidence);
  r.set("relevant", settings.spectrum.relevant);
  r.set("interpolated_lines", static_cast<std::int64_t>(c.interpolated));
  r.set("warnings", c.warnings);
  std::vector<std::string> names, verdicts, units, bands, degrees;
  for (const EntryChange& e : c.entries) {
    names.push_back(e.name);
    verdicts.push_back(verdict_text(e.spectrum.verdict));
    units.push_back(e.unit);
    degrees.push_back(e.standard.deformation);
    for (const BandChange& b : e.spectrum.bands) bands.push_back(verdict_text(b.verdict));
  }
  r.set("entries", names);
  r.set("entry_verdicts", verdicts);
  r.set("units", units);
  r.set("band_verdicts", bands);
  r.set("dl_911", degrees);
  put_lines(r, c);
  put_all_bands(r, c);
  put_entries(r, c, "correlation", 1, [](const EntryChange& e, std::size_t) { return e.correlation; });
  put_entries(r, c, "factor", 1, [](const EntryChange& e, std::size_t) { return e.factor; });
  put_entries(r, c, "dl_911_factors", 3, [](const EntryChange& e, std::size_t b) { return e.standard.bands[b].factor; });
  const auto model = [](const EntryChange& e, std::size_t after) -> const std::optional<FittedModes>& {
    return after == 1 ? e.after : e.before;
  };
  put_entries(r, c, "orders", 2,
              [&](const EntryChange& e, std::size_t a) { return model(e, a) ? static_cast<double>(model(e, a)->order) : kNaN; });
  put_entries(r, c, "fit", 2, [&](const EntryChange& e, std::size_t a) { return model(e, a) ? model(e, a)->fit : kNaN; });
  put_modes(r, c);
  return r;
}

}  // namespace bodeflow::validation
