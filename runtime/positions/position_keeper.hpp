#pragma once
// Keeps the positions of axes with absolute encoders: gives them back at start, sees in the cycle when they are worth writing, and writes
// them on the service side. Writing never reaches back into the cycle, so the machine runs alike with and without a disk.
//
// Written is: at the start, what was read, so that a disk which takes nothing is known before anything moves; that an axis has no reference, as
// soon as it begins to home; a changed reference (homing, MC_SetPosition) at once; that an axis stands, when it has stood for two seconds or
// the run ends; that it moves again, when it was written as standing; and a long way at rest or in motion, so that the turns of the encoder
// stay known.

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "axes/axis/axis.hpp"
#include "core/latest_value.hpp"
#include "core/time.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/positions/position_store.hpp"

namespace taktwerk::runtime {

class PositionKeeper {
public:
    /// Takes the directory for itself and reads what was kept; what stands in the way goes to `errors`. Not real-time.
    PositionKeeper(const std::filesystem::path& directory, std::span<const AxisBinding> bindings, std::vector<Error>& errors);
    /// Before the first cycle. Not real-time.
    void restore(std::span<axes::Axis> axes);

    /// Once per cycle; real-time safe. `ending`: there is no time to wait until an axis has stood for long.
    void watch(std::span<const axes::Axis> axes, Instant now, bool ending) noexcept;
    /// There were positions, none can be used, and an axis that needs them is still not homed. Cycle thread.
    [[nodiscard]] bool lost() const noexcept { return lost_; }
    /// The last writing failed. Any thread.
    [[nodiscard]] bool failing() const noexcept { return failing_.load(std::memory_order_relaxed); }
    /// One is under way. Any thread.
    [[nodiscard]] bool writing() const noexcept { return writing_since_.load(std::memory_order_relaxed) >= 0; }
    /// It has been for so long that the disk does not take it: what changed since is not kept. Any thread.
    [[nodiscard]] bool hangs(Instant now) const noexcept;
    /// Worse: the disk says something of an axis that is not so any more, and would be believed after a restart. Any thread.
    [[nodiscard]] bool outdated() const noexcept { return outdated_.load(std::memory_order_relaxed); }

    /// Service side: writes what has changed since the last call; after a failure again each second.
    void step(Instant now);

private:
    struct Watched {
        axes::RetainedPosition written;  // or on its way there
        Instant moved{};
        std::int64_t at_rest_step = 0, moving_step = 0;  // counts: a way that is worth writing
    };
    [[nodiscard]] static bool differs(const Watched& axis, const axes::RetainedPosition& now) noexcept;

    PositionStore store_;
    std::vector<RetainedAxis> kept_;  // as loaded, then as saved; service side
    std::vector<Watched> watched_;    // cycle
    LatestValue<std::vector<axes::RetainedPosition>> latest_;
    std::atomic<bool> failing_{false}, outdated_{false};
    std::atomic<std::int64_t> writing_since_{-1};  // ns of machine time; -1: nothing is being written
    bool lost_ = false;
    bool proved_ = false;  // the disk has taken something since the start, or refused it
    Instant retry_at_{};
};

}  // namespace taktwerk::runtime
