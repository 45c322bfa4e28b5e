#pragma once
// Requests of the base task: straight to the axes, in the same cycle. Real-time safe.

#include <span>

#include "axes/axis/axis.hpp"
#include "axes/axis/motion_context.hpp"

namespace taktwerk::axes {

class DirectRequests final : public AxisRequests {
public:
    DirectRequests() = default;
    explicit DirectRequests(std::span<Axis> axes) noexcept : axes_(axes) {}

    Submitted submit(AxisRef axis, const AxisCommand& command, Owner owner) noexcept override {
        auto* found = find(axis);
        return found ? found->submit(command, owner) : Submitted{0, ErrorId::invalid_axis};
    }
    ErrorId power(AxisRef axis, bool enable, bool positive, bool negative, Owner owner) noexcept override {
        auto* found = find(axis);
        return found ? found->power(enable, positive, negative, owner) : ErrorId::invalid_axis;
    }
    ErrorId reset(AxisRef axis, Owner owner) noexcept override {
        auto* found = find(axis);
        return found ? found->reset(owner) : ErrorId::invalid_axis;
    }
    Submitted set(AxisRef axis, const AxisSetting& setting, Owner owner) noexcept override {
        auto* found = find(axis);
        return {0, found ? found->set(setting, owner) : ErrorId::invalid_axis};
    }
    ErrorId update(AxisRef axis, CommandId id, const AxisCommand& command, Owner owner) noexcept override {
        auto* found = find(axis);
        return found ? found->update(id, command, owner) : ErrorId::invalid_axis;
    }
    void release_stop(AxisRef axis, CommandId id, Owner owner) noexcept override {
        if (auto* found = find(axis)) found->release_stop(id, owner);
    }
    ErrorId renew_jog(AxisRef axis, CommandId id, double velocity, Owner owner) noexcept override {
        auto* found = find(axis);
        return found ? found->renew_jog(id, velocity, owner) : ErrorId::invalid_axis;
    }

private:
    [[nodiscard]] Axis* find(AxisRef axis) const noexcept { return axis.index < axes_.size() ? &axes_[axis.index] : nullptr; }
    std::span<Axis> axes_;
};

}  // namespace taktwerk::axes
