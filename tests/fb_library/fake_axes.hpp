#pragma once
// Axes as blocks see them, played by hand: the test says when a command ends and how. The views handed out are those of the scan's
// begin, as on a real machine: what is submitted in a scan shows in the next one.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "axes/axis/motion_context.hpp"

namespace taktwerk::fb {

class FakeAxes final : public axes::AxisRequests {
public:
    struct Call {
        std::string what;  ///< "submit", "power", "reset", ...
        axes::AxisRef axis{};
        axes::AxisCommand command{};
        axes::CommandId id = 0;
        bool enable = false, positive = false, negative = false;
        double value = 0;
        axes::AxisSetting setting{};
        axes::Owner owner = axes::Owner::none;
    };

    explicit FakeAxes(std::size_t count = 2) : now_axes_(count), seen_(count) {
        for (auto& axis : now_axes_) {
            axis.state = axes::AxisState::Standstill;
            axis.powered = axis.online = true;
            axis.manual_slow = 5;
            axis.manual_fast = 25;
        }
        next_scan();
    }

    axes::AxisView& axis(std::size_t i = 0) { return now_axes_[i]; }

    /// The command submitted last ends: the one that runs beside the axis' motion when it was of that sort, otherwise the active one,
    /// and a waiting one takes over.
    void finish(axes::Outcome outcome, axes::ErrorId error = axes::ErrorId::none, std::size_t i = 0) {
        if (last_slot) return finish_beside(*last_slot, outcome, error, i);
        auto& a = now_axes_[i];
        if (a.active != 0) end(a, a.active, outcome, error);
        a.active = 0;
        a.active_in_target = false;
        if (a.queued_count > 0) {
            a.active = a.queued[0];
            std::copy(a.queued.begin() + 1, a.queued.end(), a.queued.begin());
            --a.queued_count;
        }
    }
    void finish_beside(axes::SideSlot slot, axes::Outcome outcome, axes::ErrorId error = axes::ErrorId::none, std::size_t i = 0) {
        auto& running = now_axes_[i].side[static_cast<std::size_t>(slot)];
        if (running != 0) end(now_axes_[i], running, outcome, error);
        running = 0;
    }
    /// Some other block's command takes the axis, or the place beside its motion that was taken last.
    void take_over(std::size_t i = 0) {
        if (last_slot) begin_beside(now_axes_[i], *last_slot);
        else begin(now_axes_[i], false);
    }

    /// Time goes on by one period; the views are taken anew.
    void next_scan(Duration period = std::chrono::milliseconds{1}) {
        context.now += period;
        context.period = period;
        ++context.cycle;
        seen_ = now_axes_;
        context.axes = seen_;
        context.requests = this;
    }

    // AxisRequests
    axes::Submitted submit(axes::AxisRef ref, const axes::AxisCommand& command, axes::Owner owner) noexcept override {
        axes::Submitted answer{0, refuse_with};
        if (refuse_with == axes::ErrorId::none) {
            auto& a = now_axes_[ref.index];
            last_slot = command.buffer_mode == axes::mcAborting ? slot_of(command) : std::nullopt;
            answer.id = last_slot ? begin_beside(a, *last_slot) : begin(a, command.buffer_mode != axes::mcAborting);
            a.active_kind = last_slot ? a.active_kind : command.kind;
        }
        calls.push_back({.what = "submit", .axis = ref, .command = without_instance(command), .id = answer.id, .owner = owner});
        return answer;
    }
    axes::ErrorId power(axes::AxisRef ref, bool enable, bool positive, bool negative, axes::Owner owner) noexcept override {
        calls.push_back({.what = "power", .axis = ref, .enable = enable, .positive = positive, .negative = negative, .owner = owner});
        return refuse_with;
    }
    axes::ErrorId reset(axes::AxisRef ref, axes::Owner owner) noexcept override {
        calls.push_back({.what = "reset", .axis = ref, .owner = owner});
        return refuse_with;
    }
    axes::Submitted set(axes::AxisRef ref, const axes::AxisSetting& setting, axes::Owner owner) noexcept override {
        calls.push_back({.what = "set", .axis = ref, .setting = setting, .owner = owner});
        if (refuse_with == axes::ErrorId::none) take(now_axes_[ref.index], setting);
        return {0, refuse_with};
    }
    axes::ErrorId update(axes::AxisRef ref, axes::CommandId id, const axes::AxisCommand& command, axes::Owner owner) noexcept override {
        calls.push_back({.what = "update", .axis = ref, .command = without_instance(command), .id = id, .owner = owner});
        return refuse_with;
    }
    void release_stop(axes::AxisRef ref, axes::CommandId id, axes::Owner owner) noexcept override {
        calls.push_back({.what = "release_stop", .axis = ref, .id = id, .owner = owner});
    }
    axes::ErrorId renew_jog(axes::AxisRef ref, axes::CommandId id, double velocity, axes::Owner owner) noexcept override {
        calls.push_back({.what = "renew_jog", .axis = ref, .id = id, .value = velocity, .owner = owner});
        return refuse_renewal_with;
    }

    [[nodiscard]] std::vector<Call> calls_of(const std::string& what) const {
        std::vector<Call> found;
        for (const auto& call : calls)
            if (call.what == what) found.push_back(call);
        return found;
    }

    std::vector<Call> calls;
    axes::ErrorId refuse_with = axes::ErrorId::none, refuse_renewal_with = axes::ErrorId::none;
    std::optional<axes::SideSlot> last_slot;  ///< of the command submitted last
    axes::MotionContext context;

private:
    /// Every block says which one it is; who compares commands compares the rest.
    static axes::AxisCommand without_instance(axes::AxisCommand command) {
        EXPECT_NE(command.instance, nullptr) << "nobody could be told which block this was";
        command.instance = nullptr;
        return command;
    }
    /// Settings that blocks read back.
    void take(axes::AxisView& a, const axes::AxisSetting& setting) {
        if (const auto* factors = std::get_if<axes::Override>(&setting)) a.override_factors = *factors;
        if (const auto* brake = std::get_if<axes::SetBrake>(&setting))
            a.brake = brake->release ? axes::BrakeState::open : axes::BrakeState::closed;
        if (const auto* select = std::get_if<axes::SelectCam>(&setting)) {
            a.selected_as = *select;
            a.selected_cam = {++last_cam_};
        }
    }
    static void end(axes::AxisView& a, axes::CommandId id, axes::Outcome outcome, axes::ErrorId error) {
        a.ledger[a.ledger_next] = {id, outcome, error};
        a.ledger_next = static_cast<std::uint8_t>((a.ledger_next + 1) % a.ledger.size());
    }
    static std::optional<axes::SideSlot> slot_of(const axes::AxisCommand& command) {
        using axes::CommandKind;
        using axes::SideSlot;
        switch (command.kind) {
            case CommandKind::move_superimposed:
            case CommandKind::halt_superimposed: return SideSlot::superimposed;
            case CommandKind::phasing_absolute:
            case CommandKind::phasing_relative:
            case CommandKind::halt_phasing: return SideSlot::phasing;
            case CommandKind::touch_probe: {
                const auto source = std::get<axes::ProbeDetails>(command.details).trigger.source;
                return source == axes::TriggerSource::probe2 ? SideSlot::probe2 : SideSlot::probe1;
            }
            case CommandKind::homing_step: {
                const auto step = std::get<axes::HomingStepDetails>(command.details).step;
                const bool passive = step == axes::HomingStep::flying_switch || step == axes::HomingStep::flying_reference_pulse;
                return passive ? std::optional{SideSlot::passive_homing} : std::nullopt;
            }
            default: return std::nullopt;
        }
    }
    static axes::CommandId begin_beside(axes::AxisView& a, axes::SideSlot slot) {
        auto& running = a.side[static_cast<std::size_t>(slot)];
        if (running != 0) end(a, running, axes::Outcome::aborted, axes::ErrorId::none);
        return running = ++a.last_id;
    }
    static axes::CommandId begin(axes::AxisView& a, bool buffered) {
        const axes::CommandId id = ++a.last_id;
        if (buffered && a.active != 0) {
            a.queued[a.queued_count++] = id;
            return id;
        }
        if (a.active != 0) end(a, a.active, axes::Outcome::aborted, axes::ErrorId::none);
        for (std::uint8_t i = 0; i < a.queued_count; ++i) end(a, a.queued[i], axes::Outcome::aborted, axes::ErrorId::none);
        a.queued_count = 0;
        a.active = id;
        a.active_in_target = false;
        return id;
    }

    std::vector<axes::AxisView> now_axes_, seen_;
    std::uint32_t last_cam_ = 0;
};

}  // namespace taktwerk::fb
