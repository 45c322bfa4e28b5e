#pragma once
// Commands that an axis or a group of axes refused, or that ended before they were done: facts for people, kept by the cycle. A short list in which the same
// event stands once with a count, so that a program that asks again in each scan neither floods nor hides anything. The words are made
// outside the cycle (hmi_bridge/words/event_text.hpp). Fixed size, real-time safe.

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "axes/axis/command.hpp"
#include "axes/group/group_command.hpp"
#include "axes/words/types.hpp"
#include "core/time.hpp"

namespace taktwerk::runtime {

inline constexpr std::uint16_t no_program = 0xFFFF;
inline constexpr std::uint16_t no_group = 0xFFFF;

/// Who gave a command, or holds an axis.
struct CommandGiver {
    axes::CommandKind kind = axes::CommandKind::none;
    axes::Owner owner = axes::Owner::none;
    std::uint16_t program = no_program;                                ///< index in the machine's layout
    const void* block = nullptr;                                       ///< MachineLayout::block_at
    axes::GroupCommandKind group_kind = axes::GroupCommandKind::none;  ///< of a command to a group, whose `kind` is none
    friend bool operator==(const CommandGiver&, const CommandGiver&) = default;
};

struct CommandEvent {
    enum class What : std::uint8_t {
        refused,  ///< never begun; `error` says why
        aborted,  ///< another command took the axis, or the axis stopped it by itself (`by` is nobody then)
    };
    std::uint64_t number = 0;  ///< counts events from 1: whoever reads seldom sees what he has missed
    Instant at{};              ///< the first time
    What what = What::refused;
    std::uint16_t axis = 0;
    std::uint16_t group = no_group;  ///< it is about a group then, and about no axis
    CommandGiver given;              ///< kind none: MC_Power's level
    CommandGiver by;                 ///< refused: who has the axis now; aborted: who took it
    bool held = false;               ///< an MC_Stop of `by` holds the axis while its Execute is TRUE
    axes::AxisState state{};         ///< of the axis, then
    axes::ErrorId error = axes::ErrorId::none;
    std::uint16_t axis_error = 0;                      ///< alarm of the axis in ErrorStop; of a group what led it to GroupErrorStop
    std::uint16_t error_axis = axes::AxisRef{}.index;  ///< of a group's: whose `axis_error` that is
    axes::PathPlace place{};                           ///< of a group's: where in its text and on its path, and what stands there
    std::uint32_t times = 1;                           ///< since `at`
};
static_assert(std::is_trivially_copyable_v<CommandEvent>);

class CommandEvents {
public:
    static constexpr std::size_t capacity = 32;
    /// The same event within this time is only counted; later it is news again.
    static constexpr Duration quiet = std::chrono::seconds{30};
    /// At most so many new ones in a second; further ones are dropped and counted.
    static constexpr std::uint32_t most_a_second = 16;

    /// `event.number`, `at`, `times` are set here.
    void note(const CommandEvent& event, Instant now) noexcept;

    /// Oldest first.
    [[nodiscard]] std::span<const CommandEvent> events() const noexcept { return {events_.data(), count_}; }
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
    /// Grows with each change: a copy that has the same is up to date.
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

private:
    std::array<CommandEvent, capacity> events_{};
    std::size_t count_ = 0;
    std::uint64_t next_ = 1, dropped_ = 0, revision_ = 0;
    Instant second_{};
    std::uint32_t in_second_ = 0;
};

}  // namespace taktwerk::runtime
