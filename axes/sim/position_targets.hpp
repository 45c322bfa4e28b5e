#pragma once
// Cyclic position targets as the drive takes them: some come as increments, and some do not come. Sources: SV-DA200 2.1 note 7, 3.3.2.

#include <cstdint>

#include "axes/sim/behaviour_value.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "axes/sim/communication_watch.hpp"
#include "axes/sim/lost_data.hpp"

namespace taktwerk::axes::sim {

class PositionTargets {
public:
    explicit PositionTargets(const DriveProfile& profile)
        : absolute_(profile, profile.behaviour.absolute_targets), lost_cycles_(profile, profile.behaviour.lost_target_cycles) {}

    void power_on(ecat::sim::ObjectDictionary& dictionary);
    void obey(AxisInputs& in, const Cia402Axis& axis, const CommunicationWatch& communication) noexcept;
    /// Where the axis' demand stands after an exchange.
    void show(std::int64_t demand) noexcept { demand_ = demand; }

    /// A cyclic position target is followed.
    [[nodiscard]] bool following() const noexcept { return following_; }
    [[nodiscard]] std::int64_t demand() const noexcept { return demand_; }

private:
    BehaviourValue absolute_, lost_cycles_;
    LostData targets_;
    std::int64_t increments_ = 0;  ///< their sum, as a position
    std::int64_t demand_ = 0;
    bool following_ = false;
};

}  // namespace taktwerk::axes::sim
