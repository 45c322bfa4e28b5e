#pragma once
// What people do to an axis by hand: jog it, stop it. And which of their stops was the newest. Real-time safe.

#include <cstdint>
#include <vector>

#include "axes/axis/command.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/operator_command.hpp"

namespace taktwerk::runtime {

/// What became of a command.
struct Verdict {
    Answer answer = Answer::accepted;
    axes::ErrorId error = axes::ErrorId::none;
    axes::JogEnd jog_end = axes::JogEnd::none;  ///< of a group's jog, and what it met
    axes::AxisRef limiting{};
    std::uint8_t room = axes::PathHindrance::none;
    bool waits_for_program = false;  ///< a person's continue: the program has interrupted the group, too
};
[[nodiscard]] Verdict verdict_of(axes::ErrorId error) noexcept;

class HandMotion {
public:
    explicit HandMotion(MachineBody& body) : body_(body), axes_(body.config.axes.size()) {}

    /// A person's stop, along the ramp, whoever owns the axis. Of a group's member it is the group's, and ends what a person holds of it.
    Verdict stop(std::size_t axis) noexcept;
    /// The same where nobody asks for a stop: a key is let go, a measurement is over. What a person holds of a group he holds on.
    Verdict let_go(std::size_t axis) noexcept;
    /// The same, of what no group leads; a group whose member it is stays interrupted.
    Verdict stop_alone(std::size_t axis) noexcept;
    /// As OperatorAction::jog.
    Verdict jog(const OperatorCommand& command, std::size_t axis) noexcept;
    /// The mode changes: a jog that was is forgotten.
    void forget_jog(std::size_t axis) noexcept { axes_[axis].jog = 0; }

    /// A stop level of that number was taken.
    void note_stop(std::size_t axis, std::uint64_t number) noexcept;
    /// Its number; 0: none.
    [[nodiscard]] std::uint64_t newest_stop(std::size_t axis) const noexcept { return axes_[axis].stopped_at; }

private:
    struct OfAxis {
        axes::CommandId jog = 0;
        std::uint64_t stopped_at = 0;
    };
    MachineBody& body_;
    std::vector<OfAxis> axes_;
};

}  // namespace taktwerk::runtime
