#pragma once
// MC_StepBlock: drives against a fixed stop. It is there when the torque is reached and the axis hardly moves, both for a time.
// Real-time safe.

#include <cmath>

#include "axes/homing/search.hpp"

namespace taktwerk::axes {

struct BlockSettings {
    bool positive = false;
    double torque = 0;          ///< fraction of rated torque, > 0
    double velocity_limit = 0;  ///< u/s, > 0: slower than this counts as blocked
    Duration time{};            ///< both must hold so long
};

class BlockSearch {
public:
    /// A drive that limits its torque itself stays a little below the limit.
    static constexpr double torque_reached = 0.95;

    BlockSearch() = default;
    explicit BlockSearch(const BlockSettings& settings) noexcept : settings_(settings) {}

    [[nodiscard]] SearchMove step(const SearchInput& in) noexcept {
        const int sense = settings_.positive ? 1 : -1;
        if (settings_.positive ? in.positive_limit : in.negative_limit) return SearchMove::failed();
        const bool presses = in.torque * sense >= torque_reached * settings_.torque;
        if (!presses || std::abs(in.velocity) >= settings_.velocity_limit) {
            blocked_ = false;
            return SearchMove::along(sense, true);
        }
        if (!blocked_) since_ = in.now;
        blocked_ = true;
        return in.now - since_ >= settings_.time ? SearchMove::found(in.position) : SearchMove::along(sense, true);
    }

private:
    BlockSettings settings_;
    bool blocked_ = false;
    Instant since_{};
};

}  // namespace taktwerk::axes
