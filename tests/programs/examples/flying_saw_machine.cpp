// The flying saw by its physics: what it cuts, and whether it moves with the material while it does.

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include <gmock/gmock.h>

#include "tests/axes/axis/motion_oracle.hpp"
#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::flying_saw_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

/// Follows the carriage cut by cut, and the set-points of both axes with the oracle of motion.
struct Saw {
    explicit Saw(ExampleMachine& machine) : m(machine) {
        for (const auto& binding : m.config().axes)
            oracles.emplace_back(binding.axis, m.config().cycle, binding.profile->mode_rules.change_delay);
        m.each_cycle = [this] { look(); };
    }
    void look() {
        const auto &material = m.axis("material"), &carriage = m.axis("carriage");
        oracles[0].observe(material);
        oracles[1].observe(carriage);
        const bool saw = m.output("saw_down");
        if (saw && !down) {
            cuts.push_back(material.set_position - carriage.set_position);
            real_cuts.push_back(m.place("material") - m.place("carriage"));
            back = false;
        }
        if (saw) {
            worst_slip = std::max(worst_slip, std::abs(material.set_velocity - carriage.set_velocity));
            worst_drift = std::max(worst_drift, std::abs(material.set_position - carriage.set_position - cuts.back()));
            worst_real_drift = std::max(worst_real_drift, std::abs(m.place("material") - m.place("carriage") - real_cuts.back()));
        }
        if (!cuts.empty() && !back && carriage.set_position < 1e-3) {
            back = true;
            ++returns;
        }
        down = saw;
        furthest = std::max(furthest, carriage.set_position);
        nearest = std::min(nearest, carriage.set_position);
        fastest = std::max(fastest, std::abs(carriage.set_velocity));
        if (material.set_acceleration == 0) hardest = std::max(hardest, std::abs(carriage.set_acceleration));  // by the cam alone
    }
    void expect_smooth() const {
        for (const auto& oracle : oracles) {
            EXPECT_TRUE(oracle.clean()) << oracle.report();
            EXPECT_GT(oracle.compared(), 1000);
        }
    }

    ExampleMachine& m;
    std::deque<axes::test::MotionOracle> oracles;
    std::vector<double> cuts, real_cuts;  // place on the material
    double worst_slip = 0, worst_drift = 0, worst_real_drift = 0, furthest = 0, nearest = 0, fastest = 0, hardest = 0;
    int returns = 0;
    bool down = false, back = false;
};

// Of the machine file: pieces of 997 mm and a kerf of 3 mm. By hand: the cam's return of 400 mm over 450 mm of material with the modified sine reaches
// 1.7596 * 400/450 of the material's velocity, and 5.5280 * 400/450^2 of its square.
TEST(FlyingSaw, CutsExactLengthsInStepWithTheMaterialAndComesBack) {
    ExampleMachine m{"flying_saw"};
    ASSERT_TRUE(m.up());
    Saw saw{m};

    ASSERT_TRUE(m.until([&] { return saw.cuts.size() >= 8; }, 60s)) << m.alarms();

    for (std::size_t i = 1; i < saw.cuts.size(); ++i) {
        EXPECT_NEAR(saw.cuts[i] - saw.cuts[i - 1], 1000, 1e-6) << i;
        EXPECT_NEAR(saw.real_cuts[i] - saw.real_cuts[i - 1], 1000, 0.01) << "the mechanics, cut " << i;
    }
    EXPECT_LT(saw.worst_slip, 1e-9) << "mm/s between saw and material while it cuts";
    EXPECT_LT(saw.worst_drift, 1e-6) << "mm";
    EXPECT_LT(saw.worst_real_drift, 0.1) << "mm, of the mechanics";
    EXPECT_EQ(saw.returns, static_cast<int>(saw.cuts.size()) - 1);
    EXPECT_NEAR(saw.furthest, 400, 0.1);
    EXPECT_NEAR(saw.nearest, 0, 1e-9);
    EXPECT_NEAR(saw.fastest, 1.7596 * 400 / 450 * 300, 0.1);
    EXPECT_NEAR(saw.hardest, 5.5280 * 400 / (450.0 * 450) * 300 * 300, 1);
    saw.expect_smooth();
    EXPECT_EQ(m.alarms(), "");
}

// Faster, slower, stopped in the middle of a cut and on: the lengths stay.
TEST(FlyingSaw, LengthsStayWhateverTheSpeed) {
    ExampleMachine m{"flying_saw"};
    ASSERT_TRUE(m.up());
    Saw saw{m};
    ASSERT_TRUE(m.until([&] { return saw.cuts.size() >= 2; }, 30s)) << m.alarms();
    m.set_parameter("speed", 120);
    ASSERT_TRUE(m.until([&] { return saw.cuts.size() >= 4; }, 60s)) << m.alarms();
    m.set_parameter("speed", 380);
    ASSERT_TRUE(m.until([&] { return saw.cuts.size() >= 6; }, 60s)) << m.alarms();

    m.run(100ms);
    ASSERT_TRUE(saw.down);
    m.world().set_input("run", false);
    ASSERT_TRUE(m.until([&] { return m.axis("material").set_velocity == 0; }, 5s));
    m.run(500ms);
    EXPECT_EQ(m.axis("carriage").set_velocity, 0) << "it stops with the material";
    m.world().set_input("run", true);
    ASSERT_TRUE(m.until([&] { return saw.cuts.size() >= 9; }, 60s)) << m.alarms();

    for (std::size_t i = 1; i < saw.cuts.size(); ++i) EXPECT_NEAR(saw.cuts[i] - saw.cuts[i - 1], 1000, 1e-6) << i;
    EXPECT_LT(saw.worst_slip, 1e-9);
    EXPECT_LT(saw.worst_drift, 1e-6);
    saw.expect_smooth();
    EXPECT_EQ(m.alarms(), "");
}

// A cut that takes longer than the carriage's way: 250 mm at 380 mm/s are 0.66 s.
TEST(FlyingSaw, SaysThatTheWayIsTooShortForTheCut) {
    ExampleMachine m{"flying_saw"};
    ASSERT_TRUE(m.up());
    m.set_parameter("cut_time", 0.9);
    EXPECT_TRUE(m.until([&] { return m.alarms().find("The saw was still down") != std::string::npos; }, 30s)) << m.alarms();
    EXPECT_TRUE(m.until([&] { return m.axis("material").set_velocity == 0; }, 5s));
}

}  // namespace
}  // namespace taktwerk::flying_saw_example
