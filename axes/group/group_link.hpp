#pragma once
// Between a group in the cycle and its planner on the service side: orders one way, answers and runs the other. Nothing waits, nothing locks.
//
// A run is a path from rest to rest, through blends. Two tracks: one is gone, the next is prepared on the other. A life is what follows a restart:
// the cycle stands, and whatever was planned before counts no more. For this room: it includes Eigen.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "axes/group/group_command.hpp"
#include "axes/group/way_point.hpp"
#include "axes/path_time/stretch_exchange.hpp"
#include "axes/pose.hpp"
#include "core/spsc_ring.hpp"

namespace taktwerk::axes {

/// What one member may do: u/s, u/s2, u/s3, the same in both directions; u where its software limits hold, else infinite.
struct MemberLimits {
    double velocity = 0, acceleration = 0, jerk = 0;
    double low = 0, high = 0;
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
    Pose tool{};

    CommandId id = 0;
    GroupCommand command{};  ///< target by rank; dynamics resolved
    MemberVector target{};
    Pose frame{};        ///< of a Cartesian target, seen from the machine
    bool joins = false;  ///< may be blended with the one before it

    bool stands = false;
    Override factors{};
    PathDynamics ramp{};  ///< of the stop
};

/// What became of a move that is not gone.
struct GroupVerdict {
    std::uint32_t life = 0;
    CommandId id = 0;
    ErrorId error = ErrorId::none;  ///< none: there is nothing to go
    bool standing = false;          ///< the run that it is on has come to rest for good
};

struct RunTrack {
    /// Of all moves that can wait, each with its blend, twice over.
    static constexpr std::size_t most_sections = 80;

    std::array<RunSection, most_sections> sections{};  ///< by part modulo most_sections
    StretchExchange exchange;
    double begin = 0;
    std::atomic<std::uint64_t> ready{0};  ///< life << 32 | first command: a stretch is offered
    std::atomic<std::uint32_t> last{0};   ///< the last command on it
    // What the cycle tells.
    std::atomic<std::uint32_t> part{0};
    std::atomic<double> s{0}, velocity{0};

    [[nodiscard]] const RunSection& section(std::uint32_t number) const noexcept { return sections[number % most_sections]; }
};

struct GroupLink {
    SpscRing<GroupOrder> orders{64};
    SpscRing<GroupVerdict> verdicts{64};
    std::array<RunTrack, 2> tracks{};
    std::atomic<std::uint64_t> at_run{0};  ///< life << 32 | runs begun in it

    [[nodiscard]] static constexpr std::uint64_t both(std::uint32_t life, std::uint32_t number) noexcept {
        return static_cast<std::uint64_t>(life) << 32 | number;
    }
};

}  // namespace taktwerk::axes
