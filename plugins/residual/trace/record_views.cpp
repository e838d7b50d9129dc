#include "trace/record_views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "records/record_arrays.hpp"

namespace bodeflow::residual {
namespace {

// Signals that are so much alike show the same.
constexpr double kAlike = 0.995;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A record with what the base model leaves of it, and the model that is told.
struct Left {
  const Measurement* record;
  Eigen::VectorXd before, after;
};

/// In the order of `records`: those fitted, the selecting one, the test record.
std::vector<Left> left_of(const Trace& t, const TraceData& data) {
  std::vector<Left> all;
  Eigen::Index begin = 0;
  for (const auto& record : data.fit) {
    all.push_back({record.get(), t.searched.base.fit.residual.segment(begin, record->rows()),
                   t.extended().fit.residual.segment(begin, record->rows())});
    begin += record->rows();
  }
  all.push_back({data.select.get(), t.searched.base.select.residual, t.extended().select.residual});
  all.push_back({data.test.get(), t.test_before.residual, t.added() ? t.test_after.residual : t.test_before.residual});
  return all;
}

bool alike(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return std::abs(x.dot(y)) >= kAlike * x.norm() * y.norm();
}

/// Those that are finite and no straight line of one before them.
std::vector<SeenOver> distinct(const std::vector<SeenOver>& all) {
  std::vector<SeenOver> some;
  for (const SeenOver& signal : all) {
    const bool known = std::any_of(some.begin(), some.end(), [&](const SeenOver& s) { return alike(s.values, signal.values); });
    if (signal.values.allFinite() && !known) some.push_back(signal);
  }
  return some;
}

void put_maps(RecordBuilder& r, const std::vector<SeenOver>& over, const std::vector<MeanMap>& before,
              const std::vector<MeanMap>& after, const std::string& unit) {
  std::vector<std::string> names, units;
  Eigen::Index bins = 0;
  for (std::size_t n = 0; n < over.size(); ++n) {
    names.push_back(over[n].name);
    units.push_back(over[n].unit);
    bins = std::max(bins, before[n].at.size());
  }
  const auto table = [&](const std::vector<MeanMap>& maps, Eigen::VectorXd MeanMap::*member) {
    Eigen::MatrixXd m = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(maps.size()), bins, kNone);
    for (std::size_t n = 0; n < maps.size(); ++n)
      m.row(static_cast<Eigen::Index>(n)).head((maps[n].*member).size()) = (maps[n].*member).transpose();
    return m;
  };
  r.set("map_signals", names).set("map_units", units);
  records::put_matrix(r, "map_at", "", table(before, &MeanMap::at));
  records::put_matrix(r, "map_before", unit, table(before, &MeanMap::mean));
  records::put_matrix(r, "map_before_std", unit, table(before, &MeanMap::std));
  records::put_matrix(r, "map_after", unit, table(after, &MeanMap::mean));
  records::put_matrix(r, "map_after_std", unit, table(after, &MeanMap::std));
}

}  // namespace

void put_sizes(RecordBuilder& r, const Trace& t, const TraceData& data, const std::vector<std::string>& classes) {
  const std::vector<Left> all = left_of(t, data);
  const MeasurementFacts& facts = all.back().record->facts();
  const auto rows = static_cast<Eigen::Index>(all.size()), columns = static_cast<Eigen::Index>(classes.size());
  Eigen::VectorXd before(rows), after(rows), floor(rows);
  Eigen::MatrixXd rms_before = Eigen::MatrixXd::Constant(rows, columns, kNone), rms_after = rms_before, noise = rms_before;
  for (Eigen::Index n = 0; n < rows; ++n) {
    const Left& left = all[static_cast<std::size_t>(n)];
    const HeldOutError error = left.record->error(left.before);
    before[n] = error.error;
    after[n] = left.record->error(left.after).error;
    floor[n] = error.floor;
    const auto fill = [&](const Eigen::VectorXd& residual, Eigen::MatrixXd& rms) {
      for (const ClassSize& size : left.record->class_sizes(residual)) {
        const auto c = std::find(classes.begin(), classes.end(), size.name);
        if (c == classes.end()) continue;
        rms(n, c - classes.begin()) = size.rms;
        noise(n, c - classes.begin()) = size.noise;
      }
    };
    fill(left.after, rms_after);
    fill(left.before, rms_before);
  }
  records::put_list<double>(r, "record_error_before", facts.unit_of_error(), before);
  records::put_list<double>(r, "record_error_after", facts.unit_of_error(), after);
  records::put_list<double>(r, "record_noise", facts.unit_of_error(), floor);
  if (!(noise.array() >= 0.0).any()) return;
  records::put_matrix(r, "class_rms_before", facts.output_unit, rms_before);
  records::put_matrix(r, "class_rms_after", facts.output_unit, rms_after);
  records::put_matrix(r, "class_rms_noise", facts.output_unit, noise);
}

void put_views(RecordBuilder& r, const Trace& t, const Measurement& test) {
  const HeldOut& told = t.added() ? t.test_after : t.test_before;
  const std::vector<SeenOver> over = distinct(test.signals(t.extended().fit.model, told.values, told.residual));
  if (over.empty()) return;
  const ResidualViews before = test.views(t.test_before.residual, over), after = test.views(t.test_after.residual, over);
  const std::string unit = test.facts().output_unit;
  put_maps(r, over, before.maps, after.maps, unit);
  r.set("course_axis", before.course.axis).set("course_noise", before.course.noise);
  records::put_list<double>(r, "course_at", before.course.axis == "time" ? "s" : "", before.course.at);
  records::put_list<double>(r, "course_before", unit, before.course.rms);
  records::put_list<double>(r, "course_after", unit, after.course.rms);
  if (before.autocorrelation.lag_s.size() == 0 || after.autocorrelation.lag_s.size() == 0) return;
  r.set("autocorrelation_band", before.autocorrelation.band);
  records::put_list<double>(r, "autocorrelation_lag", "s", before.autocorrelation.lag_s);
  records::put_list<double>(r, "autocorrelation_before", "1", before.autocorrelation.value);
  records::put_list<double>(r, "autocorrelation_after", "1", after.autocorrelation.value);
}

}  // namespace bodeflow::residual
