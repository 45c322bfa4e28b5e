#pragma once
// The machine's tables: cams, profiles over time, cam switches. Programs declare them before the cycle begins (room is taken then,
// once), fill and edit them in their tasks; blocks and axes reach them by handle. What a running slave uses is never the editable
// table but a copy prepared by MC_CamTableSelect.
//
// Building and declaring: not real-time. Everything else: real-time safe, on the cycle thread or, for a slower task's own tables,
// on its thread (nobody reads them while it runs: requests apply when it has ended).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "axes/tables/cam_table.hpp"
#include "axes/tables/table_refs.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// One row of MC_TP_REF, MC_TV_REF, MC_TA_REF: the value reached `time` after the row before (P1: DeltaTime).
struct TimePoint {
    Duration delta{};
    double value = 0;  ///< u, u/s, u/s2
};
struct TimeTable {
    std::vector<TimePoint> points;  ///< never grows after declaration
    std::size_t used = 0;           ///< rows that count
    [[nodiscard]] std::span<const TimePoint> rows() const noexcept { return {points.data(), used}; }
};

enum class CamSwitchDirection : std::uint8_t { both, positive, negative };
enum class CamSwitchMode : std::uint8_t { position, time };
/// One element of MC_CAMSWITCH_REF.
struct CamSwitch {
    std::uint16_t track = 1;     ///< 1..32
    double first = 0, last = 0;  ///< u; `last` unused in time mode
    CamSwitchDirection direction = CamSwitchDirection::both;
    CamSwitchMode mode = CamSwitchMode::position;
    Duration duration{};  ///< time mode
};
/// One element of MC_TRACK_REF, by track number - 1.
struct TrackOptions {
    Duration on_compensation{}, off_compensation{};  ///< negative = earlier
    double hysteresis = 0;                           ///< u, >= 0
};

class MotionTables {
public:
    static constexpr std::size_t tracks = 32;

    // --- before the cycle; not real-time ---------------------------------------------------------------------------------
    /// `room`: most points it will ever have; at least the number given. Places for three prepared copies of it are taken too: one that
    /// slaves leave, one that they go to, one to prepare in.
    CamRef add_cam(std::span<const CamPoint> points, std::size_t room = 0);
    TimeTableRef add_time_table(std::span<const TimePoint> rows, std::size_t room = 0);
    CamSwitchRef add_cam_switches(std::span<const CamSwitch> switches, std::size_t room = 0);
    TrackRef add_tracks(std::span<const TrackOptions> options);

    /// Room of the largest table over time: what an axis that follows one needs.
    [[nodiscard]] std::size_t most_time_rows() const noexcept {
        std::size_t most = 0;
        for (const auto& table : times_) most = std::max(most, table.points.size());
        return most;
    }

    // --- real-time safe; nullptr for an invalid handle -------------------------------------------------------------------
    [[nodiscard]] CamSource* cam(CamRef ref) noexcept { return at(cams_, ref.index); }
    [[nodiscard]] TimeTable* time_table(TimeTableRef ref) noexcept { return at(times_, ref.index); }
    [[nodiscard]] std::span<CamSwitch> cam_switches(CamSwitchRef ref) noexcept {
        auto* found = at(switches_, ref.index);
        return found ? std::span<CamSwitch>{*found} : std::span<CamSwitch>{};
    }
    /// To be changed while a block works by them, as the switches: the delay of a valve is found while it runs.
    [[nodiscard]] std::span<TrackOptions> track_options(TrackRef ref) noexcept {
        auto* found = at(tracks_, ref.index);
        return found ? std::span<TrackOptions>{*found} : std::span<TrackOptions>{};
    }

    /// MC_CamTableSelect: checks the source and makes the coefficients of a copy. What is the same as a copy already there gets that
    /// one's id, so any number of slaves share it. Of the copies that no slave uses, the oldest gives its place to the next one. The
    /// work is linear in the number of points.
    struct Prepared {
        CamId id;
        ErrorId error = ErrorId::none;  ///< invalid_table, no_table_room
    };
    [[nodiscard]] Prepared prepare(CamRef source, bool periodic, bool master_absolute, bool slave_absolute) noexcept;
    /// nullptr for an id that was never given out or whose place has been taken.
    [[nodiscard]] const PreparedCam* prepared(CamId id) const noexcept;
    /// A slave holds a prepared cam while it follows it: its place is not taken. Each hold() needs its release().
    void hold(CamId id) noexcept;
    void release(CamId id) noexcept;

private:
    template <class T>
    [[nodiscard]] static T* at(std::vector<T>& all, std::size_t index) noexcept {
        return index < all.size() ? &all[index] : nullptr;
    }
    struct Place {
        PreparedCam cam;
        CamId id;
        std::uint16_t source = 0xFFFF;  // only copies of this cam fit here for sure
        std::uint16_t holders = 0;
    };
    [[nodiscard]] Place* place_of(CamId id) noexcept;

    std::vector<CamSource> cams_;
    std::vector<Place> places_;
    std::uint32_t last_id_ = 0;
    std::vector<TimeTable> times_;
    std::vector<std::vector<CamSwitch>> switches_;
    std::vector<std::vector<TrackOptions>> tracks_;
};

}  // namespace taktwerk::axes
