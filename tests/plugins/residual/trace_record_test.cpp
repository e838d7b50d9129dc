#include "trace/trace_record.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "catch.hpp"
#include "fake_measurement.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::test;

namespace {

TraceData records(double hidden, bool floor_known) {
  FakeRecord r;
  r.floor_known = floor_known;
  TraceData d;
  const char* names[] = {"fit 1", "fit 2", "select", "test"};
  for (std::uint64_t n = 0; n < 4; ++n) {
    r.name = names[n];
    r.level = n == 0 ? 0.5 : 1.0;
    r.seed = 60 + n;
    const auto m = measure(r, [hidden](double at, double) { return hidden * std::sin(0.2 * at); });
    if (n < 2) d.fit.push_back(m);
    if (n == 2) d.select = m;
    if (n == 3) d.test = m;
  }
  return d;
}

/// A trace with its record, as blocks read it.
class Written {
 public:
  Written(double hidden, bool floor_known)
      : data(records(hidden, floor_known)),
        found(trace(std::make_shared<FakeBase>(), {one_sided("ripple", [](double n, double) { return std::sin(0.2 * n); })}, data,
                    {})
                  .value()) {
    const RecordBuilder record = write_trace(found, data, {"fake", {}, {}});
    lines_.resize(static_cast<std::size_t>(record.size()) / sizeof(Line));
    record.write(lines_.data());
    view_ = RecordView::check({lines_.front().bytes, static_cast<std::size_t>(record.size())}).value();
  }

  std::vector<double> list(const char* name) const {
    const auto array = view_->array(name);
    if (!array) return {};
    return {array->as<double>().begin(), array->as<double>().end()};
  }
  const RecordView& view() const { return *view_; }

  TraceData data;
  Trace found;

 private:
  struct alignas(64) Line {
    std::uint8_t bytes[64];
  };
  std::vector<Line> lines_;
  std::optional<RecordView> view_;
};

}  // namespace

TEST_CASE("trace record: errors of all records stand in their order, before and after") {
  const Written w(0.9, true);
  REQUIRE(w.found.added());
  const auto before = w.list("record_error_before"), after = w.list("record_error_after"), noise = w.list("record_noise");
  REQUIRE(before.size() == 4);
  REQUIRE(after.size() == 4);
  CHECK(noise == std::vector<double>{1.0, 1.0, 1.0, 1.0});
  CHECK(before[1] == w.data.fit[1]->error(w.found.searched.base.fit.residual.tail(300)).error);
  CHECK(before[2] == w.data.select->error(w.found.searched.base.select.residual).error);
  CHECK(before[3] == w.found.before.error);
  CHECK(after[3] == w.found.after.error);
  for (std::size_t n = 0; n < 4; ++n) {
    CHECK(before[n] > 1.1);  // sqrt(1 + 0.9^2 / 2) = 1.19
    CHECK(after[n] < 1.1);
  }
}

TEST_CASE("trace record: classes of the test record are told beside those that are judged") {
  const Written w(0.9, true);
  const auto before = w.list("test_class_before"), after = w.list("test_class_after"), p = w.list("test_class_p_after");
  REQUIRE(before.size() == 1);
  CHECK(before[0] > 1.1);
  CHECK(after[0] < 1.1);
  CHECK(p[0] > 1e-3);
  CHECK(w.list("class_before").size() == 3);
  CHECK(w.list("class_rms_before").empty());
  CHECK_FALSE(w.view().array("map_at"));
}

TEST_CASE("trace record: where nothing was added both columns are one") {
  const Written w(0.0, true);
  REQUIRE(w.found.verdict == Verdict::none);
  CHECK(w.list("record_error_before") == w.list("record_error_after"));
  CHECK(w.list("test_class_before") == w.list("test_class_after"));
  CHECK(w.view().number("noise_floor_0.01").value() < w.list("record_error_before")[3]);
}

TEST_CASE("trace record: an unknown floor is not a number") {
  const Written w(0.9, false);
  for (const double noise : w.list("record_noise")) CHECK(std::isnan(noise));
  CHECK(w.list("record_error_before")[3] == w.found.before.error);
}
