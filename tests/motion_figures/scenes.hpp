#pragma once
// The pictures of docs/motion/, each a run of blocks on real axes.

#include <vector>

#include "tests/motion_figures/figure.hpp"

namespace taktwerk::figures {

[[nodiscard]] std::vector<Figure> moves();
[[nodiscard]] std::vector<Figure> endless_moves();
[[nodiscard]] std::vector<Figure> stops();
[[nodiscard]] std::vector<Figure> buffer_modes();
[[nodiscard]] std::vector<Figure> superimposed();
[[nodiscard]] std::vector<Figure> couplings();
[[nodiscard]] std::vector<Figure> time_profiles();
[[nodiscard]] std::vector<Figure> torque();
[[nodiscard]] std::vector<Figure> following();
[[nodiscard]] std::vector<Figure> homing();
[[nodiscard]] std::vector<Figure> probes_and_cams();
[[nodiscard]] std::vector<Figure> modulo();
[[nodiscard]] std::vector<Figure> by_hand();
[[nodiscard]] std::vector<Figure> groups();

}  // namespace taktwerk::figures
