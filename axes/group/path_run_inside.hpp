#pragma once
// What is inside a PathRun: for path_run.cpp and driven_run.cpp. It includes Eigen.

#include <algorithm>
#include <optional>
#include <span>

#include "axes/group/group_planner.hpp"
#include "axes/group/path_drive.hpp"
#include "axes/group/path_run.hpp"
#include "axes/path_time/path_player.hpp"

namespace taktwerk::axes {

struct PathRun::Inside {
    /// How soon a plan can be in the cycle, s, and in cycles at least. Plans that take longer make it grow.
    static constexpr double least_lead = 0.008;
    static constexpr double least_lead_cycles = 4;
    /// How far a stored path is known ahead: what braking takes has to fit, also in short pieces. Some 5 MB a track.
    static constexpr std::size_t sections_of_stored_paths = 4096;

    Inside(std::span<Axis> axes, const AxisGroupConfig& config, Duration its_cycle, const PathShelf* paths)
        : link(paths != nullptr ? sections_of_stored_paths : RunTrack::usual_sections),
          arm(config.kinematics),
          workspace(config.workspace),
          planner(link, {.arm = arm.get(), .workspace = workspace.get()}, std::max(least_lead, least_lead_cycles * to_seconds(its_cycle)),
                  paths, config.millimetre),
          drive(axes) {}

    GroupLink link;
    std::shared_ptr<const Kinematics> arm;
    std::shared_ptr<const Workspace> workspace;
    GroupPlanner planner;
    PathDrive drive;

    // The cycle's own.
    GroupOrder wish;
    bool told = true;  // the wish
    std::uint32_t life = 0;
    std::uint32_t begun = 0;  // runs, in this life
    RunTrack* track = nullptr;
    std::optional<PathPlayer> player;
    std::uint32_t driven_part = 0;  // of the track, where an axis drives it
    std::array<std::uint8_t, max_path_axes> places{};
    std::array<MemberLimits, max_path_axes> limits{};
    struct {
        double to_hold = unlimited, planned = unlimited;  // by now; by the runs of this life
    } tool_velocity;
    std::size_t members = 0;
    MemberVector q{}, velocity{}, acceleration{}, before{};  // before: the acceleration of the cycle before
    double period = 1;
    WayPoint at;
    std::optional<PathNote> note;
    struct {
        std::array<GroupVerdict, 32> said{};
        std::size_t next = 0;
    } verdicts;
    std::uint32_t late = 0;

    /// The next run, if it is prepared and begins with this command: the cycle's from then on. nullptr: not now. What was planned for more than the
    /// factors of now is left to the planner, who plans it anew: it would go like that until a plan for less had come up with it.
    [[nodiscard]] RunTrack* take_next(CommandId id) noexcept {
        RunTrack& next = link.tracks[begun % 2];
        std::uint64_t prepared = GroupLink::both(life, begun + 1);
        if (next.ready.load(std::memory_order_acquire) != prepared || next.first.load(std::memory_order_relaxed) != id) return nullptr;
        if (!next.ready.compare_exchange_strong(prepared, 0, std::memory_order_acq_rel, std::memory_order_relaxed)) return nullptr;
        if (next.drive.driven || !asks_for_more(next.planned, wish.factors)) return &next;
        next.ready.store(prepared, std::memory_order_release);
        return nullptr;
    }

    /// The planner knows members by their rank alone.
    [[nodiscard]] PathHindrance by_place(PathHindrance at) const noexcept {
        if (at.place < places.size()) at.place = places[at.place];
        return at;
    }
    /// It is on a run.
    [[nodiscard]] bool goes() const noexcept { return player.has_value() || drive.on(); }
    [[nodiscard]] std::uint32_t part() const noexcept { return player ? player->part() : driven_part; }
    /// Of that run.
    [[nodiscard]] double place() const noexcept { return player ? player->now().s : drive.place(); }
};

}  // namespace taktwerk::axes
