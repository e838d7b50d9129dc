#pragma once

#include <bodeflow/numerics/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <vector>

namespace bodeflow::plants {

/// A winding as sections in a row. Section i lies between node i - 1 and node i: an inductance with its resistance, a capacitance
/// beside both (of the turns to each other), and at node i a capacitance with a conductance to earth.
struct Ladder {
  std::vector<double> inductance_h, resistance_ohm, turn_capacitance_f, earth_capacitance_f, earth_conductance_s;
  double pick_up_f = 0.0;  ///< from the last node to the load; 0: the output is the voltage of the last node
  double load_ohm = 50.0;  ///< from the pick-up to earth; its voltage is the output

  std::size_t sections() const { return inductance_h.size(); }
};

/// The voltage at the output from the voltage at node 0: two states a section, and one of the pick-up.
///
/// Method: the laws of the nodes, M dv/dt = f(v, i) + k du/dt with the capacitances M; v - inv(M) k u is the state, so that no
/// derivative of the input is left. Errors: lists of different lengths, no sections, inductances or earth capacitances that are
/// not above 0, negative values.
/// Source: E. P. Dick, C. C. Erven, Transformer diagnostic testing by frequency response analysis, IEEE Trans. Power Apparatus
/// and Systems 97, 1978, doi:10.1109/TPAS.1978.354718 (the equivalent circuit of a winding).
numerics::Expected<numerics::StateSpace> ladder_system(const Ladder& ladder);

}  // namespace bodeflow::plants
