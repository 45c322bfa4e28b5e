#pragma once
// What an axis keeps of a coupling: the one it runs in, the one that waits to begin, and the phasing between.

#include <array>
#include <cstdint>

#include "axes/axis/command.hpp"
#include "axes/axis/command_queue.hpp"
#include "axes/coupling/follower.hpp"
#include "axes/coupling/master_track.hpp"
#include "axes/coupling/phase_shift.hpp"
#include "axes/tables/cam_table.hpp"

namespace taktwerk::axes {

/// Whom a command follows; invalid handles where it follows nobody (or only one).
struct MasterChoice {
    std::array<AxisRef, 2> axes;
    std::array<MC_Source, 2> sources{mcSetValue, mcSetValue};
};
[[nodiscard]] inline MasterChoice masters_of(const AxisCommand& command) noexcept {
    if (const auto* gear = std::get_if<GearDetails>(&command.details)) return {{gear->master, {}}, {gear->source, mcSetValue}};
    if (const auto* point = std::get_if<GearInPosDetails>(&command.details)) return {{point->master, {}}, {point->source, mcSetValue}};
    if (const auto* cam = std::get_if<CamDetails>(&command.details)) return {{cam->master, {}}, {cam->source, mcSetValue}};
    if (const auto* sum = std::get_if<CombineDetails>(&command.details))
        return {{sum->master1, sum->master2}, {sum->source1, sum->source2}};
    return {};
}

/// Where in the cam's profile the slave is to be in sync (P1-266). Without MasterSyncPosition that is its first point: 0 means none where
/// the profile has no 0.
[[nodiscard]] inline double sync_place(const CamDetails& cam, const PreparedCam& table) noexcept {
    const double place = cam.master_sync_position, begin = table.begin();
    return place == 0 && (begin > 0 || begin + table.length() < 0) ? begin : place;
}

/// One coupling: its command, and its masters as they are followed.
struct Link {
    CommandId id = 0;  ///< 0: none
    AxisCommand command;
    MasterChoice masters;
    std::array<MasterTrack, 2> tracks;
    CamId cam;  ///< held in the tables

    // Where its relative inputs count from; ContinuousUpdate keeps it.
    bool started = false;
    bool chained = false;  ///< the starts are known already: the end of the cam before
    EndlessPlace master_start, second_start, slave_start;
    double table_start = 0;  ///< u of the table

    // Until the master crosses `begin` in the sense `sense`, the motion before goes on.
    bool waits = false;
    double sense = 1;
    EndlessPlace begin, sync;
    bool tracked = false;  ///< the master has been looked at since the command began
    double ahead = 0;      ///< u to `begin` in the last cycle (at first: when the command began), in that sense
};

struct CouplingState {
    Link running;  ///< followed while the goal is `coupled`
    Link next;     ///< of the active command, not begun yet
    Follower follower;
    std::uint32_t cam_ends = 0;       ///< shown
    std::uint32_t cam_ends_seen = 0;  ///< of the running cam

    PhaseShift phase;
    AxisRef phase_master;          ///< whose position is shifted
    AcceptedCommand phasing;       ///< running; id 0: none
    AcceptedCommand phasing_next;  ///< buffered; id 0: none
    CommandId phasing_behind = 0;  ///< the coupling whose signal it waits for

    /// Anything of it is alive.
    [[nodiscard]] bool used() const noexcept {
        return running.id != 0 || next.id != 0 || phasing.id != 0 || phasing_next.id != 0 || phase_master.valid();
    }
    bool shown = false;  ///< the view shows something of it, or has to: false means that nothing is alive
};

}  // namespace taktwerk::axes
