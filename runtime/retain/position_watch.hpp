#pragma once
// Sees in the cycle when the position of an axis with an absolute encoder is worth writing, and hands it to whoever writes.
//
// Written is: that an axis has no reference, as soon as it begins to home; a changed reference (homing, MC_SetPosition) at once; that an axis
// stands, when it has stood for two seconds or the run ends; that it moves again, when it was written as standing; and a long way at rest or in
// motion, so that the turns of the encoder stay known.

#include <cstdint>
#include <span>
#include <vector>

#include "axes/axis/axis.hpp"
#include "core/latest_value.hpp"
#include "core/time.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/retain/kept.hpp"

namespace taktwerk::runtime {

class PositionWatch {
public:
    /// `kept`: what was on the disk. Not real-time.
    PositionWatch(std::span<const AxisBinding> bindings, std::span<const RetainedAxis> kept);
    /// Before the first cycle. Not real-time.
    void restore(std::span<axes::Axis> axes);

    /// Once per cycle; real-time safe. `ending`: there is no time to wait until an axis has stood for long.
    void look(std::span<const axes::Axis> axes, Instant now, bool ending) noexcept;
    /// Each axis that needs what was kept is homed. Cycle.
    [[nodiscard]] bool all_known() const noexcept { return all_known_; }

    /// Service side: true when there is something new to be written.
    bool take();
    /// What is to stand on the disk: axes with a reference. Service side.
    [[nodiscard]] std::vector<RetainedAxis> homed() const;

private:
    struct Watched {
        axes::RetainedPosition written;  // or on its way there
        Instant moved{};
        std::int64_t at_rest_step = 0, moving_step = 0;  // counts: a way that is worth writing
    };
    [[nodiscard]] static bool differs(const Watched& axis, const axes::RetainedPosition& now) noexcept;

    std::vector<RetainedAxis> kept_;  // as loaded, then as to be saved; service side
    std::vector<Watched> watched_;    // cycle
    LatestValue<std::vector<axes::RetainedPosition>> latest_;
    bool all_known_ = false;
};

}  // namespace taktwerk::runtime
