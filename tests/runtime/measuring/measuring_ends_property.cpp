// A measurement that ends anywhere, by anything: the set-points go on from where they were, in position, velocity and acceleration, inside the limits of
// the axis; it comes to rest and stays there.

#include <array>
#include <random>

#include "axes/planner/motion.hpp"
#include "tests/property_cases.hpp"
#include "tests/runtime/measuring/measuring_rig.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::MeasureKind;
using axes::MeasureOrder;

enum class Ends : std::uint8_t { lease, stop, client_gone, emergency_stop, other_mode, other_party, override_down, jam };
constexpr int ways_to_end = 8;

class Ending {
public:
    explicit Ending(std::uint64_t seed) : dice_(seed), m_(drawn()), how_(static_cast<Ends>(draw(ways_to_end))) {}

    /// False: what was drawn is refused.
    bool run() {
        m_.on_cycle = [this] { note(); };
        if (m_.press(order()).answer != Answer::accepted) return false;
        const double hold = between(0.001, std::min(10.0, m_.measure_state().plan.duration()));
        for (double held = 0; held < hold && m_.measure_state().running; held += 0.04) {
            m_.run(40ms);
            if (m_.measure_state().running) m_.renew();
        }
        m_.run(m_.machine->config().cycle * draw(20));
        if (!m_.measure_state().running) return false;
        end();
        m_.run(6s);
        EXPECT_FALSE(m_.measure_state().running);
        EXPECT_EQ(m_.axis(0).set_velocity, 0);
        EXPECT_EQ(m_.axis(0).set_acceleration, 0);
        const double at = m_.axis(0).set_position;
        m_.run(100ms);
        EXPECT_EQ(m_.axis(0).set_position, at);
        return true;
    }

private:
    int draw(int below) { return std::uniform_int_distribution<>(0, below - 1)(dice_); }
    double between(double low, double high) { return low * std::pow(high / low, std::uniform_real_distribution<>(0, 1)(dice_)); }

    MachineConfig drawn() {
        auto config = MeasuringRig::measured();
        config.cycle = config.bus.cycle = std::array<Duration, 4>{250us, 500us, 1ms, 2ms}[static_cast<std::size_t>(draw(4))];
        config.emergency_stop.power_off_after = 10s;
        auto& axis = config.axes[0].axis;
        auto& l = axis.limits;
        l.velocity = between(50, 500);
        l.acceleration = l.velocity * between(3, 20);
        l.deceleration = l.acceleration * between(0.3, 1);
        l.jerk = l.acceleration * between(5, 50);
        if (draw(3) == 0) axis.defaults.deceleration = l.deceleration * between(0.3, 1);
        if (draw(3) == 0) axis.defaults.jerk = l.jerk * between(0.2, 1);
        axis.manual = {l.velocity * 0.2, l.velocity * 0.8, l.velocity * 0.2};
        axis.following.window = 100;
        return config;
    }
    MeasureOrder order() {
        MeasureOrder order{std::array{MeasureKind::step, MeasureKind::ramp, MeasureKind::following,
                                      MeasureKind::friction}[static_cast<std::size_t>(draw(4))]};
        const auto& l = m_.machine->config().axes[0].axis.limits;
        if (draw(2) == 0) order.velocity = l.velocity * between(0.02, 2);
        if (draw(2) == 0) order.acceleration = l.acceleration * between(0.05, 2);
        if (draw(2) == 0) order.distance = between(1, 390) * (draw(2) == 0 ? -1 : 1);
        return order;
    }
    void end() {
        OperatorCommand c;
        c.axis = 0;
        switch (how_) {
            case Ends::lease: return;
            case Ends::stop: (void)m_.machine->request_stop(0); return;
            case Ends::client_gone: (void)m_.machine->release_jog(0); return;
            case Ends::emergency_stop: m_.world.set_input("estop_ok", false); return;
            case Ends::other_mode: m_.mode(Mode::setup); return;
            case Ends::other_party:
                c.action = OperatorAction::take_control;
                c.owner = axes::Owner::commissioning;
                m_.command(c);
                return;
            case Ends::override_down:
                c.action = OperatorAction::override_velocity;
                c.value = 0.5;
                EXPECT_EQ(m_.command(c).answer, Answer::accepted);
                EXPECT_EQ(m_.measure_state().end, MeasureEnd::stopped) << "who turns it down wants it slower now";
                return;
            case Ends::jam: m_.world.drive("x")->jam(true); return;
        }
    }
    /// Each cycle against the one before.
    void note() {
        const auto& now = m_.axis(0);
        const axes::MotionState is{now.set_position, now.set_velocity, now.set_acceleration};
        const double cycle = to_seconds(m_.machine->config().cycle);
        const auto& l = m_.machine->config().axes[0].axis.limits;
        constexpr double rounding = 1 + 1e-6;
        // Without power the set-point follows the motor.
        if (powered_ && now.powered && !::testing::Test::HasFailure()) {
            EXPECT_LE(std::abs(is.velocity), l.velocity * rounding);
            EXPECT_LE(std::abs(is.velocity - before_.velocity), l.acceleration * cycle * rounding);
            EXPECT_LE(std::abs(is.acceleration - before_.acceleration), l.jerk * cycle * rounding)
                << "from " << before_.acceleration << " to " << is.acceleration << " u/s2 at " << is.velocity << " u/s, end " << int(how_);
            EXPECT_NEAR((is.position - before_.position) / cycle, (is.velocity + before_.velocity) / 2, l.jerk * cycle * cycle + 1e-6);
            EXPECT_GE(is.position, l.position_min);
            EXPECT_LE(is.position, l.position_max);
        }
        before_ = is;
        powered_ = now.powered;
    }

    std::mt19937_64 dice_;
    MeasuringRig m_;
    Ends how_;
    axes::MotionState before_;
    bool powered_ = false;
};

TEST(MeasuringEnds, WithoutALeapWhateverEndsIt) {
    std::size_t ended = 0;
    const auto cases = property_cases(40);
    for (std::size_t seed = 1; seed <= cases && !::testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        ended += Ending{seed}.run() ? 1 : 0;
    }
    EXPECT_GT(ended, cases / 3);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
