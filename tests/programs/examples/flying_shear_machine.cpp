// The flying shear cuts equal lengths.

#include <cmath>
#include <vector>

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::flying_shear_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

// A piece is from one cut to the next: material that has passed minus the carriage's own way. The knife moves with the material, so the
// difference of two cuts is the length, whatever the speed, also when it changes.
TEST(FlyingShear, CutsEqualLengthsAlsoWhenTheSpeedChanges) {
    ExampleMachine m{"flying_shear"};
    ASSERT_TRUE(m.up());
    std::vector<double> cuts;
    bool down = false;
    double largest_difference = 0, largest_jump = 0, before = 0;
    m.each_cycle = [&] {
        const auto &material = m.axis("material"), &carriage = m.axis("carriage");
        const bool knife = m.output("knife");
        if (knife && !down) cuts.push_back(material.set_position - carriage.set_position);
        if (knife) largest_difference = std::max(largest_difference, std::abs(material.set_velocity - carriage.set_velocity));
        down = knife;
        largest_jump = std::max(largest_jump, std::abs(carriage.set_velocity - before));
        before = carriage.set_velocity;
    };

    EXPECT_TRUE(m.until([&] { return cuts.size() >= 4; }, 30s)) << m.alarms();
    m.set_parameter("speed", 200);
    EXPECT_TRUE(m.until([&] { return cuts.size() >= 8; }, 30s)) << m.alarms();
    m.set_parameter("length", 640);
    EXPECT_TRUE(m.until([&] { return cuts.size() >= 11; }, 30s)) << m.alarms();

    ASSERT_GE(cuts.size(), 11u);
    for (std::size_t i = 1; i < 8; ++i) EXPECT_NEAR(cuts[i] - cuts[i - 1], 500, 1e-6) << i;
    for (std::size_t i = 9; i < 11; ++i) EXPECT_NEAR(cuts[i] - cuts[i - 1], 640, 1e-6) << i;
    EXPECT_LT(largest_difference, 1e-6) << "mm/s between knife and material while cutting";
    EXPECT_LE(largest_jump, 8000 * 1e-3 * 1.000001) << "the carriage's acceleration, per cycle";
}

}  // namespace
}  // namespace taktwerk::flying_shear_example
