#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/record.hpp>
#include <complex>
#include <span>
#include <string>

/// Matrices out of and into the arrays of records.
namespace bodeflow::records {

/// "3 x 2 x 2".
std::string shape_text(std::span<const std::uint64_t> shape);

/// The array as rows x columns, all dimensions but the first taken together. T: double or complex. Errors, by name: another type
/// of elements, a value that is not finite.
template <class T>
Expected<Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>> matrix_of(const ArrayView& array, Eigen::Index rows) {
  const std::string name = "array '" + std::string(array.name) + "'";
  if (array.element != kElementOf<T>) return unexpected(name + " holds " + element_name(array.element));
  const auto columns = rows == 0 ? 0 : static_cast<Eigen::Index>(array.size) / rows;
  using RowMajor = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> m = Eigen::Map<const RowMajor>(array.as<T>().data(), rows, columns);
  for (Eigen::Index k = 0; k < rows; ++k) {
    if (m.row(k).array().isFinite().all()) continue;
    return unexpected(name + " is not finite at line " + std::to_string(k + 1) + " of " + std::to_string(rows));
  }
  return m;
}

/// The array of that name as a list. Errors: as matrix_of, and: no such array, more than one dimension.
template <class T>
Expected<Eigen::Matrix<T, Eigen::Dynamic, 1>> list_of(const RecordView& record, const char* name) {
  const auto array = record.array(name);
  if (!array) return unexpected("the record has no array '" + std::string(name) + "'");
  if (array->shape.size() != 1)
    return unexpected("array '" + std::string(name) + "' is " + shape_text(array->shape) + "; needed: a list");
  auto m = matrix_of<T>(*array, static_cast<Eigen::Index>(array->size));
  if (!m) return unexpected(m.error().text);
  return Eigen::Matrix<T, Eigen::Dynamic, 1>(m->reshaped());
}

/// Adds an array of that shape, whose elements are those of the matrix row by row.
template <class T, class Matrix>
void put(RecordBuilder& record, const char* name, const std::string& unit, std::span<const std::uint64_t> shape,
         const Matrix& m) {
  const auto data = record.array<T>(name, unit, shape);
  std::size_t at = 0;
  for (Eigen::Index k = 0; k < m.rows(); ++k) {
    for (Eigen::Index c = 0; c < m.cols(); ++c) data[at++] = m(k, c);
  }
}

template <class T, class Matrix>
void put(RecordBuilder& record, const char* name, const std::string& unit, std::initializer_list<std::uint64_t> shape,
         const Matrix& m) {
  put<T>(record, name, unit, std::span<const std::uint64_t>(shape.begin(), shape.size()), m);
}

/// Adds a list.
template <class T, class Vector>
void put_list(RecordBuilder& record, const char* name, const std::string& unit, const Vector& values) {
  const std::uint64_t size[] = {static_cast<std::uint64_t>(values.size())};
  put<T>(record, name, unit, size, values);
}

/// Adds an array rows x columns.
void put_matrix(RecordBuilder& record, const char* name, const std::string& unit, const Eigen::MatrixXd& m);

}  // namespace bodeflow::records
