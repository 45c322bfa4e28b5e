#pragma once
// How a measurement is getting on, as part of the snapshot; and what the axis allows it, for the cycle and for who shows the path before.

#include <cstdint>
#include <string_view>

#include "axes/axis/axis_config.hpp"
#include "axes/axis/axis_view.hpp"
#include "axes/excitation/excitation_plan.hpp"
#include "core/time.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

enum class MeasureEnd : std::uint8_t {
    none,     ///< it runs, or there never was one
    done,     ///< to its end
    stopped,  ///< let go, stopped, the mode changed, the override turned down
    lease,    ///< renewals stayed out
    alarm,    ///< of the axis; an emergency stop
    refused,  ///< the axis did not take a set-point
};
[[nodiscard]] std::string_view name(MeasureEnd end) noexcept;

struct MeasureState {
    std::uint32_t run = 0;  ///< counts measurements; 0 = none yet
    std::uint16_t axis = 0xFFFF;
    bool running = false;
    MeasureEnd end = MeasureEnd::none;
    axes::ErrorId error = axes::ErrorId::none;  ///< with `refused`
    double elapsed = 0;                         ///< s of plan.duration()
    std::uint64_t lost = 0;                     ///< samples that nobody fetched in time, of all runs
    axes::ExcitationPlan plan;
};

/// 0..1: what is left of a velocity.
[[nodiscard]] double velocity_override(const axes::AxisView& view) noexcept;

/// `view.set_position` is where it begins. Real-time safe.
[[nodiscard]] axes::ExcitationBounds measure_bounds(const axes::AxisConfig& config, const axes::AxisView& view, Mode mode,
                                                    Duration cycle) noexcept;

}  // namespace taktwerk::runtime
