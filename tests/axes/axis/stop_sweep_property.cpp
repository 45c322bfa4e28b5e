// Every kind of motion that an axis knows, ended at any instant by every kind of stop: it never turns the axis round, makes it no faster than the
// motion would have been, comes to its end, and the axis stands where it says. Limits and jumps: the rig's oracle.
//
// A failure names its case; TAKTWERK_STOP_CASE="<configuration> <motion> <stop> <cycle>" runs that alone and shows the set-points.

#include <map>
#include <set>
#include <sstream>

#include "tests/axes/axis/stop_sweep.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr std::size_t usual_stops = 1;  // instants of each motion and stop
constexpr int last_instant = 280;       // cycles from the begin of a motion
constexpr int longest = 4000;           // cycles until a stop is over
constexpr int stands = 40;              // cycles that it must stand
constexpr std::array configurations{"jerk-limited", "trapezoidal", "small deceleration"};

AxisConfig configured(std::size_t which) {
    auto config = plain_axis();
    config.control.rated_acceleration = 2000;
    config.patience.jog_lease = 100ms;
    config.homing = {.kind = HomingKind::home_switch, .search_velocity = 60, .latch_velocity = 5, .acceleration = 800};
    if (which == 1) config.limits.jerk = std::numeric_limits<double>::infinity();
    if (which == 2) {
        config.limits.deceleration = 300;
        config.limits.stop_deceleration = 2000;
        config.limits.stop_jerk = 5000;
    }
    return config;
}

struct Case {
    std::size_t configuration = 0, motion = 0, stop = 0;
    int instant = 0;
};

class StopCase {
public:
    explicit StopCase(const Case& which)
        : config_(configured(which.configuration)),
          motion_(swept_motions[which.motion]),
          stop_(swept_stops[which.stop]),
          instant_(std::max(which.instant, motion_.from)),
          it_(config_) {}

    /// False: this stop was not for this motion.
    bool run(bool shows) {
        SCOPED_TRACE(motion_.name);
        for (int i = 0; i < instant_; ++i) {
            motion_.act(it_, i);
            it_.step();
            if (shows) show();
        }
        before_ = {0, it_.view(1).set_velocity, it_.view(1).set_acceleration};
        by_motor_ = it_.view(1).drive_mode != DriveMode::cyclic_position;
        if (!applies() || !stop_.begin(it_)) {
            it_.oracles[1].look_away("not a case");
            return false;
        }
        int still = 0;
        for (int i = 0; i < longest && still < stands; ++i) {
            it_.step();
            if (shows) show();
            watch();
            still = over() ? still + 1 : 0;
        }
        judge(still);
        return true;
    }
    [[nodiscard]] std::string wrong() const { return wrong_ + it_.oracles[0].report() + it_.oracles[1].report(); }

private:
    [[nodiscard]] bool applies() const {
        const auto state = it_.view(1).state;
        if (state == AxisState::Standstill || state == AxisState::ErrorStop || state == AxisState::Disabled) return false;
        return motion_.made != SweptMotion::Made::homing || stop_.homing;
    }
    void show() {
        const auto& at = it_.view(1);
        std::printf("%6.0f %-18s kind %2d  %12.6f u %12.6f u/s %12.4f u/s2  error %u\n", to_seconds(it_.now - Instant{}) * 1000,
                    std::string(name(at.state)).c_str(), static_cast<int>(at.active_kind), at.set_position, at.set_velocity,
                    at.set_acceleration, static_cast<unsigned>(at.error));
    }
    template <class... Args>
    void say(fmt::format_string<Args...> text, Args&&... args) {
        if (++said_ <= 3) wrong_ += fmt::format(text, std::forward<Args>(args)...) + "\n";
    }
    void watch() {
        const double v = it_.view(1).set_velocity;
        if (stop_.sense == SweptStop::Sense::any || by_motor_) return;
        constexpr double grain = 1e-7;
        const double sense = before_.velocity < 0 ? -1 : 1;
        if (std::abs(before_.velocity) > 1e-6 && sense * v < -grain)
            say("runs at {} u/s; {} u/s and {} u/s2 when it was stopped", v, before_.velocity, before_.acceleration);
        // What the motion itself needs to give its acceleration back.
        const bool rises = before_.velocity * before_.acceleration >= 0;
        const double jerk = it_.axes[1].config().limits.jerk;
        const double most = std::abs(before_.velocity) + (rises ? before_.acceleration * before_.acceleration / (2 * jerk) : 0);
        if (std::abs(v) > most * (1 + 1e-9) + grain)
            say("got as fast as {} u/s; {} u/s and {} u/s2 when it was stopped", v, before_.velocity, before_.acceleration);
    }
    [[nodiscard]] bool over() const {
        const auto& at = it_.view(1);
        const bool rests = at.set_velocity == 0 && at.set_acceleration == 0;
        const bool ended = at.state == stop_.ends_in || (stop_.sense == SweptStop::Sense::any && at.state == AxisState::ErrorStop);
        return rests && ended;
    }
    void judge(int still) {
        const auto& at = it_.view(1);
        const bool goes_on = std::string_view(stop_.name) == "software limit" && at.state != AxisState::ErrorStop;
        if (still < stands && !goes_on)
            say("does not end: {} at {} u/s, {} u/s2, active {}", name(at.state), at.set_velocity, at.set_acceleration,
                static_cast<int>(at.active_kind));
        if (still < stands || !at.online) return;
        if (std::abs(at.actual_position - at.set_position) > 0.002) say("stands at {} u and says {}", at.actual_position, at.set_position);
    }

    AxisConfig config_;
    const SweptMotion& motion_;
    const SweptStop& stop_;
    int instant_;
    SweptAxis it_;
    MotionState before_{};
    bool by_motor_ = false;  // torque, and profiles that the drive makes: the set-point follows the motor
    int said_ = 0;
    std::string wrong_;
};

TEST(StopSweep, EveryStopEndsEveryMotionWithoutTurningItRound) {
    if (const char* only = std::getenv("TAKTWERK_STOP_CASE")) {
        Case which;
        std::istringstream(only) >> which.configuration >> which.motion >> which.stop >> which.instant;
        ASSERT_TRUE(which.configuration < configurations.size() && which.motion < swept_motions.size() && which.stop < swept_stops.size());
        StopCase one(which);
        EXPECT_TRUE(one.run(true));
        EXPECT_EQ(one.wrong(), "");
        return;
    }
    Dice dice(20);
    const char* most = std::getenv("TAKTWERK_WALK_FAILURES");
    int failures = most ? std::atoi(most) : 1;
    std::map<std::string_view, int> stopped;
    std::map<std::string_view, std::set<std::string_view>> ended_by;
    for (std::size_t round = 0; round < property_cases(usual_stops); ++round)
        for (std::size_t c = 0; c < configurations.size(); ++c)
            for (std::size_t m = 0; m < swept_motions.size(); ++m)
                for (std::size_t s = 0; s < swept_stops.size() && failures > 0; ++s) {
                    const Case which{c, m, s, static_cast<int>(dice.below(last_instant))};
                    StopCase one(which);
                    if (!one.run(false)) continue;
                    ++stopped[swept_stops[s].name];
                    ended_by[swept_motions[m].name].insert(swept_stops[s].name);
                    if (const auto wrong = one.wrong(); !wrong.empty()) {
                        ADD_FAILURE() << fmt::format("{} {} {} {}: {}, {}, {}\n{}", c, m, s, which.instant, configurations[c],
                                                     swept_motions[m].name, swept_stops[s].name, wrong);
                        --failures;
                    }
                }
    if (HasFailure()) return;
    // It must have met what it is about: each stop most motions, each motion most stops.
    for (const auto& stop : swept_stops) EXPECT_GE(stopped[stop.name], static_cast<int>(swept_motions.size())) << stop.name;
    for (const auto& motion : swept_motions) EXPECT_GE(ended_by[motion.name].size(), 5u) << motion.name;
}

}  // namespace
}  // namespace taktwerk::axes::test
