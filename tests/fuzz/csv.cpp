// The CSV reader on arbitrary bytes: no crash, no endless loop, and both passes see the same rows.
#include "acquisition/csv.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

using namespace bodeflow::acquisition;

namespace {

void read_whole(std::string_view text, const Timing& timing) {
  auto reader = open_csv(open_memory(text), "fuzz.csv");
  if (!reader) return;
  std::vector<std::size_t> selected;
  for (std::size_t c = 0; c < (*reader)->columns().size(); ++c) {
    if ((*reader)->time_column() != c && c % 3 != 2) selected.push_back(c);
  }
  const auto summary = (*reader)->scan(selected, timing);
  if (!summary) return;
  if (!(*reader)->start(selected)) std::abort();
  std::vector<std::vector<double>> values(selected.size(), std::vector<double>(16));
  std::vector<double*> places;
  for (auto& v : values) places.push_back(v.data());
  std::int64_t rows = 0;
  while (true) {
    const auto got = (*reader)->read(places, 16);
    if (!got) std::abort();
    rows += static_cast<std::int64_t>(*got);
    if (*got < 16) break;
  }
  if (rows != summary->rows) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_whole(text, {});
  read_whole(text, {1000.0, true});
  return 0;
}
