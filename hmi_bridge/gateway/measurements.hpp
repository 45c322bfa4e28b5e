#pragma once
// Measurements of axes on the service side: the path before it is driven, the samples as they come, the newest run of each axis. One thread,
// not real-time.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "axes/excitation/excitation_plan.hpp"
#include "axes/measuring/aligned_run.hpp"
#include "core/result.hpp"
#include "hmi_bridge/machine_link.hpp"

namespace taktwerk::hmi {

class Measurements {
public:
    /// A measurement of `axis` that is over, or (state.running) still runs.
    struct Run {
        runtime::MeasureState state;
        axes::measuring::SampleRun samples;
        bool forgotten = false;  ///< its samples had to make room for newer ones
    };

    explicit Measurements(MachineLink& machine) : machine_(machine) {}

    /// Fetches samples. `snapshot` may be nullptr. Each service step.
    void step(const runtime::Snapshot* snapshot);
    /// The path of `order` from where the axis stands, in the mode of the snapshot. Errors: measure.refused with the reason, measure.unknown.
    [[nodiscard]] Result<axes::ExcitationPlan> plan(std::uint16_t axis, const axes::MeasureOrder& order,
                                                    const runtime::Snapshot& snapshot) const;
    /// nullptr: it was never measured.
    [[nodiscard]] const Run* newest(std::uint16_t axis) const;

private:
    void begin_run(const runtime::MeasureState& state);

    MachineLink& machine_;
    std::map<std::uint16_t, Run> runs_;
    std::uint32_t filling_ = 0;  // number of the run whose samples come
    std::uint16_t axis_ = 0xFFFF;
};

}  // namespace taktwerk::hmi
