#include "axes/tables/motion_tables.hpp"

#include <algorithm>

namespace taktwerk::axes {

namespace {

constexpr std::size_t copies_of_a_cam = 3;

template <class T>
std::vector<T> with_room(std::span<const T> rows, std::size_t room) {
    std::vector<T> made(rows.begin(), rows.end());
    made.resize(std::max(room, rows.size()));
    return made;
}

template <class T>
std::uint16_t index_of_last(const std::vector<T>& all) noexcept {
    return static_cast<std::uint16_t>(all.size() - 1);
}

}  // namespace

CamRef MotionTables::add_cam(std::span<const CamPoint> points, std::size_t room) {
    cams_.push_back({with_room(points, room), points.size()});
    const CamRef ref{index_of_last(cams_)};
    for (std::size_t i = 0; i < copies_of_a_cam; ++i) {
        Place place;
        place.cam = PreparedCam(cams_.back().points.size());
        place.source = ref.index;
        places_.push_back(std::move(place));
    }
    return ref;
}

TimeTableRef MotionTables::add_time_table(std::span<const TimePoint> rows, std::size_t room) {
    times_.push_back({with_room(rows, room), rows.size()});
    return {index_of_last(times_)};
}

CamSwitchRef MotionTables::add_cam_switches(std::span<const CamSwitch> switches, std::size_t room) {
    // A place without a switch is one that is never on: first and last are equal, in time mode for no time.
    auto made = with_room(switches, room);
    for (std::size_t i = switches.size(); i < made.size(); ++i) made[i].mode = CamSwitchMode::time;
    switches_.push_back(std::move(made));
    return {index_of_last(switches_)};
}

TrackRef MotionTables::add_tracks(std::span<const TrackOptions> options) {
    tracks_.emplace_back(options.begin(), options.end());
    return {index_of_last(tracks_)};
}

MotionTables::Prepared MotionTables::prepare(CamRef source, bool periodic, bool master_absolute, bool slave_absolute) noexcept {
    const auto* table = cam(source);
    if (!table || table->used > table->points.size()) return {{}, ErrorId::invalid_table};
    Place* workshop = nullptr;
    for (auto& place : places_) {
        if (place.source != source.index || place.holders > 0) continue;
        if (!workshop || place.id.value < workshop->id.value) workshop = &place;  // the oldest, or one never used
    }
    if (!workshop) return {{}, ErrorId::no_table_room};
    workshop->id = {};
    const auto error = workshop->cam.prepare(table->rows(), periodic, master_absolute, slave_absolute);
    if (error != ErrorId::none) return {{}, error};
    for (const auto& place : places_)
        if (place.source == source.index && place.id.value != 0 && place.cam.same_as(workshop->cam)) return {place.id};
    if (++last_id_ == 0) ++last_id_;
    workshop->id = {last_id_};
    return {workshop->id};
}

MotionTables::Place* MotionTables::place_of(CamId id) noexcept {
    if (id.value == 0) return nullptr;
    for (auto& place : places_)
        if (place.id == id) return &place;
    return nullptr;
}

const PreparedCam* MotionTables::prepared(CamId id) const noexcept {
    if (id.value == 0) return nullptr;
    for (const auto& place : places_)
        if (place.id == id) return &place.cam;
    return nullptr;
}

void MotionTables::hold(CamId id) noexcept {
    if (auto* place = place_of(id)) ++place->holders;
}

void MotionTables::release(CamId id) noexcept {
    auto* place = place_of(id);
    if (place && place->holders > 0) --place->holders;
}

}  // namespace taktwerk::axes
