#pragma once
// A person's hand on a group: who jogs it, which way, and since when nobody has renewed that. What an axis' jog is in hand_motion.hpp. Real-time safe.

#include <cstdint>
#include <vector>

#include "runtime/machine/hand_motion.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/operator_command.hpp"

namespace taktwerk::runtime {

class GroupHand {
public:
    /// After the groups were built.
    explicit GroupHand(MachineBody& body);

    /// OperatorAction::group_jog.
    Verdict jog(const OperatorCommand& command, std::size_t group) noexcept;
    /// In the supervision step: a jog whose lease has run out is an alarm, of the first of its axes. The group stops by itself.
    void raise_alarms() noexcept;

    /// The machine's mode: who jogs comes to rest on the path first; then its axes take it. Every other axis takes it at once, and stops.
    void set_mode(axes::OperatingMode mode) noexcept;
    /// Each cycle, before commands are taken.
    void settle_mode() noexcept;

private:
    struct Held {
        axes::CommandId id = 0;
        GroupJogOrder order;
        double distance = 0;
        Instant renewed{};
        bool told = false;  // that its lease has run out
    };
    [[nodiscard]] axes::GroupRef ref(std::size_t group) const noexcept { return {static_cast<std::uint16_t>(group)}; }
    Verdict press(const OperatorCommand& command, std::size_t group) noexcept;
    Verdict renew(const OperatorCommand& command, std::size_t group) noexcept;
    [[nodiscard]] Verdict over(std::size_t group) const noexcept;
    [[nodiscard]] bool jogs(std::size_t group) const noexcept;
    [[nodiscard]] bool mode_waits(std::size_t group) const noexcept;
    [[nodiscard]] Duration lease_of(std::size_t group) const noexcept;

    MachineBody& body_;
    std::vector<Held> held_;
    axes::OperatingMode mode_ = axes::OperatingMode::automatic;
    std::vector<std::uint8_t> waits_;  // axes that are to take it when their group stands
};

}  // namespace taktwerk::runtime
