#pragma once
// An object by which a drive changes while it runs, as the drive goes by it: what takes effect after a restart is the value of power-on.

#include <cstdint>

#include "axes/port/drive_profile.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class BehaviourValue {
public:
    BehaviourValue() = default;  ///< no such object
    BehaviourValue(const DriveProfile& profile, ParameterAddress object) : object_(object) {
        for (const auto& p : profile.parameters)
            if (object.index != 0 && p.address == object) after_restart_ = p.waits_for_restart();
    }

    void power_on(ecat::sim::ObjectDictionary& dictionary) {
        entry_ = object_.index != 0 ? dictionary.find(object_.index, object_.sub) : nullptr;
        at_power_on_ = entry_ != nullptr ? entry_->get() : 0;
    }
    [[nodiscard]] bool present() const noexcept { return entry_ != nullptr; }
    /// What the drive goes by now; 0 where it has no such object.
    [[nodiscard]] std::int64_t get() const noexcept { return entry_ == nullptr || after_restart_ ? at_power_on_ : entry_->get(); }

private:
    ParameterAddress object_{};
    bool after_restart_ = false;
    const ecat::sim::Entry* entry_ = nullptr;
    std::int64_t at_power_on_ = 0;
};

}  // namespace taktwerk::axes::sim
