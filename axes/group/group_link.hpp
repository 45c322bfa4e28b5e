#pragma once
// Between a group in the cycle and its planner on the service side: orders one way, answers and runs the other. Nothing waits, nothing locks.
//
// A run is a path from rest to rest, through blends. Two tracks: one is gone, the next is prepared on the other. A life is what follows a restart:
// the cycle stands, and whatever was planned before counts no more. For this room: it includes Eigen.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "axes/group/group_view.hpp"
#include "axes/group/member_limits.hpp"
#include "axes/group/path_drive.hpp"
#include "axes/group/path_note.hpp"
#include "axes/group/way_point.hpp"
#include "axes/path_time/along_limits.hpp"
#include "axes/path_time/stretch_exchange.hpp"
#include "axes/pose.hpp"
#include "core/spsc_ring.hpp"

namespace taktwerk::axes {

/// What one member may do: u/s, u/s2, u/s3, the same in both directions; u where its software limits hold, else infinite.
struct MemberLimits {
    double velocity = 0, acceleration = 0, jerk = 0;
    double low = 0, high = 0;
    double speeding = 0, braking = 0;  ///< u/s2, of a jog in ACS: `acceleration` is the greater of both
};

struct GroupOrder {
    enum class Kind : std::uint8_t {
        restart,  ///< `members` stand at `from`: forget what was
        move,     ///< `id`, `command`, behind what was ordered before
        wish,     ///< how the motion along the path shall be
    };
    Kind kind = Kind::wish;
    std::uint32_t life = 0;

    std::uint8_t members = 0;
    MemberVector from{};
    std::array<MemberLimits, max_path_axes> limits{};
    double tool_velocity = unlimited;  ///< u/s of the tool's point

    CommandId id = 0;
    GroupCommand command{};              ///< target by rank; dynamics resolved
    MemberVector target{};               ///< of a jog: where the members were when it was pressed
    double way = 0;                      ///< of a jog: length of its path since then
    CommandPlace place{};                ///< as it was accepted
    bool joins = false;                  ///< may be blended with the one before it
    std::uint32_t line = 0, number = 0;  ///< a piece of a stored path: where in its text

    bool stands = false;
    Override factors{};
    PathDynamics ramp{};    ///< of the stop
    bool own_ramp = false;  ///< the stop is as soft as the command that is on the way
};

/// What became of a move that is not gone.
struct GroupVerdict {
    std::uint32_t life = 0;
    CommandId id = 0;
    ErrorId error = ErrorId::none;  ///< none: there is nothing to go
    bool standing = false;          ///< the run that it is on has come to rest for good
    std::uint32_t run = 0;          ///< of a standing one: which run that is, from 1
    std::uint32_t line = 0;         ///< of a stored path: where in its text; 0: nowhere
    JogEnd jog_end = JogEnd::none;  ///< of a jog that has nothing to go
    PathHindrance at{};             ///< members by rank
};

/// In velocity, acceleration or jerk.
[[nodiscard]] constexpr bool asks_for_more(const Override& planned, const Override& wished) noexcept {
    return planned.velocity > wished.velocity || planned.acceleration > wished.acceleration || planned.jerk > wished.jerk;
}

struct RunTrack {
    /// Of all moves that can wait, each with its blend, twice over.
    static constexpr std::size_t usual_sections = 80;
    explicit RunTrack(std::size_t most) : most_sections(most), sections(std::make_unique<RunSection[]>(most)) {}

    const std::size_t most_sections;
    const std::unique_ptr<RunSection[]> sections;  ///< by part modulo most_sections
    StretchExchange exchange;
    double begin = 0;
    Override planned{};  ///< factors of the stretch that is offered; as `drive`, and read by whoever has taken `ready` away
    DrivenPath drive{};  ///< an axis moves along it, and no stretch is offered; written before `ready`
    std::atomic<std::uint64_t> ready{
        0};  ///< life << 32 | number of the run, from 1: a stretch is offered. 0: not yet, or either side has taken it
    std::atomic<std::uint32_t> first{0};  ///< the first command on it
    std::atomic<std::uint32_t> last{0};   ///< the last one so far
    std::atomic<double> closed{0};        ///< s of its end, once nothing will be joined to it any more; else infinite
    // What the cycle tells.
    std::atomic<std::uint32_t> part{0};
    std::atomic<double> s{0}, velocity{0};

    [[nodiscard]] const RunSection& section(std::uint32_t number) const noexcept { return sections[number % most_sections]; }
};

struct GroupLink {
    explicit GroupLink(std::size_t sections) : tracks{RunTrack{sections}, RunTrack{sections}} {}

    SpscRing<GroupOrder> orders{64};
    SpscRing<GroupVerdict> verdicts{64};
    SpscRing<PathNote> notes{64};
    std::array<RunTrack, 2> tracks;
    std::atomic<std::uint64_t> at_run{0};  ///< life << 32 | runs begun in it

    [[nodiscard]] static constexpr std::uint64_t both(std::uint32_t life, std::uint32_t number) noexcept {
        return static_cast<std::uint64_t>(life) << 32 | number;
    }
};

}  // namespace taktwerk::axes
