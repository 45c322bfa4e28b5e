#pragma once
// What counts at a terminal, as an axis that only measures or under the position loop of an analog one. Not real-time.

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runtime/check/problems.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// Positions that are axes already: slave, object.
using TakenCounters = std::set<std::pair<std::string, std::pair<int, int>>>;

/// It is exchanged, belongs to one axis, counts far enough for its velocity, and nobody else works its latch. `binding.encoder` is there.
void check_counter(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, TakenCounters& taken,
                   Problems& problems);

/// An axis that only measures: nothing asked of it that takes a motor, or that contradicts itself.
void check_measuring_axis(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, Problems& problems);

/// What an axis that only measures is told in vain, as remarks.
[[nodiscard]] std::vector<Error> measuring_remarks(const AxisBinding& binding, const std::string& subject);

}  // namespace taktwerk::runtime
