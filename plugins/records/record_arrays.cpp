#include "record_arrays.hpp"

namespace bodeflow::records {

std::string shape_text(std::span<const std::uint64_t> shape) {
  std::string text;
  for (const std::uint64_t n : shape) text += (text.empty() ? "" : " x ") + std::to_string(n);
  return text.empty() ? "no dimension" : text;
}

void put_matrix(RecordBuilder& record, const char* name, const std::string& unit, const Eigen::MatrixXd& m) {
  const std::uint64_t shape[] = {static_cast<std::uint64_t>(m.rows()), static_cast<std::uint64_t>(m.cols())};
  put<double>(record, name, unit, shape, m);
}

}  // namespace bodeflow::records
