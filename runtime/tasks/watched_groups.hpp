#pragma once
// What programs ask of groups of axes, on its way there: carried out as it is, and what is refused, in its turn ends with an error, or is ended by another
// command or a person before its time, is noted among the commands that axes refused (watched_requests.hpp). Real-time safe.

#include <array>
#include <cstdint>
#include <vector>

#include "axes/group/axis_groups.hpp"
#include "runtime/tasks/watched_requests.hpp"

namespace taktwerk::runtime {

class WatchedGroups {
public:
    /// Both must live longer.
    WatchedGroups(axes::AxisGroups& groups, WatchedRequests& axes) : groups_(groups), axes_(axes), places_(groups.size()) {}

    [[nodiscard]] axes::AxisGroups& groups() noexcept { return groups_; }
    axes::Submitted submit(axes::GroupRef group, const axes::GroupCommand& command, axes::Owner owner, std::uint16_t program) noexcept;
    /// Which program gave the last command that is no mere setting; no_program: none that runs.
    [[nodiscard]] std::uint16_t commander(std::size_t group) const noexcept { return places_[group].commander; }
    void forget_commander(std::size_t group) noexcept { places_[group].commander = no_program; }
    /// Once a cycle, behind the groups' plans. What ends with its program or with everything needs no word of its own.
    void end_of_cycle(bool everything_ends, const ProgramRecords& programs) noexcept;

private:
    struct Given {
        axes::CommandId id = 0;
        CommandGiver giver;
    };
    struct Place {
        std::array<Given, 32> given{};  // a ring: more than a group holds at a time
        std::uint8_t next = 0;
        std::uint8_t ledger = 0;      // up to where the view's is told
        axes::CommandId active = 0;   // at the end of the cycle before, and not told yet
        axes::CommandId waiting = 0;  // likewise; where none was active the first of those that waited
        std::uint8_t stops = 0;       // GroupView::stops_by_hand then
        std::uint16_t commander = no_program;
    };
    [[nodiscard]] static const CommandGiver* giver_of(const Place& place, axes::CommandId id) noexcept;
    /// The active command `id` has been aborted by `by`: nobody, the group itself.
    void note_aborted(std::size_t group, axes::CommandId id, const CommandGiver& by) noexcept;
    [[nodiscard]] CommandEvent event_of(std::size_t group, const CommandGiver& giver, axes::ErrorId error,
                                        axes::CommandId id) const noexcept;

    axes::AxisGroups& groups_;
    WatchedRequests& axes_;
    std::vector<Place> places_;
};

}  // namespace taktwerk::runtime
