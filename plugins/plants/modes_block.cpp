#include "modes_block.hpp"

#include <fstream>
#include <numbers>
#include <sstream>

#include "model_parameters.hpp"
#include "model_record.hpp"
#include "modes.hpp"

namespace bodeflow::plants {
namespace {

Eigen::VectorXd list(const Parameters& p, const char* name) {
  const auto& values = p.numbers(name);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Modes from_file(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) fail(file + ": cannot be read");
  auto modes = read_modes(text.str());
  if (!modes) fail(file + ": " + modes.error().text);
  return std::move(*modes);
}

}  // namespace

void ModesBlock::describe(Describe& d) {
  d.id("plants.modes").summary("The model of a structure from its modes.").role("source");
  d.doc(
      "G = sum of c b w^2 / (s^2 + 2 zeta w s + w^2), two states a mode. By lists for one input and output, or by a table with "
      "the "
      "heading wn,zeta,b1,b2 ...,c1,c2 ... (rad/s, ratio, gains of each input and output) for any number of them.");
  d.message_out(model).record_type("model").doc("a state space, continuous in time");
  d.parameter("frequency", std::vector<double>{}).unit("Hz").doc("of each mode");
  d.parameter("damping", std::vector<double>{}).unit("1").doc("ratio of each mode");
  d.parameter("gain", std::vector<double>{}).unit("").doc("static gain of each mode");
  d.optional<File>("file").doc("the table, in place of the lists");
}

void ModesBlock::configure(const Parameters& p) {
  const bool lists = !p.numbers("frequency").empty();
  if (lists == p.has("file")) fail("give either frequency, damping and gain, or file");
  Modes modes;
  if (lists) {
    modes.omega_rad_s = 2.0 * std::numbers::pi * list(p, "frequency");
    modes.damping = list(p, "damping");
    modes.inputs = list(p, "gain");
    modes.outputs = Eigen::MatrixXd::Ones(modes.inputs.rows(), 1);
  } else {
    modes = from_file(p.text("file"));
    note_input(p.text("file"));
  }
  system_ = value_or_fail(modal_system(modes));
}

void ModesBlock::finish(Io& io) { io.emit(model, known_model("plants.modes", system_)); }

}  // namespace bodeflow::plants
