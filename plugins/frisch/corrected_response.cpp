#include "corrected_response.hpp"

#include <string>

namespace bodeflow::frisch {

Expected<Eigen::VectorXcd> corrected_response(const PowerSpectra& s, const NoiseVariances& noise, ResponseForm form) {
  Eigen::VectorXcd g(s.lines());
  for (Eigen::Index k = 0; k < s.lines(); ++k) {
    const std::string line = "line " + std::to_string(k) + " of the spectra";
    if (form == ResponseForm::output) {
      if (!(std::abs(s.yu[k]) > 0.0)) return refused(line + ": input and output are not correlated");
      g[k] = (s.yy[k] - noise.output) / std::conj(s.yu[k]);
    } else {
      if (!(s.uu[k] > noise.input)) return refused(line + ": the input power is not above its noise");
      g[k] = s.yu[k] / (s.uu[k] - noise.input);
    }
  }
  return g;
}

}  // namespace bodeflow::frisch
