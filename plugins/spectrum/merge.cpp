#include "merge.hpp"

#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "records.hpp"
#include "weighted_mean.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr double kSameFrequency = 1e-9;
constexpr double kDisagrees = 0.01;   // probability below which an entry counts
constexpr double kSurely = 0.001;     // probability that the worst of all entries is chance
constexpr double kCorrelated = 10.0;  // neighbouring lines of a local fit share data
constexpr std::size_t kNamed = 3;

/// A line of one experiment.
struct Place {
  double frequency_hz;
  std::size_t experiment;
  Eigen::Index row;
};

using Group = std::vector<Place>;  // lines at one frequency

/// What the tests of one experiment against the others gave.
struct Verdict {
  std::int64_t tests = 0, disagree = 0;
  double worst = 1.0;
  std::vector<std::pair<double, double>> lines;  // least probability of a line, frequency
};

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& n : names) text += (text.empty() ? "'" : ", '") + n + "'";
  return text;
}

std::string numbered(std::size_t experiment) { return "experiment " + std::to_string(experiment + 1); }

Expected<void> check_alike(const std::vector<ResponseData>& all) {
  const ResponseData& first = all.front();
  for (std::size_t e = 1; e < all.size(); ++e) {
    const ResponseData& d = all[e];
    const auto differs = [&](const char* what, const std::vector<std::string>& found, const std::vector<std::string>& needed) {
      return unexpected(numbered(e) + " has the " + what + " " + listed(found) + ", the first one " + listed(needed));
    };
    if (d.input_names != first.input_names) return differs("inputs", d.input_names, first.input_names);
    if (d.output_names != first.output_names) return differs("outputs", d.output_names, first.output_names);
    if (d.response_units != first.response_units) return differs("units", d.response_units, first.response_units);
    if ((d.variance.size() == 0) != (first.variance.size() == 0))
      return unexpected(numbered(d.variance.size() == 0 ? e : 0) + " has no variance, " +
                        numbered(d.variance.size() == 0 ? 0 : e) + " has one: they cannot be weighed");
  }
  return {};
}

std::vector<Group> groups_of(const std::vector<ResponseData>& all) {
  std::vector<Place> places;
  for (std::size_t e = 0; e < all.size(); ++e) {
    for (Eigen::Index k = 0; k < all[e].frequency_hz.size(); ++k) places.push_back({all[e].frequency_hz[k], e, k});
  }
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.frequency_hz < b.frequency_hz; });
  std::vector<Group> groups;
  for (const Place& p : places) {
    const bool same = !groups.empty() && p.frequency_hz - groups.back().front().frequency_hz <= kSameFrequency * p.frequency_hz;
    if (!same) groups.emplace_back();
    groups.back().push_back(p);
  }
  return groups;
}

class Merger {
 public:
  explicit Merger(const std::vector<ResponseData>& all) : all_(all), verdicts_(all.size()) {}

  Expected<ResponseData> run() {
    const std::vector<Group> groups = groups_of(all_);
    const auto lines = static_cast<Eigen::Index>(groups.size()), entries = all_.front().response.cols();
    certain_ = all_.front().variance.size() != 0;
    merged_.frequency_hz.resize(lines);
    merged_.response.resize(lines, entries);
    if (certain_) {
      merged_.variance.resize(lines, entries);
      merged_.confidence_radius.resize(lines, entries);
    }
    for (Eigen::Index row = 0; row < lines; ++row) {
      const Group& group = groups[static_cast<std::size_t>(row)];
      if (!certain_ && group.size() > 1)
        return unexpected("the experiments have no variance and overlap at " + short_number(group.front().frequency_hz) +
                          " Hz; give them bands of their own");
      combine(group, row);
    }
    attributes(groups);
    return merged_;
  }

 private:
  Uncertain entry(const Place& p, Eigen::Index c) const {
    const ResponseData& d = all_[p.experiment];
    return {d.response(p.row, c), certain_ ? d.variance(p.row, c) : 0.0,
            d.degrees_of_freedom.value_or(std::numeric_limits<double>::infinity())};
  }

  void combine(const Group& group, Eigen::Index row) {
    merged_.frequency_hz[row] = group.front().frequency_hz;
    for (Eigen::Index c = 0; c < merged_.response.cols(); ++c) {
      std::vector<Uncertain> numbers;
      for (const Place& p : group) numbers.push_back(entry(p, c));
      const Uncertain mean = weighted_mean(numbers);
      merged_.response(row, c) = mean.value;
      if (!certain_) continue;
      merged_.variance(row, c) = mean.variance;
      merged_.confidence_radius(row, c) = numerics::confidence_radius(mean.variance, mean.degrees_of_freedom, kConfidence);
      least_freedom_ = std::min(least_freedom_, mean.degrees_of_freedom);
      if (group.size() > 1) test(group, numbers);
    }
  }

  /// The one that stands farthest from the others counts: it draws their mean, so the others seem to disagree as well.
  void test(const Group& group, const std::vector<Uncertain>& numbers) {
    std::size_t farthest = 0;
    double least = 2.0;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      ++verdicts_[group[n].experiment].tests;
      std::vector<Uncertain> others = numbers;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(n));
      const double probability = agreement(numbers[n], weighted_mean(others));
      if (probability > least) continue;  // of two, which are equally far, the later one
      least = probability;
      farthest = group[n].experiment;
    }
    const double chosen = numbers.size() > 2 ? static_cast<double>(numbers.size()) : 1.0;  // it was the least of so many
    const double probability = std::min(1.0, chosen * least), frequency = group.front().frequency_hz;
    Verdict& v = verdicts_[farthest];
    v.worst = std::min(v.worst, probability);
    if (probability >= kDisagrees) return;
    ++v.disagree;
    if (v.lines.empty() || v.lines.back().second != frequency) v.lines.emplace_back(probability, frequency);
    v.lines.back().first = std::min(v.lines.back().first, probability);
  }

  void warn_of(std::size_t experiment) {
    Verdict& v = verdicts_[experiment];
    const double chance = kDisagrees * static_cast<double>(v.tests);
    const bool many = static_cast<double>(v.disagree) > chance + 4.0 * std::sqrt(kCorrelated * chance) + 2.0;
    if (!many && !(v.worst * static_cast<double>(v.tests) < kSurely)) return;
    std::stable_sort(v.lines.begin(), v.lines.end());
    std::string places;
    for (std::size_t i = 0; i < std::min(kNamed, v.lines.size()); ++i)
      places += (i == 0 ? "" : ", ") + short_number(v.lines[i].second) + " Hz";
    merged_.warnings.push_back(
        numbered(experiment) + " disagrees with the others beyond chance: " + std::to_string(v.disagree) + " of " +
        counted(v.tests, "value") + " (chance: " + short_number(std::round(chance)) + "), most at " + places +
        ": the plant or its operating point changed, or one experiment holds a transient or a disturbance; look "
        "at each on its own before merging");
  }

  /// The sum over the experiments, or nothing where one does not tell.
  std::optional<std::int64_t> sum(std::optional<std::int64_t> ResponseData::*of) const {
    std::int64_t total = 0;
    for (const ResponseData& d : all_) {
      if (!(d.*of)) return std::nullopt;
      total += *(d.*of);
    }
    return total;
  }
  template <class T>
  T common(T ResponseData::*of, const T& otherwise) const {
    const bool same = std::all_of(all_.begin(), all_.end(), [&](const ResponseData& d) { return d.*of == all_.front().*of; });
    return same ? all_.front().*of : otherwise;
  }

  // Where all experiments tell it.
  void largest_input() {
    merged_.input_amplitude.assign(all_.front().input_names.size(), 0.0);
    for (const ResponseData& d : all_) {
      if (d.input_amplitude.size() != merged_.input_amplitude.size()) return merged_.input_amplitude.clear();
      for (std::size_t j = 0; j < d.input_amplitude.size(); ++j)
        merged_.input_amplitude[j] = std::max(merged_.input_amplitude[j], d.input_amplitude[j]);
    }
  }

  void attributes(const std::vector<Group>& groups) {
    merged_.form = common(&ResponseData::form, std::string("merged"));
    merged_.method = "spectrum.merge";
    merged_.input_names = all_.front().input_names;
    merged_.output_names = all_.front().output_names;
    merged_.response_units = all_.front().response_units;
    merged_.periods = sum(&ResponseData::periods);
    merged_.realisations = sum(&ResponseData::realisations);
    merged_.dropped_samples = sum(&ResponseData::dropped_samples);
    merged_.sample_rate_hz = common(&ResponseData::sample_rate_hz, std::optional<double>());
    merged_.period = common(&ResponseData::period, std::optional<std::int64_t>());
    for (const ResponseData& d : all_) merged_.correlated_lines += d.correlated_lines;
    largest_input();
    if (certain_ && std::isfinite(least_freedom_)) merged_.degrees_of_freedom = least_freedom_;
    const bool numbered_lines = std::all_of(all_.begin(), all_.end(), [](const ResponseData& d) { return !d.lines.empty(); });
    if (numbered_lines && merged_.period && merged_.sample_rate_hz) {
      for (const Group& g : groups)
        merged_.lines.push_back(all_[g.front().experiment].lines[static_cast<std::size_t>(g.front().row)]);
    }
    for (std::size_t e = 0; e < all_.size(); ++e) {
      for (const std::string& w : all_[e].warnings) merged_.warnings.push_back(numbered(e) + ": " + w);
    }
    for (std::size_t e = 0; e < all_.size(); ++e) warn_of(e);
  }

  const std::vector<ResponseData>& all_;
  bool certain_ = false;
  double least_freedom_ = std::numeric_limits<double>::infinity();
  std::vector<Verdict> verdicts_;
  ResponseData merged_;
};

}  // namespace

Expected<ResponseData> merge(const std::vector<ResponseData>& experiments) {
  if (experiments.empty()) return unexpected("no record to merge; needed: at least one");
  if (auto done = check_alike(experiments); !done) return unexpected(done.error().text);
  return Merger(experiments).run();
}

}  // namespace bodeflow::spectrum
