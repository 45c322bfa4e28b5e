// A load encoder in an object of the drive (60E4h), over real frames: the coupling slips, and the axis notices.

#include "axes/axis/alarms.hpp"
#include "runtime/check/machine_check.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisAlarm;
using axes::AxisState;

MachineConfig with_scale() {
    auto config = machine_config(1);
    auto device = *config.bus.slaves[0].device;
    device.tx_pdos[0].entries.push_back({0x60E4, 1, 32});
    auto scale = device.objects.front();
    scale.index = 0x60E4, scale.sub = 1, scale.name = "scale", scale.type = ecat::DataType::I32, scale.access = ecat::Access::ro;
    scale.mappable = ecat::Mappable::tx, scale.value = 0;
    device.objects.push_back(scale);
    std::sort(device.objects.begin(), device.objects.end(), [](const auto& a, const auto& b) {
        return std::pair{a.index, a.sub} < std::pair{b.index, b.sub};
    });
    config.bus.slaves[0].device = std::make_shared<ecat::DeviceDescription>(device);
    IoPoint point;
    point.name = "scale";
    point.slave = "x_drive";
    point.index = 0x60E4;
    point.sub = 1;
    config.io.push_back(point);
    config.axes[0].axis.load_encoder = {.on = true, .counts_per_unit = 200, .tolerance = 1, .shown = true};
    config.axes[0].load_input = "scale";
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    return config;
}

TEST(LoadEncoderMachine, ASlippingCouplingStopsTheAxis) {
    TestMachine m{with_scale()};
    ASSERT_TRUE(m.up());
    m.enable(0);
    m.home(0);
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 700, 150).answer, Answer::accepted);
    double widest = 0;
    m.on_cycle = [&] { widest = std::max(widest, std::abs(m.axis(0).load_difference)); };
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_position > 300; }, 5s)) << m.alarms();
    m.on_cycle = {};
    EXPECT_LT(widest, 0.5) << "150 mm/s for a cycle or two, and a count of 5 um";
    EXPECT_NEAR(m.axis(0).actual_position, m.axis(0).set_position, 2);

    m.world.slip("x", -3);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 100ms));
    EXPECT_TRUE(m.has_alarm(id(AxisAlarm::load_deviation))) << m.alarms();
    EXPECT_NE(m.alarms().find("Motor and load are -"), std::string::npos) << m.alarms();
    EXPECT_FALSE(m.axis(0).homed);
    m.run(500ms);
    EXPECT_EQ(m.axis(0).set_velocity, 0);
    EXPECT_EQ(m.command(OperatorAction::reset).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state != AxisState::ErrorStop; }, 3s)) << m.alarms();
    m.enable(0);
    m.home(0);
    EXPECT_EQ(m.alarms(), "");
    m.expect_no_jump();
}

TEST(LoadEncoderMachine, NamesAnInputThatIsThere) {
    auto config = with_scale();
    EXPECT_TRUE(check(config).empty());
    config.axes[0].load_input = "scala";
    const auto errors = check(config);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_NE(errors[0].text().find("did you mean 'scale'"), std::string::npos) << errors[0].text();
}

}  // namespace
}  // namespace taktwerk::runtime::testing
