#pragma once
// What walks begin with: axes and drives as different as configurations allow, tables to follow, and what their drawing gave.

#include <random>

#include "tests/axes/axis/coupling_rig.hpp"

namespace taktwerk::axes::test {

/// Draws for a walk: one seed, one walk.
class Dice {
public:
    explicit Dice(unsigned seed) : random_(seed) {}
    [[nodiscard]] unsigned below(unsigned n) { return static_cast<unsigned>(random_()) % n; }
    /// True once in `n`.
    [[nodiscard]] bool once_in(unsigned n) { return below(n) == 0; }
    [[nodiscard]] double between(double low, double high) { return low + (high - low) * static_cast<double>(below(10001)) / 10000; }
    template <class T>
    [[nodiscard]] T one_of(std::initializer_list<T> all) {
        return *(all.begin() + below(static_cast<unsigned>(all.size())));
    }

private:
    std::mt19937 random_;
};

/// 100 u/s, 1000 u/s2; the rest as it comes. Always one that check() takes.
inline AxisConfig any_axis(Dice& dice) {
    auto config = plain_axis();
    auto& limits = config.limits;
    if (dice.once_in(2)) limits.jerk = std::numeric_limits<double>::infinity();
    if (dice.once_in(3)) limits.deceleration = 2000;
    if (dice.once_in(2)) limits.stop_deceleration = 3000;
    if (dice.once_in(3)) limits.stop_jerk = 60'000;
    if (dice.once_in(4)) config.defaults = {.acceleration = 700, .deceleration = 600, .jerk = 15'000};
    if (dice.once_in(3)) config.gearing.inverted = true;
    if (dice.once_in(4)) config.modulo = dice.one_of({360.0, 25.0});
    else if (dice.once_in(4)) config.gearing.feed = 0.7;
    if (config.modulo == 0 && dice.once_in(2)) {
        limits.position_max = dice.once_in(4) ? 25 : 80;  // the narrow ones are met by what begins anywhere
        limits.position_min = -limits.position_max;
    }
    config.homing = {.kind = static_cast<HomingKind>(dice.below(8)),
                     .search_velocity = 40,
                     .latch_velocity = 5,
                     .acceleration = 500,
                     .timeout = 3s,
                     .torque = 0.3};
    if (dice.once_in(5)) config.control = {.mode = ControlMode::velocity, .kv = 20};
    else if (dice.once_in(2)) config.control.kv = 15;
    config.control.rated_acceleration = 2000;
    if (dice.once_in(4)) config.control.torque_feed_forward = 1;
    if (dice.once_in(6)) config.compensation.backlash = 0.02;
    if (dice.once_in(3)) config.following.window = 3;
    config.require_homed = dice.once_in(6);
    config.queue_depth = static_cast<std::uint8_t>(1 + dice.below(8));
    config.patience.jog_lease = 50ms;
    return config;
}

inline void any_drive(Dice& dice, const AxisConfig& config, FakeDrive& drive) {
    drive.dead_cycles = static_cast<int>(dice.below(3));
    drive.latch_age = static_cast<int>(dice.below(2));
    drive.switches = dice.once_in(2);
    const double counts = std::abs(config.gearing.counts_per_unit());
    const auto at = [&](double place) { return std::llround(place * counts); };
    drive.home_low = at(-9);
    drive.home_high = at(-6);
    if (config.modulo == 0) {  // an end block for homing, far outside
        drive.negative_stop = at(-250);
        drive.positive_stop = at(250);
        if (dice.once_in(2)) {
            drive.negative_end = at(-120);
            drive.positive_end = at(120);
        }
    }
    drive.stiffness = 2 / counts;  // twice the rated torque for each u that the block is pressed
    drive.probe_signal = {FakeDrive::ProbeSignal{at(3), at(5)}, FakeDrive::ProbeSignal{at(-4), at(1)}};
    drive.index_distance = at(10);
    drive.rated_acceleration = 2000 * counts;
    drive.friction = 0.02;
    drive.caps.probes = 2;
    drive.caps.digital_outputs = true;
    drive.caps.velocity_limit = dice.once_in(2);
    drive.caps.mode_change_at_standstill = dice.once_in(3);
    drive.caps.profile_buffer = static_cast<std::uint8_t>(dice.below(3));
    drive.caps.torque_limits = dice.once_in(2);
}

/// Cams and tables over time that every walk has.
struct WalkTables {
    std::vector<CamRef> cams;
    std::vector<TimeTableRef> positions, velocities, accelerations;

    void declare(MotionTables& tables) {
        cams = {
            tables.add_cam(std::vector<CamPoint>{{.master = 0, .slave = 0}, {.master = 10, .slave = 4}, {.master = 25, .slave = 0}}),
            tables.add_cam(std::vector<CamPoint>{{.master = -5, .slave = 1, .segment = CamSegment::linear},
                                                 {.master = 3, .slave = 5, .segment = CamSegment::spline},
                                                 {.master = 9, .slave = 2, .segment = CamSegment::quintic},
                                                 {.master = 20, .slave = 12}}),
            tables.add_cam(std::vector<CamPoint>{{.master = 0, .slave = 0, .segment = CamSegment::linear}, {.master = 360, .slave = 90}})};
        using Rows = std::vector<TimePoint>;
        positions = {tables.add_time_table(Rows{{200ms, 1.0}, {100ms, 2.5}, {400ms, 1.5}, {300ms, 3.0}}),
                     tables.add_time_table(Rows{{500ms, -4.0}, {700ms, 6.0}})};
        velocities = {tables.add_time_table(Rows{{100ms, 10.0}, {250ms, 10.0}, {150ms, -5.0}}),
                      tables.add_time_table(Rows{{300ms, 20.0}, {400ms, 0.0}})};
        accelerations = {tables.add_time_table(Rows{{100ms, 100.0}, {200ms, 0.0}, {100ms, -100.0}}),
                         tables.add_time_table(Rows{{150ms, -60.0}, {150ms, 60.0}})};
    }
};

}  // namespace taktwerk::axes::test
