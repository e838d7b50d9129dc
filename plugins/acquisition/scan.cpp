#include "scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sampling.hpp"
#include "summary.hpp"

namespace bodeflow::acquisition {
namespace {

// Rows are read so many at a time, fewer where there are many columns.
constexpr std::size_t kMostRows = 4096;
constexpr std::size_t kMostValues = std::size_t{1} << 18;
// A moment this near to a row is that row's, in sampling intervals or relative to the time itself.
constexpr double kSameMoment = 1e-6;
constexpr std::int64_t kNoEnd = std::numeric_limits<std::int64_t>::max();

Unexpected<Error> forward(const Error& e) { return {e}; }

/// Where a column stands in a tree of names: "a/b" of "a/b/t".
std::string branch(const std::string& header) {
  const auto end = header.find_last_of("/.");
  return end == std::string::npos ? "" : header.substr(0, end);
}

/// Refuses a stated unit of time where the time column has another, or where there is no column that it could belong to.
Expected<std::optional<std::size_t>> checked_unit(const TableReader& table, std::optional<std::size_t> time,
                                                  const Timing& timing) {
  if (timing.time_unit.empty()) return time;
  if (!time)
    return unexpected(table.file() +
                      ": time_unit: no column `t` or `time` that holds time; name the one that does with time_column");
  const Column& c = table.columns()[*time];
  if (!c.unit.empty() && seconds_per(c.unit) != seconds_per(timing.time_unit)) {
    return unexpected(table.file() + ": time_unit: " + timing.time_unit + " is stated, but column '" + c.header +
                      "' has the unit " + c.unit + "; leave time_unit out, or correct the file");
  }
  return time;
}

std::string hertz(double rate) { return number_text(rate) + " Hz"; }

/// Refuses columns of different length, and of different rates; the common rate, unknown where the file states none.
Expected<Rate> common_rate(const TableReader& table, std::span<const std::size_t> columns) {
  const Column* longest = nullptr;
  const Column* timed = nullptr;
  for (const std::size_t i : columns) {
    const Column& c = table.columns()[i];
    if (longest == nullptr) longest = &c;
    if (c.rows != longest->rows) {
      return unexpected(table.file() + ": columns of different length: '" + longest->header + "' has " +
                        std::to_string(longest->rows) + " rows, '" + c.header + "' has " + std::to_string(c.rows) +
                        "; name columns of one length");
    }
    if (!c.rate.known()) continue;
    if (timed != nullptr && c.rate != timed->rate) {
      return unexpected(table.file() + ": two sampling rates: '" + timed->header + "' has " + hertz(timed->rate.hz()) + ", '" +
                        c.header + "' has " + hertz(c.rate.hz()) + "; read each with a block of its own");
    }
    timed = &c;
  }
  return timed == nullptr ? Rate() : timed->rate;
}

/// One pass over the part.
class Scan {
 public:
  Scan(TableReader& table, std::span<const std::size_t> selected, std::optional<std::size_t> time, const Timing& timing,
       const Part& part)
      : table_(table), selected_(selected), time_(time), timing_(timing), part_(part), columns_(selected.size()) {}

  Expected<TableSummary> run();

 private:
  Expected<void> find_rate();
  Expected<void> find_part();
  void order_columns();
  Expected<bool> take(std::size_t rows);
  Expected<void> check_finite(std::size_t from, std::size_t to) const;
  Expected<void> check_end() const;
  Expected<void> conclude();

  double time_of(std::size_t n) const { return buffers_.front()[n] * seconds_; }
  std::span<const double> values(std::size_t place, std::size_t from, std::size_t to) const {
    return std::span<const double>(buffers_[place]).subspan(from, to - from);
  }

  TableReader& table_;
  std::span<const std::size_t> selected_;
  std::optional<std::size_t> time_;
  const Timing& timing_;
  const Part& part_;
  Rate file_rate_;
  std::vector<std::size_t> order_;   // columns as they are read: time first
  std::vector<std::size_t> places_;  // of the selected columns in order_
  std::vector<std::vector<double>> buffers_;
  double seconds_ = 1.0;  // per unit of the time column
  std::int64_t row_ = 0;  // the next to be read
  std::int64_t first_ = 0, end_ = kNoEnd;
  Sampling times_;
  std::vector<SummaryOfColumn> columns_;
  TableSummary found_;
};

Expected<void> Scan::find_rate() {
  std::vector<std::size_t> all(selected_.begin(), selected_.end());
  if (time_) all.push_back(*time_);
  auto rate = common_rate(table_, all);
  if (!rate) return forward(rate.error());
  file_rate_ = timing_.ignore_time_column ? Rate() : *rate;
  if (file_rate_.known() && timing_.rate_hz && std::abs(file_rate_.hz() / *timing_.rate_hz - 1.0) > kSameMoment) {
    return unexpected(table_.file() + ": the file states " + hertz(file_rate_.hz()) + ", parameter rate says " +
                      hertz(*timing_.rate_hz) + "; time: ignore reads the file by the rate alone");
  }
  if (time_ || file_rate_.known() || timing_.rate_hz) return {};
  std::string text = table_.file() +
                     ": no sampling rate and no time column (`t` or `time` with a unit of time, such as `t [s]`); give the "
                     "sampling rate, such as rate: 2500 Hz";
  const auto& columns = table_.columns();
  const auto unnamed =
      std::find_if(columns.begin(), columns.end(), [](const Column& c) { return is_named_time(c) && c.unit.empty(); });
  if (unnamed != columns.end()) text += ", or if '" + unnamed->header + "' holds time its unit, such as time_unit: s";
  const auto timed =
      std::find_if(columns.begin(), columns.end(), [](const Column& c) { return seconds_per(c.unit).has_value(); });
  if (timed != columns.end()) text += ", or if '" + timed->header + "' holds time name it with time_column";
  return unexpected(text);
}

/// The part as rows, where it is known before the times are read.
Expected<void> Scan::find_part() {
  first_ = part_.start;
  if (part_.count) end_ = *part_.count > kNoEnd - first_ ? kNoEnd : first_ + *part_.count;
  if (!part_.by_time() || time_) return {};
  const double rate = file_rate_.known() ? file_rate_.hz() : *timing_.rate_hz;
  const auto row_at = [&](double time) {
    return static_cast<std::int64_t>(std::ceil(std::min(time * rate, 9e15) - kSameMoment));
  };
  if (part_.from_s) first_ = std::max<std::int64_t>(row_at(*part_.from_s), 0);
  if (part_.to_s) end_ = std::max(row_at(*part_.to_s), first_);
  return {};
}

void Scan::order_columns() {
  if (time_) order_.push_back(*time_);
  for (const std::size_t c : selected_) {
    if (time_ == c) {
      places_.push_back(0);
      continue;
    }
    places_.push_back(order_.size());
    order_.push_back(c);
  }
  buffers_.assign(order_.size(), std::vector<double>(std::clamp<std::size_t>(kMostValues / order_.size(), 1, kMostRows)));
}

Expected<void> Scan::check_finite(std::size_t from, std::size_t to) const {
  std::size_t first_bad = to, column = 0;
  for (std::size_t c = 0; c < order_.size(); ++c) {
    const auto x = values(c, from, to);
    std::size_t bad = 0;
    for (const double value : x) bad += std::abs(value) <= std::numeric_limits<double>::max() ? 0 : 1;
    if (bad == 0) continue;
    const auto at = std::find_if(x.begin(), x.end(), [](double value) { return !std::isfinite(value); });
    const std::size_t n = from + static_cast<std::size_t>(at - x.begin());
    if (n >= first_bad) continue;
    first_bad = n;
    column = c;
  }
  if (first_bad == to) return {};
  return unexpected(table_.place(first_bad) + ": column '" + table_.columns()[order_[column]].header +
                    "': " + number_text(buffers_[column][first_bad]) + " is not finite");
}

/// Takes the rows that lie in the part, of those just read; false when the part is complete.
Expected<bool> Scan::take(std::size_t rows) {
  std::size_t from = 0, to = rows;
  if (end_ - row_ < static_cast<std::int64_t>(rows)) to = static_cast<std::size_t>(end_ - row_);
  const auto before = [&](std::size_t n, double moment) { return time_of(n) < moment - 1e-9 * std::abs(moment); };
  if (time_ && part_.from_s && found_.rows == 0) {
    while (from < to && before(from, *part_.from_s)) ++from;
    first_ = row_ + static_cast<std::int64_t>(from);
  }
  if (time_ && part_.to_s) {
    std::size_t n = from;
    while (n < to && (before(n, *part_.to_s) || std::isnan(time_of(n)))) ++n;
    if (n < to) end_ = row_ + static_cast<std::int64_t>(n);
    to = n;
  }
  row_ += static_cast<std::int64_t>(rows);
  if (auto done = check_finite(from, to); !done) return forward(done.error());
  if (time_) {
    for (std::size_t n = from; n < to; ++n) {
      if (const auto wrong = times_.add(time_of(n))) return unexpected(table_.place(n) + ": " + *wrong);
    }
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) columns_[c].add(values(places_[c], from, to));
  found_.rows += static_cast<std::int64_t>(to - from);
  return row_ < end_;
}

Expected<void> Scan::check_end() const {
  const std::string& file = table_.file();
  if (row_ == 0 && first_ == 0) return unexpected(file + ": no rows");
  if (part_.by_time()) {
    const bool to_missed = part_.to_s && end_ == kNoEnd;
    const bool end_missed = !time_ && end_ != kNoEnd && row_ < end_;
    if (found_.rows > 0 && !to_missed && !end_missed) return {};
    std::string asked = part_.from_s ? "from " + number_text(*part_.from_s) + " s" : "from the first row";
    if (part_.to_s) asked += " to " + number_text(*part_.to_s) + " s";
    if (found_.rows == 0) return unexpected(file + ": no rows " + asked);
    return unexpected(file + ": rows " + asked + " are asked for, but the file ends before");
  }
  if (found_.rows > 0 && (end_ == kNoEnd || row_ >= end_)) return {};
  const std::string asked = part_.count ? "rows " + std::to_string(first_ + 1) + " to " + std::to_string(end_)
                                        : "rows from " + std::to_string(first_ + 1) + " on";
  return unexpected(file + ": " + asked + " are asked for, but the file ends before");
}

/// The rate, and what the columns held.
Expected<void> Scan::conclude() {
  const std::string& file = table_.file();
  const double resolution = table_.resolution() * seconds_;
  found_.first_row = first_;
  if (file_rate_.known()) {
    found_.origin = RateOrigin::file;
    found_.rate = file_rate_;
  } else if (timing_.rate_hz) {
    found_.origin = RateOrigin::stated;
    found_.rate = Rate::from_hz(*timing_.rate_hz);
  } else {
    found_.origin = RateOrigin::time_column;
    found_.rate = times_.rate(resolution);
  }
  if (!found_.rate.known()) {
    return unexpected(file + (timing_.rate_hz ? ": a rate of " + hertz(*timing_.rate_hz) + " is beyond what can be kept"
                                              : ": one row, so the time column gives no sampling rate"));
  }
  if (time_ && !times_.agrees_with(found_.rate.hz())) {
    return unexpected(file + ": the time column says " + hertz(times_.rate(resolution).hz()) + ", " +
                      (file_rate_.known() ? "the file states " : "parameter rate says ") + hertz(found_.rate.hz()) +
                      "; time: ignore reads the file by the rate alone");
  }
  for (const SummaryOfColumn& c : columns_) found_.columns.push_back(c.result());
  found_.remarks = table_.remarks();
  return {};
}

Expected<TableSummary> Scan::run() {
  if (auto done = find_rate(); !done) return forward(done.error());
  if (auto done = find_part(); !done) return forward(done.error());
  if (time_) {
    const std::string& unit = table_.columns()[*time_].unit;
    seconds_ = *seconds_per(unit.empty() ? timing_.time_unit : unit);
  }
  order_columns();
  row_ = first_;
  if (auto done = table_.start(order_, row_); !done) return forward(done.error());
  std::vector<double*> to;
  for (auto& b : buffers_) to.push_back(b.data());
  bool more = row_ < end_;
  while (more) {
    const auto wanted =
        static_cast<std::size_t>(std::min<std::int64_t>(end_ - row_, static_cast<std::int64_t>(buffers_.front().size())));
    const auto rows = table_.read(to, wanted);
    if (!rows) return forward(rows.error());
    const auto taken = take(*rows);
    if (!taken) return forward(taken.error());
    more = *taken && *rows == wanted;
  }
  if (auto done = check_end(); !done) return forward(done.error());
  if (auto done = conclude(); !done) return forward(done.error());
  return std::move(found_);
}

}  // namespace

Expected<std::optional<std::size_t>> find_time_column(const TableReader& table, std::span<const std::size_t> selected,
                                                      const Timing& timing) {
  using Found = std::optional<std::size_t>;
  if (timing.ignore_time_column) return Found();
  const auto& columns = table.columns();
  const auto holds_time = [&](const Column& c) { return seconds_per(c.unit.empty() ? timing.time_unit : c.unit).has_value(); };
  if (!timing.time_column.empty()) {
    const auto found = find_column(columns, timing.time_column, table.leftovers());
    if (!found) return unexpected(table.file() + ": time_column: " + found.error().text);
    const Column& c = columns[*found];
    if (!holds_time(c)) {
      return unexpected(
          table.file() + ": time_column: '" + c.header + "' has " +
          (c.unit.empty() ? "no unit; state it, such as time_unit: s" : "the unit " + c.unit + ", no unit of time"));
    }
    return checked_unit(table, *found, timing);
  }
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (is_named_time(columns[i]) && holds_time(columns[i])) candidates.push_back(i);
  }
  std::vector<std::size_t> beside;  // the columns, of those in a tree
  for (const std::size_t i : candidates) {
    if (!selected.empty() && branch(columns[i].header) == branch(columns[selected.front()].header)) beside.push_back(i);
  }
  if (candidates.size() == 1) return checked_unit(table, candidates.front(), timing);
  if (candidates.empty()) return checked_unit(table, std::nullopt, timing);
  if (beside.size() == 1) return checked_unit(table, beside.front(), timing);
  return unexpected(table.file() + ": several time columns, '" + columns[candidates[0]].header + "' and '" +
                    columns[candidates[1]].header + "'; say which by time_column");
}

Expected<TableSummary> scan_table(TableReader& table, std::span<const std::size_t> selected, std::optional<std::size_t> time,
                                  const Timing& timing, const Part& part) {
  return Scan(table, selected, time, timing, part).run();
}

}  // namespace bodeflow::acquisition
