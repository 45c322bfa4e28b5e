// A drive whose own settings forbid enabling it, in a whole machine: from the drive file to the words of the alarm.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/simulated_five_drives.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

// SV-DA200 3.3.2: with P0.37 = 0 every target would be taken as an increment each cycle. Somebody has set it so.
TEST(RequiredSettings, ADriveThatWouldRunAwayIsNotEnabledAndTheAlarmSaysWhy) {
    SimulatedFiveDrives five;
    ASSERT_NO_FATAL_FAILURE(five.build([](runtime::MachineConfig& config) {
        for (auto& slave : config.bus.slaves)
            if (slave.name == "da200_drive") {
                ecat::StartupSdo sdo;
                sdo.index = 0x2025;
                sdo.type = ecat::DataType::I16;
                sdo.value = 0;
                slave.startup.push_back(sdo);
            }
    }));
    ASSERT_NO_FATAL_FAILURE(five.bring_up());
    std::size_t da200 = 0;
    const auto& axes = five.machine->layout().axes;
    while (da200 < axes.size() && axes[da200].name != "da200") ++da200;
    ASSERT_LT(da200, axes.size());

    bool enabled = false;
    five.runner->after_cycle = [&](Instant) {
        enabled = enabled || five.world->drive("da200")->state() == axes::sim::Cia402Axis::State::enabled;
    };
    runtime::OperatorCommand power;
    power.action = runtime::OperatorAction::power;
    power.axis = static_cast<std::uint16_t>(da200);
    power.flag = true;
    five.command(power);
    five.runner->run_for(2s);

    const auto* seen = five.machine->latest();
    EXPECT_FALSE(enabled);
    EXPECT_EQ(seen->axes[da200].state, axes::AxisState::ErrorStop);
    std::string words;
    for (std::size_t i = 0; i < seen->alarm_count; ++i) words += five.machine->describe(seen->alarms[i].fact).english + "\n";
    EXPECT_THAT(words, AllOf(HasSubstr("P0.37 is not 1"), HasSubstr("2025h reads 0"), HasSubstr("[manual 3.3.2]")));
}

}  // namespace
}  // namespace taktwerk::apps
