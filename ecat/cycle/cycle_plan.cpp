#include "ecat/cycle/cycle_plan.hpp"

namespace taktwerk::ecat {

CyclePlan::CyclePlan(ProcessDataPlan process_data, std::vector<CycleSlave> in_order, FaultFinder finder)
    : plan(std::move(process_data)),
      slaves(std::move(in_order)),
      outputs(plan.output_bytes),
      inputs(plan.input_bytes),
      health(slaves.size()),
      faults(std::move(finder)),
      frames(plan.frames),
      places(plan.datagrams.size()),
      under_way(plan.units.size(), 0),
      sync0(slaves.size()) {}

}  // namespace taktwerk::ecat
