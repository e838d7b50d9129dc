#include "mat_table.hpp"

#include <matio.h>

#include <algorithm>
#include <bodeflow/utf8.hpp>
#include <filesystem>
#include <functional>
#include <map>

#include "hdf5_table.hpp"
#include "mat_layout.hpp"

namespace bodeflow::acquisition {
namespace {

struct CloseFile {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using File = std::unique_ptr<mat_t, CloseFile>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

// Structs in structs deeper than this are not looked into.
constexpr int kDeepest = 8;

/// The number of elements, or nothing where the dimensions are beyond what a v5 file can hold.
std::optional<std::size_t> element_count(const matvar_t& v) {
  if (v.rank < 2 || v.dims == nullptr) return std::nullopt;
  std::size_t count = 1;
  for (int i = 0; i < v.rank; ++i) {
    if (v.dims[i] > (std::size_t{1} << 31)) return std::nullopt;
    count *= v.dims[i];
    if (count > (std::size_t{1} << 31)) return std::nullopt;
  }
  return count;
}

/// Why a variable is no column, or "".
std::string why_not_column(const matvar_t& v) {
  switch (v.class_type) {
    case MAT_C_CELL:
      return "is a cell array; store its parts as arrays";
    case MAT_C_CHAR:
      return "is text";
    case MAT_C_SPARSE:
      return "is sparse; store it as a full array";
    case MAT_C_DOUBLE:
    case MAT_C_SINGLE:
    case MAT_C_INT64:
    case MAT_C_INT32:
    case MAT_C_INT16:
    case MAT_C_INT8:
    case MAT_C_UINT64:
    case MAT_C_UINT32:
    case MAT_C_UINT16:
    case MAT_C_UINT8:
      break;
    default:
      return "holds no numbers";
  }
  if (v.isComplex != 0) return "is complex; store its real and imaginary part as columns of their own";
  const auto count = element_count(v);
  if (!count) return "has dimensions beyond what such a file can hold";
  if (*count == 0) return "is empty";
  if (v.rank > 2) return "has " + std::to_string(v.rank) + " dimensions; read are one or two";
  if (*count == 1) return "is a single number, no column";
  return "";
}

template <class T>
void append(const void* data, std::size_t first, std::size_t count, std::vector<double>& to) {
  const T* values = static_cast<const T*>(data) + first;
  for (std::size_t i = 0; i < count; ++i) to.push_back(static_cast<double>(values[i]));
}

/// Elements of a variable that is in memory, as doubles; false for a type that is none of MATLAB's.
bool append_values(const matvar_t& v, std::size_t first, std::size_t count, std::vector<double>& to) {
  switch (v.class_type) {
    case MAT_C_DOUBLE:
      return append<double>(v.data, first, count, to), true;
    case MAT_C_SINGLE:
      return append<float>(v.data, first, count, to), true;
    case MAT_C_INT64:
      return append<std::int64_t>(v.data, first, count, to), true;
    case MAT_C_INT32:
      return append<std::int32_t>(v.data, first, count, to), true;
    case MAT_C_INT16:
      return append<std::int16_t>(v.data, first, count, to), true;
    case MAT_C_INT8:
      return append<std::int8_t>(v.data, first, count, to), true;
    case MAT_C_UINT64:
      return append<std::uint64_t>(v.data, first, count, to), true;
    case MAT_C_UINT32:
      return append<std::uint32_t>(v.data, first, count, to), true;
    case MAT_C_UINT16:
      return append<std::uint16_t>(v.data, first, count, to), true;
    case MAT_C_UINT8:
      return append<std::uint8_t>(v.data, first, count, to), true;
    default:
      return false;
  }
}

std::size_t class_size(matio_classes kind) {
  switch (kind) {
    case MAT_C_DOUBLE:
    case MAT_C_INT64:
    case MAT_C_UINT64:
      return 8;
    case MAT_C_SINGLE:
    case MAT_C_INT32:
    case MAT_C_UINT32:
      return 4;
    case MAT_C_INT16:
    case MAT_C_UINT16:
      return 2;
    default:
      return 1;
  }
}

/// Brings the values of a variable into memory. False where the library finds fewer than the dimensions say.
bool load(mat_t* file, matvar_t& v) {
  const auto count = element_count(v);
  if (Mat_VarReadDataAll(file, &v) != 0 || v.data == nullptr || !count) return false;
  return v.nbytes == *count * class_size(v.class_type) && static_cast<std::size_t>(v.data_size) == class_size(v.class_type);
}

class MatReader final : public TableReader {
 public:
  explicit MatReader(std::string path) : path_(std::move(path)) {}

  Expected<void> open();
  const std::string& file() const override { return path_; }
  const std::vector<Column>& columns() const override { return columns_; }
  const std::vector<Leftover>& leftovers() const override { return leftovers_; }
  Expected<void> start(std::span<const std::size_t> selected, std::int64_t first_row) override;
  Expected<std::size_t> read(std::span<double* const> channels, std::size_t count) override;
  std::string place(std::size_t n) const override { return path_ + ": row " + std::to_string(row_ - last_read_ + n + 1); }

 private:
  /// A column's variable, by its full name, and the column in it.
  struct Place {
    std::string variable;
    std::size_t column;
  };
  /// Called for each variable and each field of a struct, with its full name; false ends the walk.
  using Visit = std::function<bool(mat_t*, matvar_t&, const std::string&)>;

  Expected<void> walk(const Visit& visit);
  bool visit_all(mat_t* file, matvar_t& v, const std::string& name, int depth, const Visit& visit);
  void add(mat_t* file, matvar_t& v, const std::string& name);
  Rate stated_rate(mat_t* file, matvar_t& v, const std::string& name) const;

  std::string path_;
  std::vector<Column> columns_;
  std::vector<Place> places_;
  std::vector<Leftover> leftovers_;
  std::map<std::string, Rate> stated_;                 // by struct
  std::map<std::size_t, std::vector<double>> values_;  // of the columns that were read, by column
  std::vector<std::size_t> selected_;
  std::size_t row_ = 0, rows_ = 0, last_read_ = 0;
  std::string conflict_;
};

std::string struct_of(const std::string& name) {
  const auto point = name.rfind('.');
  return point == std::string::npos ? "" : name.substr(0, point);
}

bool MatReader::visit_all(mat_t* file, matvar_t& v, const std::string& name, int depth, const Visit& visit) {
  if (v.class_type != MAT_C_STRUCT || depth >= kDeepest || element_count(v) != 1) return visit(file, v, name);
  char* const* names = Mat_VarGetStructFieldnames(&v);
  const unsigned count = Mat_VarGetNumberOfFields(&v);
  for (unsigned i = 0; names != nullptr && i < count; ++i) {
    matvar_t* field = Mat_VarGetStructFieldByIndex(&v, i, 0);
    if (field == nullptr || names[i] == nullptr) continue;
    if (!visit_all(file, *field, name + "." + names[i], depth + 1, visit)) return false;
  }
  return true;
}

Expected<void> MatReader::walk(const Visit& visit) {
  const File file(Mat_Open(path_.c_str(), MAT_ACC_RDONLY));
  if (!file) return unexpected(path_ + ": can't be opened as a MATLAB file");
  while (Variable v{Mat_VarReadNextInfo(file.get())}) {
    if (v->name == nullptr) continue;
    if (!visit_all(file.get(), *v, v->name, 0, visit)) break;
  }
  return {};
}

/// The rate that a single number of that name states, unknown for others.
Rate MatReader::stated_rate(mat_t* file, matvar_t& v, const std::string& name) const {
  const std::string last = name.substr(name.rfind('.') == std::string::npos ? 0 : name.rfind('.') + 1);
  if (last != "Ts" && last != "Fs") return {};
  std::vector<double> value;
  if (!load(file, v) || !append_values(v, 0, 1, value)) return {};
  return Rate::from_hz(last == "Ts" ? 1.0 / value.front() : value.front());
}

void MatReader::add(mat_t* file, matvar_t& v, const std::string& name) {
  if (name.empty() || !is_text(name)) return;
  std::string why = why_not_column(v);
  if (v.class_type == MAT_C_STRUCT) why = "is an array of structs; store its parts as arrays";
  if (why.empty()) {
    const bool vector = v.dims[0] == 1 || v.dims[1] == 1;
    const std::size_t columns = vector ? 1 : v.dims[1];
    for (std::size_t c = 0; c < columns; ++c) {
      Column column;
      column.header = column.name = vector ? name : name + "[" + std::to_string(c + 1) + "]";
      column.rows = static_cast<std::int64_t>(vector ? v.dims[0] * v.dims[1] : v.dims[0]);
      columns_.push_back(std::move(column));
      places_.push_back({name, c});
    }
    return;
  }
  if (element_count(v) == 1) {
    if (const Rate rate = stated_rate(file, v, name); rate.known()) {
      const auto [before, fresh] = stated_.emplace(struct_of(name), rate);
      if (!fresh && before->second != rate) conflict_ = "'Ts' and 'Fs' state different sampling rates";
      return;
    }
  }
  leftovers_.push_back({name, why});
}

Expected<void> MatReader::open() {
  auto done = walk([this](mat_t* file, matvar_t& v, const std::string& name) {
    add(file, v, name);
    return true;
  });
  if (!done) return done;
  if (!conflict_.empty()) return unexpected(path_ + ": " + conflict_);
  if (columns_.empty()) {
    std::string text = path_ + ": no array that can be a column";
    if (!leftovers_.empty()) text += ": '" + leftovers_.front().name + "' " + leftovers_.front().why;
    return unexpected(text);
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const auto stated = stated_.find(struct_of(places_[i].variable));
    if (stated != stated_.end()) columns_[i].rate = stated->second;
  }
  return {};
}

Expected<void> MatReader::start(std::span<const std::size_t> selected, std::int64_t first_row) {
  selected_.assign(selected.begin(), selected.end());
  std::map<std::string, std::vector<std::size_t>> wanted;  // columns by variable
  for (const std::size_t c : selected_) {
    if (values_.count(c) == 0) wanted[places_[c].variable].push_back(c);
  }
  std::string damaged;
  if (!wanted.empty()) {
    auto done = walk([&](mat_t* file, matvar_t& v, const std::string& name) {
      const auto found = wanted.find(name);
      if (found == wanted.end()) return true;
      bool whole = load(file, v);
      for (const std::size_t c : found->second) {
        const auto rows = static_cast<std::size_t>(columns_[c].rows);
        std::vector<double> values;
        values.reserve(rows);
        whole = whole && element_count(v) >= (places_[c].column + 1) * rows &&
                append_values(v, places_[c].column * rows, rows, values);
        if (whole) values_[c] = std::move(values);
      }
      if (!whole) damaged = name;
      wanted.erase(found);
      return whole && !wanted.empty();
    });
    if (!done) return done;
    if (!damaged.empty()) return unexpected(path_ + ": variable '" + damaged + "' is damaged: its values can't be read");
    if (!wanted.empty()) return unexpected(path_ + ": changed while it was read");
  }
  rows_ = selected_.empty() ? 0 : static_cast<std::size_t>(columns_[selected_.front()].rows);
  row_ = std::min(static_cast<std::size_t>(first_row), rows_);
  last_read_ = 0;
  return {};
}

Expected<std::size_t> MatReader::read(std::span<double* const> channels, std::size_t count) {
  last_read_ = std::min(count, rows_ - row_);
  for (std::size_t c = 0; c < selected_.size(); ++c) {
    const auto& values = values_.at(selected_[c]);
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row_), last_read_, channels[c]);
  }
  row_ += last_read_;
  return last_read_;
}

}  // namespace

Expected<std::unique_ptr<TableReader>> open_mat(const std::string& path) {
  auto bytes = open_file(path);
  if (!bytes) return unexpected(path + ": " + bytes.error().text);
  std::error_code unknown;
  const auto kind = check_mat(**bytes, static_cast<std::int64_t>(std::filesystem::file_size(path, unknown)));
  if (!kind) return unexpected(path + ": " + kind.error().text);
  if (*kind == MatKind::v73) return open_hdf5(path);
  auto reader = std::make_unique<MatReader>(path);
  if (auto done = reader->open(); !done) return {Unexpected<Error>{done.error()}};
  return std::unique_ptr<TableReader>(std::move(reader));
}

}  // namespace bodeflow::acquisition
