#pragma once

#include <bodeflow/record.hpp>
#include <cstdlib>
#include <vector>

namespace bodeflow::test {

/// A record's bytes where a view may read them.
class AlignedRecord {
 public:
  explicit AlignedRecord(const RecordBuilder& record) : data_(std::aligned_alloc(64, record.size())) { record.write(data_); }
  ~AlignedRecord() { std::free(data_); }
  AlignedRecord(const AlignedRecord&) = delete;
  AlignedRecord& operator=(const AlignedRecord&) = delete;
  RecordView view() const { return RecordView(static_cast<const std::uint8_t*>(data_)); }

 private:
  void* data_;
};

/// The bytes of records that a block sent, to be compared.
inline std::vector<std::vector<std::uint8_t>> bytes_of(const std::vector<const bf_record*>& records) {
  std::vector<std::vector<std::uint8_t>> all;
  for (const bf_record* r : records) all.emplace_back(r->bytes, r->bytes + r->size);
  return all;
}

/// The attribute `warnings`.
inline std::vector<std::string> warnings_of(const RecordView& record) {
  std::vector<std::string> all;
  if (const auto texts = record.texts("warnings")) all.assign(texts->begin(), texts->end());
  return all;
}

}  // namespace bodeflow::test
