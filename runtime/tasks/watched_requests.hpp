#pragma once
// What programs and people ask of the axes, on its way there: carried out as it is, and what is refused or ends another command before
// its time is noted. Here alone it is known which program asks. Real-time safe.

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "axes/axis/direct_requests.hpp"
#include "axes/group/axis_groups.hpp"
#include "runtime/command_events.hpp"

namespace taktwerk::runtime {

struct ProgramRecord;
using ProgramRecords = std::deque<ProgramRecord>;

class WatchedRequests final : public axes::AxisRequests {
public:
    /// How long two programs that took an axis from each other are told of.
    static constexpr Duration rivals_shown = std::chrono::seconds{5};

    WatchedRequests() = default;
    /// `groups`: a member of one that a person holds begins no motion of a program (held_by_person).
    explicit WatchedRequests(std::span<axes::Axis> axes, const axes::AxisGroups* groups = nullptr)
        : axes_(axes), groups_(groups), direct_(axes), places_(axes.size()) {}

    /// Before the requests of each party: whose they are (no_program: a person).
    void speak_for(std::uint16_t program, Instant now) noexcept {
        program_ = program;
        now_ = now;
    }
    /// Once a cycle, after everybody has asked: what axes have ended by themselves. What ends with its program or with everything
    /// (an emergency stop, the end of the run) needs no word of its own.
    void end_of_cycle(Instant now, bool everything_ends, const ProgramRecords& programs) noexcept;

    /// Two programs that command one axis: who took it from whom, while that is to be shown.
    struct Rivals {
        std::uint16_t winner = no_program, loser = no_program;
        Instant until{};
    };
    [[nodiscard]] const Rivals& rivals(std::size_t axis) const noexcept { return places_[axis].rivals; }
    [[nodiscard]] const CommandEvents& events() const noexcept { return events_; }
    /// Of a group of axes (watched_groups.hpp).
    void note(const CommandEvent& event) noexcept { events_.note(event, now_); }

    axes::Submitted submit(axes::AxisRef axis, const axes::AxisCommand& command, axes::Owner owner) noexcept override;
    axes::ErrorId power(axes::AxisRef axis, bool enable, bool positive, bool negative, axes::Owner owner) noexcept override;
    axes::ErrorId reset(axes::AxisRef axis, axes::Owner owner) noexcept override { return direct_.reset(axis, owner); }
    axes::Submitted set(axes::AxisRef axis, const axes::AxisSetting& setting, axes::Owner owner) noexcept override {
        return direct_.set(axis, setting, owner);
    }
    axes::ErrorId update(axes::AxisRef axis, axes::CommandId id, const axes::AxisCommand& command, axes::Owner owner) noexcept override {
        return direct_.update(axis, id, command, owner);
    }
    void release_stop(axes::AxisRef axis, axes::CommandId id, axes::Owner owner) noexcept override {
        direct_.release_stop(axis, id, owner);
    }
    axes::ErrorId renew_jog(axes::AxisRef axis, axes::CommandId id, double velocity, axes::Owner owner) noexcept override {
        return direct_.renew_jog(axis, id, velocity, owner);
    }

private:
    struct Given {
        axes::CommandId id = 0;
        CommandGiver giver;
    };
    struct Place {
        std::array<Given, 16> given{};  // a ring: more than an axis holds at a time
        std::uint8_t next = 0;
        axes::CommandId active = 0;  // at the end of the cycle before
        CommandGiver holder;         // of the MC_Stop that locks the axis, else of what was last accepted
        std::uint16_t power = no_program;
        Rivals rivals;
    };
    [[nodiscard]] static const CommandGiver* giver_of(const Place& place, axes::CommandId id) noexcept;
    /// An active command is over although its end was not reached.
    [[nodiscard]] static bool cut_short(const axes::AxisView& view, axes::CommandId id) noexcept;
    void rival(Place& place, std::uint16_t loser) noexcept;
    /// It would move what a person holds.
    [[nodiscard]] bool disturbs_person(axes::AxisRef axis, const axes::AxisCommand& command) const noexcept;

    std::span<axes::Axis> axes_;
    const axes::AxisGroups* groups_ = nullptr;
    axes::DirectRequests direct_;
    std::vector<Place> places_;
    CommandEvents events_;
    std::uint16_t program_ = no_program;
    Instant now_{};
};

}  // namespace taktwerk::runtime
