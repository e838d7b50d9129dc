#include "sweep_quantities.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace bodeflow::validation {
namespace {

using Complex = std::complex<double>;

/// An array of a sweep: `entries` values a run.
struct Stacked {
  ArrayView array;
  Eigen::Index runs = 0;
  Eigen::Index entries = 0;

  std::size_t place(Eigen::Index run, Eigen::Index entry) const { return static_cast<std::size_t>(run * entries + entry); }
};

Expected<Stacked> stacked(const ArrayView& array, Eigen::Index runs) {
  const std::string name = "array '" + std::string(array.name) + "'";
  if (array.element != BF_F64 && array.element != BF_C64 && array.element != BF_I64)
    return unexpected(name + " holds " + element_name(array.element) + "; needed: numbers");
  if (array.shape.empty() || array.shape[0] != static_cast<std::uint64_t>(runs) || array.size == 0)
    return unexpected(name + " does not hold values of each of the " + std::to_string(runs) + " runs");
  return Stacked{array, runs, static_cast<Eigen::Index>(array.size) / runs};
}

/// "" for a number a run, "[3]", "[3,0,0]".
std::string index_text(const Stacked& s, Eigen::Index entry) {
  const auto shape = s.array.shape.subspan(1);
  std::string text;
  for (std::size_t d = shape.size(); d-- > 0;) {
    const auto size = static_cast<Eigen::Index>(shape[d]);
    text = std::to_string(entry % size) + (text.empty() ? "" : "," + text);
    entry /= size;
  }
  return text.empty() ? "" : "[" + text + "]";
}

std::vector<std::string> texts_of(const RecordView& record, const char* name, Eigen::Index count) {
  const auto texts = record.texts(name);
  if (!texts || texts->size() != static_cast<std::size_t>(count)) return {};
  return {texts->begin(), texts->end()};
}

/// What an entry of the array is called and measured in.
struct Label {
  std::string name, unit;
};

Label label_of(const RecordView& sweep, const Stacked& s, Eigen::Index entry) {
  const std::string name(s.array.name);
  Label label{name + index_text(s, entry), std::string(s.array.unit)};
  if (name != "parameters") return label;
  const auto at = static_cast<std::size_t>(entry);
  if (const auto names = texts_of(sweep, "parameter_names", s.entries); !names.empty()) label.name = names[at];
  if (const auto units = texts_of(sweep, "parameter_units", s.entries); !units.empty()) label.unit = units[at];
  return label;
}

/// The standard deviations that the runs state of a parameter; empty where they state none that are finite.
Eigen::VectorXd deviation_of(const RecordView& sweep, const Stacked& s, Eigen::Index entry) {
  if (s.array.name != "parameters" || s.array.shape.size() != 2) return {};
  const auto covariance = sweep.array("covariance");
  const auto n = static_cast<std::size_t>(s.entries), runs = static_cast<std::size_t>(s.runs);
  if (!covariance || covariance->element != BF_F64 || covariance->shape.size() != 3 || covariance->shape[0] != runs ||
      covariance->shape[1] != n || covariance->shape[2] != n)
    return {};
  const auto data = covariance->as<double>();
  Eigen::VectorXd deviation(s.runs);
  for (std::size_t r = 0; r < runs; ++r) {
    const double variance = data[(r * n + static_cast<std::size_t>(entry)) * n + static_cast<std::size_t>(entry)];
    if (!(variance >= 0.0) || !std::isfinite(variance)) return {};
    deviation[static_cast<Eigen::Index>(r)] = std::sqrt(variance);
  }
  return deviation;
}

template <class Get>
Expected<Eigen::VectorXd> values_of(const Stacked& s, const std::string& name, Get get) {
  Eigen::VectorXd values(s.runs);
  for (Eigen::Index r = 0; r < s.runs; ++r) {
    values[r] = get(r);
    if (!std::isfinite(values[r])) return unexpected("'" + name + "' is not finite in run " + std::to_string(r));
  }
  return values;
}

/// Appends the entry: one quantity, or two of a complex one.
Expected<bool> append(std::vector<Quantity>& all, const RecordView& sweep, const Stacked& s, Eigen::Index entry) {
  const Label label = label_of(sweep, s, entry);
  const auto add = [&](const std::string& name, auto get, Eigen::VectorXd deviation) -> Expected<bool> {
    auto values = values_of(s, name, get);
    if (!values) return unexpected(values.error().text);
    all.push_back({name, label.unit, std::move(*values), std::move(deviation)});
    return true;
  };
  if (s.array.element == BF_C64) {
    const auto data = s.array.as<Complex>();
    const auto real = add("re(" + label.name + ")", [&](Eigen::Index r) { return data[s.place(r, entry)].real(); }, {});
    if (!real) return real;
    return add("im(" + label.name + ")", [&](Eigen::Index r) { return data[s.place(r, entry)].imag(); }, {});
  }
  if (s.array.element == BF_I64) {
    const auto data = s.array.as<std::int64_t>();
    return add(label.name, [&](Eigen::Index r) { return static_cast<double>(data[s.place(r, entry)]); }, {});
  }
  const auto data = s.array.as<double>();
  return add(
      label.name, [&](Eigen::Index r) { return data[s.place(r, entry)]; }, deviation_of(sweep, s, entry));
}

/// What a source can be, for a message: parameters first.
std::string known_sources(const RecordView& sweep) {
  std::string text;
  if (const auto names = sweep.texts("parameter_names"))
    for (const auto& name : *names) text += (text.empty() ? "" : ", ") + std::string(name);
  for (const auto& array : sweep.arrays()) text += (text.empty() ? "" : ", ") + std::string(array.name);
  return text.empty() ? "nothing" : text;
}

Expected<bool> append_source(std::vector<Quantity>& all, const RecordView& sweep, Eigen::Index runs, const std::string& source) {
  const std::string name = source.substr(0, source.find('[')), index = source.substr(name.size());
  if (const auto array = sweep.array(name)) {
    const auto s = stacked(*array, runs);
    if (!s) return unexpected(s.error().text);
    bool found = false;
    for (Eigen::Index e = 0; e < s->entries; ++e) {
      if (!index.empty() && index != index_text(*s, e)) continue;
      found = true;
      if (const auto done = append(all, sweep, *s, e); !done) return done;
    }
    if (found) return true;
    return unexpected("array '" + name + "' has no entry " + index + "; the last is " + index_text(*s, s->entries - 1));
  }
  const auto names = sweep.texts("parameter_names");
  const auto parameters = sweep.array("parameters");
  if (names && parameters) {
    const auto found = std::find(names->begin(), names->end(), source);
    const auto s = stacked(*parameters, runs);
    if (found != names->end() && s && s->entries == static_cast<Eigen::Index>(names->size()))
      return append(all, sweep, *s, found - names->begin());
  }
  std::string apart;
  if (const auto left = sweep.texts("not_merged"); left && std::find(left->begin(), left->end(), name) != left->end())
    apart = " (its shape differs from run to run)";
  return unexpected("the sweep has no '" + source + "'" + apart + "; it has: " + known_sources(sweep));
}

}  // namespace

Expected<Eigen::Index> sweep_runs(const RecordView& sweep) {
  if (sweep.type() != "sweep")
    return unexpected("a record of type '" + std::string(sweep.type()) + "'; needed: sweep, as a phase with `sweep:` leaves it");
  const auto runs = sweep.integer("runs");
  if (!runs || *runs < 1) return unexpected("the sweep does not say how many runs it holds");
  return static_cast<Eigen::Index>(*runs);
}

Expected<std::vector<Quantity>> sweep_quantities(const RecordView& sweep, const std::vector<std::string>& sources) {
  const auto runs = sweep_runs(sweep);
  if (!runs) return unexpected(runs.error().text);
  std::vector<Quantity> all;
  for (const std::string& source : sources)
    if (const auto done = append_source(all, sweep, *runs, source); !done) return unexpected(done.error().text);
  return all;
}

}  // namespace bodeflow::validation
