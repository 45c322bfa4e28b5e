#pragma once
// Keeps what a machine has to know after a time without power: gives it back at the start, takes it in the cycle, writes it on a thread that may
// wait for a disk. Writing never reaches back into the cycle, so the machine runs alike with and without a disk.
//
// Written is: at the start, what was read, so that a disk which takes nothing is known before anything moves; positions as position_watch.hpp
// says; values and parameters that have changed, at most once in `every`, and at once when the supply fails or the run ends.

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "axes/axis/axis.hpp"
#include "core/latest_value.hpp"
#include "core/time.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/retain/kept_values.hpp"
#include "runtime/retain/position_watch.hpp"
#include "runtime/retain/retain_store.hpp"

namespace taktwerk::runtime {

class RetainKeeper {
public:
    /// Takes the directory for itself and reads what was kept; what stands in the way goes to `errors`. Not real-time.
    RetainKeeper(const RetainConfig& config, std::span<const AxisBinding> bindings, std::vector<Error>& errors);

    /// Before the first cycle: positions. Not real-time.
    void restore(std::span<axes::Axis> axes) { positions_.restore(axes); }
    /// Before the first scan, once: values into the variables of `items`, parameters into `parameters`. `image_bytes`: of all items. The
    /// spans stay where they are. Not real-time.
    void restore(std::span<const RetainedItem> items, std::span<const MachineLayout::ParameterInfo> infos, std::span<double> parameters,
                 std::span<const RetainBound> bounds);
    /// What became of each name. Any thread, once restored.
    [[nodiscard]] const std::vector<RetainNote>& notes() const noexcept { return notes_; }

    /// KeptValues::warm_blocks.
    [[nodiscard]] std::span<const std::size_t> warm_blocks() const noexcept { return values_->warm_blocks(); }

    struct Values {
        std::span<const std::byte> image;  ///< of all items, one after the other, between two scans
        bool changed = false;              ///< since the last cycle
        std::span<const double> parameters{};
    };
    /// Once per cycle; real-time safe. `ending`: this may be the last one, or nearly.
    void watch(std::span<const axes::Axis> axes, const Values& values, Instant now, bool ending, bool power_fails) noexcept;
    /// There was something, none of it can be used, and an axis that needs it is still not homed. Cycle thread.
    [[nodiscard]] bool positions_lost() const noexcept { return positions_lost_; }
    /// The same of variables and parameters: all have their first values. Any thread, once restored.
    [[nodiscard]] bool values_lost() const noexcept { return values_lost_; }
    /// The last writing failed. Any thread.
    [[nodiscard]] bool failing() const noexcept { return failing_.load(std::memory_order_relaxed); }
    /// One is under way. Any thread.
    [[nodiscard]] bool writing() const noexcept { return writing_since_.load(std::memory_order_relaxed) >= 0; }
    /// It has been for so long that the disk does not take it: what changed since is not kept. Any thread.
    [[nodiscard]] bool hangs(Instant now) const noexcept;
    /// Worse: the disk says something of an axis that is not so any more, and would be believed after a restart. Any thread.
    [[nodiscard]] bool outdated() const noexcept { return outdated_.load(std::memory_order_relaxed); }

    /// The thread that may wait: writes what has changed since the last call; after a failure again each second.
    void step(Instant now);

private:
    struct Moment {
        std::vector<std::byte> image;
        std::vector<double> parameters;
    };
    void publish(const Values& values) noexcept;

    RetainConfig config_;
    RetainStore store_;
    RetainStore::Loaded loaded_;  // emptied once it is restored
    PositionWatch positions_;
    bool positions_lost_ = false;  // cycle
    std::optional<KeptValues> values_;
    std::vector<RetainNote> notes_;

    bool values_lost_ = false;

    // cycle
    std::vector<double> parameters_;  // as published
    bool waits_ = false;              // changed, and not published yet
    bool power_failed_ = false;       // told already
    Instant publish_at_{};
    std::optional<LatestValue<Moment>> latest_;  // once it is known how large

    // service side
    Moment to_write_;
    bool proved_ = false;  // the disk has taken something since the start, or refused it
    Instant retry_at_{};
    std::atomic<bool> failing_{false}, outdated_{false};
    std::atomic<std::int64_t> writing_since_{-1};  // ns of machine time; -1: nothing is being written
};

}  // namespace taktwerk::runtime
