#include <bodeflow/record.hpp>
#include <charconv>
#include <complex>

#include "phases/sweep.hpp"

namespace bodeflow::phases {
namespace {

std::vector<RecordView> views_of(const std::vector<SharedRecord>& records) {
  std::vector<RecordView> views;
  for (const auto& record : records)
    if (auto view = RecordView::check({record.bytes(), record.size()})) views.push_back(*view);
  return views;
}

std::vector<std::uint64_t> stacked(std::size_t runs, std::span<const std::uint64_t> shape) {
  std::vector<std::uint64_t> all{runs};
  all.insert(all.end(), shape.begin(), shape.end());
  return all;
}

template <class T>
void stack(RecordBuilder& merged, const std::vector<RecordView>& views, const ArrayView& first) {
  const auto out = merged.array<T>(std::string(first.name), std::string(first.unit), stacked(views.size(), first.shape));
  std::size_t position = 0;
  for (const auto& view : views)
    for (const T& value : view.array(first.name)->template as<T>()) out[position++] = value;
}

bool in_all(const std::vector<RecordView>& views, const ArrayView& first) {
  return std::all_of(views.begin(), views.end(), [&](const RecordView& view) {
    const auto array = view.array(first.name);
    return array && array->element == first.element &&
           std::equal(array->shape.begin(), array->shape.end(), first.shape.begin(), first.shape.end());
  });
}

void stack_array(RecordBuilder& merged, const std::vector<RecordView>& views, const ArrayView& first) {
  if (first.shape.size() >= kRecordMaxRank || !in_all(views, first)) return;
  switch (first.element) {
    case BF_F64:
      return stack<double>(merged, views, first);
    case BF_C64:
      return stack<std::complex<double>>(merged, views, first);
    case BF_I64:
      return stack<std::int64_t>(merged, views, first);
    case BF_U8:
      return stack<std::uint8_t>(merged, views, first);
    default:
      return;
  }
}

}  // namespace

SharedRecord merge_records(const std::vector<SharedRecord>& records, const std::vector<graph::SweepAxis>& axes,
                           const std::vector<std::vector<std::string>>& values) {
  const std::vector<RecordView> views = views_of(records);
  RecordBuilder merged("sweep");
  if (views.size() != records.size() || views.empty()) return {};
  merged.set("of", std::string(views[0].type()));
  merged.set("runs", static_cast<std::int64_t>(views.size()));

  for (std::size_t a = 0; a < axes.size(); ++a) {
    std::vector<double> numbers;
    std::vector<std::string> texts;
    for (const auto& run : values) {
      double number = 0.0;
      const auto& text = run[a];
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      if (error == std::errc() && end == text.data() + text.size()) numbers.push_back(number);
      texts.push_back(text);
    }
    if (numbers.size() == values.size()) {
      const auto out = merged.array<double>("axis." + axes[a].path, "", {numbers.size()});
      std::copy(numbers.begin(), numbers.end(), out.begin());
    } else {
      merged.set("axis." + axes[a].path, texts);
    }
  }
  for (const auto& attribute : views[0].attributes()) {
    std::vector<double> numbers;
    for (const auto& view : views)
      if (const auto number = view.number(attribute.name())) numbers.push_back(*number);
    if (numbers.size() != views.size() || views[0].array(attribute.name())) continue;
    const auto out = merged.array<double>(std::string(attribute.name()), "", {numbers.size()});
    std::copy(numbers.begin(), numbers.end(), out.begin());
  }
  for (const auto& array : views[0].arrays()) stack_array(merged, views, array);
  const std::vector<std::uint8_t> bytes = merged.bytes();
  return SharedRecord::copy(bytes.data(), bytes.size());
}

}  // namespace bodeflow::phases
