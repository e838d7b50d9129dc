#include <bodeflow/testing/report.hpp>

namespace bodeflow::testing {
namespace {

std::string line(const Check& check) {
  static const char* const kWords[] = {"pass", "FAIL", "skip"};
  std::string text = kWords[static_cast<int>(check.status)];
  text += "  ";
  if (!check.block.empty()) text += check.block;
  if (!check.setting.empty()) text += " (" + check.setting + ")";
  if (!check.block.empty()) text += ": ";
  text += check.name;
  if (!check.reason.empty()) text += ": " + check.reason;
  return text + "\n";
}

}  // namespace

std::string to_text(const Report& report, bool all) {
  std::string text;
  for (const Check& check : report.checks) {
    if (all || check.status != Status::pass) text += line(check);
  }
  text += report.file + ": " + std::to_string(report.count(Status::pass)) + " passed, " +
          std::to_string(report.count(Status::fail)) + " failed, " + std::to_string(report.count(Status::skip)) + " skipped\n";
  return text;
}

}  // namespace bodeflow::testing
