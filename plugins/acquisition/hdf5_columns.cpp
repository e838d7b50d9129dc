#include "hdf5_columns.hpp"

#include <algorithm>
#include <bodeflow/utf8.hpp>
#include <map>

#include "printable.hpp"
#include "sampling.hpp"

namespace bodeflow::acquisition {
namespace {

using h5::Handle;

struct Object {
  std::string path;
  H5O_type_t type;
};

herr_t add_object(hid_t, const char* name, const H5O_info_t* info, void* objects) {
  static_cast<std::vector<Object>*>(objects)->push_back({name, info->type});
  return 0;
}

/// Why values of this type are no numbers, or "".
std::string why_not_numbers(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
    case H5T_FLOAT:
      return "";
    case H5T_STRING:
      return "is text";
    case H5T_ENUM:
      return "holds names or truth values (an enumeration), no numbers";
    case H5T_REFERENCE:
      return "holds references, no numbers";
    case H5T_COMPOUND:
      break;
    default:
      return "holds no numbers";
  }
  std::string names;
  const int members = H5Tget_nmembers(type);
  for (int i = 0; i < members && i < 8; ++i) {
    char* name = H5Tget_member_name(type, static_cast<unsigned>(i));
    if (name == nullptr) continue;
    names += (names.empty() ? "" : ", ") + printable(name);
    H5free_memory(name);
  }
  if (names == "r, i" || names == "real, imag") return "is complex; store its real and imaginary part as columns of their own";
  return "is a table with the fields " + names + "; store each field as a data set of its own";
}

std::string shape_text(const std::vector<hsize_t>& shape) {
  std::string text;
  for (const hsize_t n : shape) text += (text.empty() ? "" : " x ") + std::to_string(n);
  return text;
}

class Lister {
 public:
  explicit Lister(hid_t file) : file_(file), recording_(h5::has_attribute(file, "bodeflow")) {}

  Hdf5Columns list();

 private:
  void add(const std::string& path);
  void add_columns(const std::string& path, hid_t dataset, const std::vector<hsize_t>& shape, bool matlab);
  bool add_rate(const std::string& path, hid_t dataset);
  Rate rate_at(hid_t object, const std::string& path);
  Rate rate_of(hid_t dataset, const std::string& path);
  std::string shown(const std::string& path, bool matlab) const;
  void leave(const std::string& path, bool matlab, std::string why) {
    found_.leftovers.push_back({shown(path, matlab), std::move(why)});
  }

  hid_t file_;
  bool recording_;
  std::vector<std::string> sparse_;     // MATLAB's sparse matrices: groups whose data sets are no columns
  std::map<std::string, Rate> stated_;  // by group, from `Ts` and `Fs`
  Hdf5Columns found_;
};

std::string parent_of(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

std::string Lister::shown(const std::string& path, bool matlab) const {
  if (recording_) return printable(path.substr(std::string("streams/").size()));
  std::string name = printable(path);
  if (matlab) {
    for (char& c : name) c = c == '/' ? '.' : c;
  }
  return name;
}

/// The rate that an object's attributes state.
Rate Lister::rate_at(hid_t object, const std::string& path) {
  const auto fraction = h5::numbers(object, "sample_rate_fraction");
  if (fraction.size() == 2 && fraction[0] > 0.0 && fraction[1] > 0.0 && fraction[0] < 9e15 && fraction[1] < 9e15)
    return {static_cast<std::int64_t>(fraction[0]), static_cast<std::int64_t>(fraction[1])};
  for (const char* name : {"sample_rate", "rate"}) {
    const auto value = h5::numbers(object, name);
    if (value.size() != 1) continue;
    const Rate rate = Rate::from_hz(value.front());
    if (!rate.known())
      fail("attribute '" + std::string(name) + "' of '" + printable(path) +
           "' is no sampling rate: " + number_text(value.front()));
    return rate;
  }
  return {};
}

Rate Lister::rate_of(hid_t dataset, const std::string& path) {
  Rate rate = rate_at(dataset, path);
  for (std::string group = path; !rate.known() && !group.empty();) {
    group = parent_of(group);
    const Handle opened(H5Gopen2(file_, group.empty() ? "/" : group.c_str(), H5P_DEFAULT), H5Gclose,
                        "'" + group + "' can't be opened");
    rate = rate_at(opened.id(), group.empty() ? "/" : group);
  }
  return rate;
}

/// Takes MATLAB's single numbers that state a rate.
bool Lister::add_rate(const std::string& path, hid_t dataset) {
  const std::string group = parent_of(path);
  const std::string name = path.substr(group.empty() ? 0 : group.size() + 1);
  if (name != "Ts" && name != "Fs") return false;
  double value = 0.0;
  h5::check(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value), "'" + path + "' can't be read");
  const Rate rate = Rate::from_hz(name == "Ts" ? 1.0 / value : value);
  if (!rate.known()) return false;
  const auto [before, fresh] = stated_.emplace(group, rate);
  if (!fresh && before->second != rate) fail("'Ts' and 'Fs' state different sampling rates");
  return true;
}

void Lister::add_columns(const std::string& path, hid_t dataset, const std::vector<hsize_t>& shape, bool matlab) {
  const bool flat = shape.size() == 1;
  const bool vector = flat || (matlab && (shape[0] == 1 || shape[1] == 1));
  const bool transposed = !flat && (vector ? shape[0] == 1 : matlab);
  const hsize_t rows = flat ? shape[0] : vector ? std::max(shape[0], shape[1]) : shape[transposed ? 1 : 0];
  const hsize_t columns = vector ? 1 : shape[transposed ? 0 : 1];
  const auto names = h5::texts(dataset, "channel_names"), units = h5::texts(dataset, "channel_units");
  std::string unit = h5::text(dataset, "unit");
  if (unit.empty()) unit = h5::text(dataset, "units");
  const Rate rate = rate_of(dataset, path);
  for (std::size_t c = 0; c < columns; ++c) {
    Column column;
    column.header = column.name = shown(path, matlab);
    if (columns > 1) column.header = column.name += "[" + std::to_string(c + 1) + "]";
    if (c < names.size() && names.size() == columns && !names[c].empty()) column.name = printable(names[c]);
    const std::string& own = units.size() == columns ? units[c] : unit;
    if (is_unit(own)) column.unit = own;
    column.rate = rate;
    column.rows = static_cast<std::int64_t>(rows);
    found_.columns.push_back(std::move(column));
    found_.places.push_back({path, c, transposed, flat});
  }
}

void Lister::add(const std::string& path) {
  const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, "data set '" + path + "' can't be opened");
  const std::string kind = h5::text(dataset.id(), "MATLAB_class");
  const bool matlab = !kind.empty();
  const Handle type(H5Dget_type(dataset.id()), H5Tclose, "data set '" + path + "' can't be opened");
  const auto shape = h5::shape_of(dataset.id());
  hsize_t size = 1;
  for (const hsize_t n : shape) size *= n;
  std::string why = kind == "char"   ? "is text"
                    : kind == "cell" ? "is a cell array; store its parts as arrays"
                                     : why_not_numbers(type.id());
  if (why.empty() && (size == 0 || h5::has_attribute(dataset.id(), "MATLAB_empty"))) why = "is empty";
  if (why.empty() && (shape.empty() || (matlab && size == 1))) {
    if (matlab && add_rate(path, dataset.id())) return;
    why = "is a single number, no column";
  }
  if (why.empty() && shape.size() > 2)
    why = "has " + std::to_string(shape.size()) + " dimensions (" + shape_text(shape) + "); read are one or two";
  if (why.empty() && shape.size() == 2 && std::min(shape[0], shape[1]) > 1 && shape[matlab ? 0 : 1] > kMostColumns)
    why = "has " + std::to_string(shape[matlab ? 0 : 1]) + " columns and " + std::to_string(shape[matlab ? 1 : 0]) +
          " rows; is it stored the other way round? (read are up to " + std::to_string(kMostColumns) + " columns)";
  if (why.empty() && !matlab && shape.size() == 2 && shape[1] > kMostColumns)
    why = "has " + std::to_string(shape[1]) + " columns and one row";
  if (!why.empty()) return leave(path, matlab, why);
  add_columns(path, dataset.id(), shape, matlab);
}

Hdf5Columns Lister::list() {
  std::vector<Object> objects;
  h5::check(H5Ovisit2(file_, H5_INDEX_NAME, H5_ITER_INC, add_object, &objects, H5O_INFO_BASIC), "can't be listed");
  for (const Object& o : objects) {
    if (recording_ && o.path.rfind("streams/", 0) != 0) continue;
    if (o.path == "#refs#" || o.path.rfind("#refs#/", 0) == 0) continue;  // where MATLAB keeps the parts of its cells
    if (o.type == H5O_TYPE_GROUP && o.path != ".") {
      const Handle group(H5Gopen2(file_, o.path.c_str(), H5P_DEFAULT), H5Gclose, "'" + o.path + "' can't be opened");
      if (!h5::has_attribute(group.id(), "MATLAB_sparse")) continue;
      leave(o.path, true, "is sparse; store it as a full array");
      sparse_.push_back(o.path);
    }
    if (o.type != H5O_TYPE_DATASET) continue;
    if (std::find(sparse_.begin(), sparse_.end(), parent_of(o.path)) != sparse_.end()) continue;
    if (is_text(o.path)) {
      add(o.path);
    } else {
      leave(o.path, false, "has a name that is not UTF-8 text");
    }
  }
  for (std::size_t i = 0; i < found_.columns.size(); ++i) {
    const auto stated = stated_.find(parent_of(found_.places[i].path));
    if (stated != stated_.end() && !found_.columns[i].rate.known()) found_.columns[i].rate = stated->second;
  }
  return std::move(found_);
}

}  // namespace

Hdf5Columns hdf5_columns(hid_t file) { return Lister(file).list(); }

}  // namespace bodeflow::acquisition
