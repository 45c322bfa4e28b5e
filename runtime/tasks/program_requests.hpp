#pragma once
// Requests of one program's tasks: straight to the axes, and noted on the way, so that a program that ends takes its own axes with it and
// nobody else's. After an emergency stop it passes no wish for power on until a person has let the program go on. Real-time safe.

#include <cstdint>
#include <span>

#include "axes/axis/command_kinds.hpp"
#include "axes/axis/homing_step_check.hpp"
#include "axes/axis/motion_context.hpp"
#include "runtime/command_events.hpp"

namespace taktwerk::runtime {

/// Which program an axis has its power from, and which gave it the last motion.
struct AxisClaims {
    std::uint16_t power = no_program;
    std::uint16_t motion = no_program;
};

class ProgramRequests final : public axes::AxisRequests {
public:
    ProgramRequests(axes::AxisRequests& axes, std::span<AxisClaims> claims, std::uint16_t program) noexcept
        : axes_(axes), claims_(claims), program_(program) {}

    /// An emergency stop was pressed: MC_Power is refused (interlocked), however long its Enable stands, until go_on().
    void hold() noexcept { held_ = true; }
    void go_on() noexcept { held_ = false; }
    [[nodiscard]] bool held() const noexcept { return held_; }

    axes::Submitted submit(axes::AxisRef axis, const axes::AxisCommand& command, axes::Owner owner) noexcept override {
        const auto submitted = axes_.submit(axis, command, owner);
        if (submitted.error == axes::ErrorId::none && moves(command)) claims_[axis.index].motion = program_;
        return submitted;
    }
    axes::ErrorId power(axes::AxisRef axis, bool enable, bool positive, bool negative, axes::Owner owner) noexcept override {
        const auto answer = axes_.power(axis, enable && !held_, positive, negative, owner);
        if (answer != axes::ErrorId::none) return answer;
        auto& claim = claims_[axis.index].power;
        if (enable) claim = program_;
        else if (claim == program_) claim = no_program;
        return enable && held_ ? axes::ErrorId::interlocked : axes::ErrorId::none;
    }
    axes::ErrorId reset(axes::AxisRef axis, axes::Owner owner) noexcept override { return axes_.reset(axis, owner); }
    axes::Submitted set(axes::AxisRef axis, const axes::AxisSetting& setting, axes::Owner owner) noexcept override {
        return axes_.set(axis, setting, owner);
    }
    axes::ErrorId update(axes::AxisRef axis, axes::CommandId id, const axes::AxisCommand& command, axes::Owner owner) noexcept override {
        return axes_.update(axis, id, command, owner);
    }
    void release_stop(axes::AxisRef axis, axes::CommandId id, axes::Owner owner) noexcept override { axes_.release_stop(axis, id, owner); }
    axes::ErrorId renew_jog(axes::AxisRef axis, axes::CommandId id, double velocity, axes::Owner owner) noexcept override {
        return axes_.renew_jog(axis, id, velocity, owner);
    }

private:
    /// Probes and settings take no axis from the program that moves it.
    [[nodiscard]] static bool moves(const axes::AxisCommand& command) noexcept {
        using axes::kind_table::Slot;
        const auto slot = axes::slot_of(command.kind);
        return slot != Slot::probe && slot != Slot::setting && !axes::beside(command);
    }

    axes::AxisRequests& axes_;
    std::span<AxisClaims> claims_;
    std::uint16_t program_;
    bool held_ = false;
};

}  // namespace taktwerk::runtime
