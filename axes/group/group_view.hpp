#pragma once
// What everyone else sees of a group: one value per group and cycle. Trivially copyable.

#include <array>
#include <cstdint>
#include <type_traits>

#include "axes/group/group_command.hpp"

namespace taktwerk::axes {

/// What held the path velocity down.
enum class PathLimiter : std::uint8_t { none, command, axis, override_factor, setup_velocity };

/// Of a group on a frame that moves.
struct TrackView {
    AxisRef axis{};            ///< whose way it goes with; invalid: it does not
    bool in_sync = false;      ///< it has come up to it
    double lag = 0;            ///< u of the tool's point that it is behind
    std::uint32_t serial = 0;  ///< of the object (FrameTrack): two of one belt are two
    FrameTrack::Kind kind = FrameTrack::Kind::none;
};

/// An axis that follows the length of a path.
struct PathSlave {
    AxisRef axis{};
    CommandId id = 0;  ///< of the axis; 0: none
    bool in_sync = false;
};

/// What a group has refused, of one command: when it was given, or in its turn, before anything of it moved; or the end of a stored path with an error.
struct GroupRefusal {
    std::uint32_t number = 0;  ///< counts refusals from 1
    GroupCommandKind kind = GroupCommandKind::none;
    CommandId id = 0;             ///< 0: refused when it was given
    const void* block = nullptr;  ///< that gave it, to be named to people; never followed
    PathPlace why{};              ///< error none: nothing has been refused since another motion began
};

struct GroupView {
    static constexpr std::size_t most_waiting = 16, most_slaves = 4;

    GroupState state = GroupState::GroupDisabled;
    std::uint16_t error = 0;                  ///< alarm id or ErrorId that leads or led to GroupErrorStop, until it is reset; 0 = none
    std::uint8_t error_place = most_members;  ///< whose error that is, or which member left; most_members: nobody's alone
    bool resetting = false;
    ErrorId reset_error = ErrorId::none;  ///< what the last reset came to, once it is over
    bool interrupted = false;             ///< stands, and MC_GroupContinue goes on
    bool held = false;                    ///< a person has interrupted it, or keeps it so: no program goes on, nor begins anything
    bool kinematics = false;              ///< it has an arm, and all of its joints are members: frames other than ACS can be read

    std::uint8_t member_count = 0;
    std::array<AxisRef, most_members> members{};  ///< by place; invalid: none
    bool powered = false;                         ///< all members; FALSE without members
    bool in_position = false;                     ///< all members
    bool program_interrupts = false;  ///< its program has interrupted it, whoever holds it beside that: only that program goes on
    std::uint8_t stops_by_hand = 0;   ///< a person's stops, counted round and round

    // by place; those without a member are 0
    JointVector commanded{};  ///< where the active command, else the last one, leads
    JointVector set_position{}, set_velocity{}, set_acceleration{};
    JointVector actual_position{}, actual_velocity{};
    bool online = false;  ///< the actual values of all members are fresh enough

    // The tool's point, where kinematics and the numbers are there: X Y Z [u], RX RY RZ [rad]; velocities of it, u/s and rad/s about the axes.
    bool tool_known = false;
    std::array<double, 6> tool_set{}, tool_actual{}, tool_commanded{}, tool_velocity{}, tool_actual_velocity{};

    TrackView track{};
    PathDriverView driver{};                      ///< of MC_SyncGroupToAxis
    std::array<PathSlave, most_slaves> slaves{};  ///< axes that follow the path's length
    double path_gone = 0;                         ///< u of all paths, one behind the other, forwards

    // along the path
    double path_velocity = 0, path_acceleration = 0;
    std::uint16_t path_members = 0;  ///< places of those whose own ways its length is; 0: it is the way of the tool's point
    double path_deviation = 0;       ///< u by which the tool's point is not where it should be; while it moves
    PathLimiter limiter = PathLimiter::none;
    std::uint8_t limiting_place = 0;  ///< PathLimiter::axis: whose limit
    double tool_limit = 0;            ///< u/s of the tool's point, in set-up mode; 0: none

    JogEnd jog_end = JogEnd::none;  ///< of the last jog, until something else moves the group
    PathHindrance jog_hindrance{};  ///< JogEnd::member_limit: whose; workspace: which room
    GroupRefusal refusal{};         ///< the last one, until another motion begins; not of a person's jog, who has his answer

    // of the active command
    GroupCommandKind active_kind = GroupCommandKind::none;
    CommandId active = 0;
    const void* block = nullptr;  ///< that gave it, to be named to people; never followed
    Duration elapsed{};           ///< since it became active
    Duration remaining{};         ///< as planned now; 0 where nobody can say
    double remaining_distance = 0, progress = 0;
    CornerPassed corner = CornerPassed::none;  ///< in front of it

    PathView path{};

    CommandId lock = 0;  ///< the MC_GroupStop that holds the group
    CommandId interrupting = 0, disabling = 0;
    std::uint8_t queued_count = 0;
    std::array<CommandId, most_waiting> queued{};
    struct Finished {
        CommandId id = 0;
        Outcome outcome = Outcome::done;
        ErrorId error = ErrorId::none;
    };
    std::array<Finished, 32> ledger{};  ///< ring; newest at (ledger_next - 1)
    std::uint8_t ledger_next = 0;
    CommandId last_id = 0;

    Override override_factors;
    double operators_override = 1;  ///< 0 to 1, beside it, whoever moves the group: the smallest of its own and its members'
    PathDynamics default_dynamics;
    ReferenceDynamics reference_dynamics;
    JoggingDynamics jogging_dynamics;

    [[nodiscard]] constexpr bool has(std::size_t place) const noexcept { return place < most_members && members[place].valid(); }

    /// Bounded (a few dozen compares).
    [[nodiscard]] constexpr CommandStatus status(CommandId id, ErrorId* error_out = nullptr) const noexcept {
        if (id == 0) return CommandStatus::unknown;
        if (id == active) return interrupted || interrupting != 0 ? CommandStatus::queued : CommandStatus::active;  // G-066
        if (id == interrupting || id == disabling) return CommandStatus::active;
        for (std::uint8_t i = 0; i < queued_count; ++i)
            if (queued[i] == id) return CommandStatus::queued;
        for (const auto& entry : ledger) {
            if (entry.id != id) continue;
            if (error_out) *error_out = entry.error;
            switch (entry.outcome) {
                case Outcome::done: return CommandStatus::done;
                case Outcome::aborted: return CommandStatus::aborted;
                case Outcome::error: return CommandStatus::error;
            }
        }
        return CommandStatus::unknown;
    }
};
static_assert(std::is_trivially_copyable_v<GroupView>);

}  // namespace taktwerk::axes
